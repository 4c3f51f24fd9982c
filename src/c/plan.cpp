#include <array>
#include <cstring>
#include <string>

#include "c/call.hpp"
#include "c/handles.hpp"

using dermis::Error;
using dermis::ErrorCode;
using dermis::Stats;
using dermis::c::call;
using dermis::c::require;

namespace {

struct NamedNumber {
  const char* name;
  double (*of)(const Stats& stats);
};

template <auto member>
double number_of(const Stats& stats) {
  return static_cast<double>(stats.*member);
}

constexpr std::array numbers = {NamedNumber{"prepare_ms", number_of<&Stats::prepare_ms>},
                                NamedNumber{"classify_ms", number_of<&Stats::classify_ms>},
                                NamedNumber{"scatter_ms", number_of<&Stats::scatter_ms>},
                                NamedNumber{"views_ms", number_of<&Stats::views_ms>},
                                NamedNumber{"finish_ms", number_of<&Stats::finish_ms>},
                                NamedNumber{"total_ms", number_of<&Stats::total_ms>},
                                NamedNumber{"bands", number_of<&Stats::bands>},
                                NamedNumber{"pixels", number_of<&Stats::pixels>},
                                NamedNumber{"pixels_scattered", number_of<&Stats::pixels_scattered>},
                                NamedNumber{"pixels_without_material", number_of<&Stats::pixels_without_material>},
                                NamedNumber{"pixels_narrow", number_of<&Stats::pixels_narrow>},
                                NamedNumber{"pixels_flat", number_of<&Stats::pixels_flat>},
                                NamedNumber{"pixels_bad", number_of<&Stats::pixels_bad>},
                                NamedNumber{"pixels_unlit", number_of<&Stats::pixels_unlit>},
                                NamedNumber{"pixels_reached", number_of<&Stats::pixels_reached>}};

}  // namespace

dermis_code dermis_plan_create(const dermis_device* device, const dermis_settings* settings, const dermis_frame* frame,
                               dermis_plan** plan) {
  return call([&] {
    require(device, "device");
    require(settings, "settings");
    require(frame, "frame");
    require(plan, "plan");
    *plan = new dermis_plan{dermis::Plan(device->device, settings->materials,
                                         dermis::FrameDescription::of(frame->with_views()), settings->options)};
  });
}

dermis_code dermis_plan_run(const dermis_plan* plan, const dermis_frame* frame, dermis_progress progress, void* user,
                            dermis_stats** stats) {
  bool is_stopped = false;
  const dermis_code code = call([&] {
    require(plan, "plan");
    require(frame, "frame");
    dermis::Progress report;
    if (progress != nullptr) {
      report = [&](double share) {
        is_stopped = is_stopped || (progress(share, user) == 0 && share < 1);
        return !is_stopped;
      };
    }
    const Stats its = plan->plan.run(frame->with_views(), report);
    if (stats != nullptr && !is_stopped) *stats = new dermis_stats{its};
  });
  return code == DERMIS_DONE && is_stopped ? DERMIS_STOPPED : code;
}

dermis_code dermis_plan_enqueue(const dermis_plan* plan, const dermis_frame* frame, cl_command_queue queue,
                                size_t wait_count, cl_event const* wait, cl_event* done) {
  return call([&] {
    require(plan, "plan");
    require(frame, "frame");
    if (wait_count > 0) require(wait, "wait");
    dermis::Event event = plan->plan.enqueue(frame->with_views(), queue, {wait, wait_count});
    if (done != nullptr) *done = event.release();
  });
}

dermis_code dermis_plan_scratch_bytes(const dermis_plan* plan, int width, int height, size_t* bytes) {
  return call([&] {
    require(plan, "plan");
    require(bytes, "bytes");
    *bytes = plan->plan.scratch_bytes(width, height);
  });
}

void dermis_plan_release(dermis_plan* plan) { delete plan; }

const char* dermis_stats_name(size_t number) { return number < numbers.size() ? numbers[number].name : nullptr; }

dermis_code dermis_stats_value(const dermis_stats* stats, const char* name, double* value) {
  return call([&] {
    require(stats, "stats");
    require(name, "name");
    require(value, "value");
    for (const NamedNumber& number : numbers) {
      if (std::strcmp(number.name, name) != 0) continue;
      *value = number.of(stats->stats);
      return;
    }
    throw Error(ErrorCode::usage, "name", name, "one that dermis_stats_name lists");
  });
}

void dermis_stats_release(dermis_stats* stats) { delete stats; }
