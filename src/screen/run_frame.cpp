#include "screen/run_frame.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "opencl/device_buffer.hpp"
#include "opencl/device_cache.hpp"
#include "screen/band_images.hpp"
#include "screen/frame_run.hpp"

namespace dermis {

namespace {

using Images = std::span<const CallerImage, image_count>;

void check_bad_pixels(std::int64_t bad) {
  if (bad == 0) return;
  throw Error(ErrorCode::input_unsupported, "light", std::to_string(bad) + " pixels that are not finite",
              "finite light and albedo, or bad_pixels keep or zero");
}

/// How far a run goes.
enum class Until { scattered, written };

/// Runs a band, or a whole frame. Nothing if `progress` has ended it.
std::optional<Stats> run_band(const Plan::State& plan, const Frame& frame, const Band& band, Reuse::State* reuse,
                              const Progress& progress, Until until = Until::written) {
  const auto start = std::chrono::steady_clock::now();
  const auto milliseconds_since_start = [&] {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  };
  const Device& device = plan.settings.device;
  const BorrowedQueue borrowed(device);
  const cl::CommandQueue& queue = *borrowed;
  const BoundImages bound(device, queue, frame, images_of_frame(frame));
  // Whatever ends the run, the device must be done with the caller's memory first.
  const BorrowedMemory<RunMemory> memory(plan.memories, device, queue, plan.run_sizes(frame.width, frame.height));
  FrameRun run(plan, frame, band, bound, *memory, queue, {}, reuse);
  Stats stats;
  stats.prepare_ms = milliseconds_since_start();
  run.classify();
  const int steps = run.scatter_steps();
  for (int step = 0; step < steps; ++step) {
    run.scatter(step);
    if (steps == 1 && !progress) break;
    queue.finish();
    if (progress && !progress((step + 1.0) / (steps + 1))) return std::nullopt;
  }
  if (until == Until::written) {
    if (plan.settings.options.bad_pixels == BadPixels::error) check_bad_pixels(run.counters()[COUNTER_BAD]);
    if (!frame.views.empty()) stats.views = run.add_hidden_light(frame);
    run.finish();
    bound.read_back();
  }
  run.add_to(stats);
  stats.classify_ms = milliseconds(run.events().classify);
  stats.scatter_ms = milliseconds(run.events().scatter);
  stats.views_ms = milliseconds(run.events().views);
  stats.finish_ms = milliseconds(run.events().finish);
  stats.total_ms = milliseconds_since_start();
  return stats;
}

/// Adds the tiles of a band with so many own rows. Those of bands differ in height: they are cut to rows of blocks.
void add(TileMap& sum, const TileMap& its, int own_rows) {
  if (its.kinds.empty()) return;
  sum.tile_width = its.tile_width;
  sum.tile_height = BLOCK;
  sum.columns = its.columns;
  for (int y = 0; y < own_rows; y += BLOCK) {
    const auto row = its.kinds.begin() + std::ptrdiff_t{y / its.tile_height} * its.columns;
    sum.kinds.insert(sum.kinds.end(), row, row + its.columns);
    ++sum.rows;
  }
}

/// Adds the times and counts of a band.
void add(Stats& sum, const Stats& its) {
  for (double Stats::*const time : {&Stats::prepare_ms, &Stats::classify_ms, &Stats::scatter_ms, &Stats::finish_ms}) {
    sum.*time += its.*time;
  }
  for (std::int64_t Stats::*const count :
       {&Stats::pixels, &Stats::pixels_scattered, &Stats::pixels_without_material, &Stats::pixels_narrow,
        &Stats::pixels_flat, &Stats::channels_narrow, &Stats::pixels_bad, &Stats::pixels_unlit}) {
    sum.*count += its.*count;
  }
}

/// The bytes that a run may take.
std::uint64_t allowed_bytes(const PlanSettings& settings) {
  if (settings.options.device_memory_mb > 0) {
    return static_cast<std::uint64_t>(settings.options.device_memory_mb) * 1000000;
  }
  const std::uint64_t all = settings.device.info().memory_bytes;
  return all > 0 ? all : std::numeric_limits<std::uint64_t>::max();
}

/// What a run takes.
class Need {
 public:
  explicit Need(const PlanSettings& settings) : settings_(settings) {}

  void add(const BufferSize& buffer) {
    bytes_ += buffer.bytes;
    if (buffer.bytes > largest_.bytes) largest_ = buffer;
  }
  void add(const std::vector<BufferSize>& buffers) {
    for (const BufferSize& its : buffers) add(its);
  }
  /// A buffer over memory that the caller has.
  void add_callers(const BufferSize& buffer) {
    if (buffer.bytes > largest_.bytes) largest_ = buffer;
  }

  bool is_met() const {
    return largest_.bytes <= settings_.device.info().max_buffer_bytes && bytes_ <= allowed_bytes(settings_);
  }
  /// Throws unless it is met. `rows` of the frame need it.
  void check(int rows) const {
    const std::string of_rows = " of " + std::to_string(rows) + (rows == 1 ? " row" : " rows");
    check_buffer_size(settings_.device, largest_.name + of_rows, largest_.bytes);
    if (is_met()) return;
    throw Error(ErrorCode::device, "device memory" + of_rows, megabytes(bytes_),
                "at most " + megabytes(allowed_bytes(settings_)) +
                    (settings_.options.device_memory_mb > 0 ? ", as device_memory_mb says"
                                                            : ", the memory of " + settings_.device.info().name));
  }

 private:
  const PlanSettings& settings_;
  std::uint64_t bytes_ = 0;
  BufferSize largest_{"", 0};
};

/// Of a whole frame.
Need need_of_frame(const Plan::State& plan, const Frame& frame, Images images, bool has_reuse) {
  Need need(plan.settings);
  bool defers = plan.always_defers() || has_reuse;
  for (const HostRange& range : host_ranges_of(images, frame.width, frame.height)) {
    defers = defers || (range.read && range.written);
    const BufferSize buffer{range.name, range.size()};
    if (shares_host_memory(plan.settings.device)) {
      need.add_callers(buffer);
    } else {
      need.add(buffer);
    }
  }
  need.add(plan.run_sizes(frame.width, frame.height).buffers(defers));
  return need;
}

/// Of so many rows in memory of their own.
Need need_of_band(const Plan::State& plan, Images images, int width, int rows) {
  Need need(plan.settings);
  const auto bytes = BandImages::bytes(images, width, rows);
  for (std::size_t i = 0; i < image_count; ++i) need.add(BufferSize{frame_images[i].name, bytes[i]});
  need.add(plan.run_sizes(width, rows).buffers(plan.always_defers()));
  return need;
}

constexpr int round_down(int value, int multiple) { return value / multiple * multiple; }

/// The bands of a frame.
struct Bands {
  int height;     ///< of the frame
  int most_rows;  ///< of a band
  int around;     ///< rows that light comes from, above and below
  int alignment;  ///< bands begin at multiples of it

  /// The band whose own rows begin there.
  Band at(int first) const {
    const int begin = std::max(0, first - around);
    const int end = std::min(height, begin + most_rows);
    const int own_end = end == height ? height : round_down(end - around, alignment);
    return {{begin, end - begin}, {first, own_end - first}};
  }
};

class BandedRun {
 public:
  BandedRun(const Plan::State& plan, const Frame& frame, Images images)
      : plan_(plan), frame_(frame), callers_(images), most_rows_(most_rows()), images_(frame, images, most_rows_) {}

  Stats run(const Progress& progress) {
    const int alignment = plan_.method->band_alignment();
    const Bands bands{frame_.height, most_rows_, rows_around(), alignment};
    const int least_rows = std::min(frame_.height, 2 * bands.around + alignment);
    if (least_rows > most_rows_) need_of_band(plan_, callers_, frame_.width, least_rows).check(least_rows);
    if (plan_.settings.options.bad_pixels == BadPixels::error) {
      // Nothing is written unless all pixels are good.
      const auto counted = run(bands, Until::scattered, {});
      check_bad_pixels(counted->pixels_bad);
    }
    return run(bands, Until::written, progress).value_or(Stats{});
  }

 private:
  /// The most rows that are in memory at a time.
  int most_rows() const {
    const int alignment = plan_.method->band_alignment();
    int fits = 0;
    int too_many = frame_.height / alignment + 1;  // a band of all rows would be a copy of the frame
    while (too_many - fits > 1) {
      const int middle = (fits + too_many) / 2;
      (need_of_band(plan_, callers_, frame_.width, middle * alignment).is_met() ? fits : too_many) = middle;
    }
    const int least = std::min(frame_.height, alignment);
    if (fits == 0) need_of_band(plan_, callers_, frame_.width, least).check(least);
    return std::max(fits * alignment, least);
  }

  /// The rows that light comes from, above and below a row, by the pixels that are finest.
  int rows_around() {
    const Bands bands{frame_.height, most_rows_, 0, plan_.method->band_alignment()};
    Finest finest{0, 0};
    for (Band band = bands.at(0);; band = bands.at(band.own.end())) {
      images_.load(band.rows);
      const Finest its = finest_of(band);
      finest = {std::max(finest.x, its.x), std::max(finest.y, its.y)};
      if (band.own.end() == frame_.height) break;
    }
    // The curvature of a pixel is that of its neighbours' surface, whose slopes are taken from theirs.
    const int of_curvature = plan_.settings.has_curvature() ? 3 : 0;
    const int rows = plan_.method->reach_rows(finest, frame_.camera, {frame_.width, frame_.height}) + of_curvature;
    return round_up(rows, plan_.method->band_alignment());
  }

  Finest finest_of(const Band& band) const {
    const Frame frame = images_.frame();
    const Device& device = plan_.settings.device;
    const BorrowedQueue queue(device);
    const BoundImages bound(device, *queue, frame, images_of_frame(frame));
    const BorrowedMemory<RunMemory> memory(plan_.memories, device, *queue, plan_.run_sizes(frame.width, frame.height));
    FrameRun run(plan_, frame, band, bound, *memory, *queue, {});
    run.find_blocks();
    const auto counters = run.counters();
    return {std::bit_cast<float>(counters[COUNTER_FINEST_X]), std::bit_cast<float>(counters[COUNTER_FINEST_Y])};
  }

  /// Nothing if `progress` has ended it.
  std::optional<Stats> run(const Bands& bands, Until until, const Progress& progress) {
    Stats sum;
    sum.bands = 0;
    for (Band band = bands.at(0);; band = bands.at(band.own.end())) {
      images_.load(band.rows);
      Progress in_band;
      if (progress) {
        in_band = [&](double share) { return progress((band.own.first + share * band.own.count) / frame_.height); };
      }
      const auto stats = run_band(plan_, images_.frame(), band, nullptr, in_band, until);
      if (!stats) return std::nullopt;
      if (until == Until::written) images_.write(band.own);
      add(sum, *stats);
      add(sum.tiles, stats->tiles, band.own.count);
      add(sum.blocks, stats->blocks, band.own.count);
      ++sum.bands;
      if (band.own.end() == frame_.height) return sum;
    }
  }

  const Plan::State& plan_;
  const Frame& frame_;
  Images callers_;
  int most_rows_;
  BandImages images_;
};

}  // namespace

Stats run_frame(const Plan::State& plan, const Frame& frame, Images images, Reuse::State* reuse,
                const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  if (!frame.views.empty()) reuse = nullptr;
  const Need need = need_of_frame(plan, frame, images, reuse != nullptr);
  const bool has_buffers =
      std::any_of(images.begin(), images.end(), [](const CallerImage& its) { return its.buffer != nullptr; });
  if (has_buffers || !frame.views.empty()) need.check(frame.height);
  Stats stats;
  if (need.is_met()) {
    const auto its = run_band(plan, frame, Band::whole(frame.height), reuse, progress);
    if (!its) return {};
    stats = *its;
    if (reuse != nullptr) reuse->plan = plan.number;
  } else {
    if (reuse != nullptr) reuse->plan = 0;
    stats = BandedRun(plan, frame, images).run(progress);
    if (stats.pixels == 0) return {};
  }
  stats.total_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (progress) progress(1);
  return stats;
}

void check_memory(const Plan::State& plan, const FrameSize& frame) {
  Need need(plan.settings);
  need.add(plan.run_sizes(frame.width, frame.height).buffers(plan.always_defers()));
  need.check(frame.height);
}

}  // namespace dermis
