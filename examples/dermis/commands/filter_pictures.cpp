#include "commands/filter_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "commands/filter_picture.hpp"
#include "commands/filter_session.hpp"
#include "commands/picture_tally.hpp"
#include "dermis/error.hpp"
#include "dermis/version.hpp"
#include "files/frame_names.hpp"
#include "report/progress_bar.hpp"
#include "report/run_report.hpp"

namespace dermis::program {
namespace {

/// For a call in which nothing scatters at all. Of a part of a sequence that may be as it should be. Returns the exit
/// code.
int report_empty(const FilterJob& job, Messages& messages) {
  const std::string option = job.surface.profiles.front().id ? "--material" : "--profile";
  const std::string seen =
      fmt::format("{} pictures in which nothing scatters, which are copied", job.shot.pictures.size());
  const std::string wanted = "something that scatters, or --allow-empty";
  if (job.shot.is_part) {
    messages.warn(ErrorCode::role_missing, option, fmt::format("{}; want {}", seen, wanted));
    return 0;
  }
  print_error(Error(ErrorCode::role_missing, option, seen, wanted).what());
  return static_cast<int>(ErrorCode::role_missing);
}

/// What stands in a report before the pictures.
nlohmann::ordered_json about(const FilterJob& job) {
  return {{"version", DERMIS_VERSION}, {"command", job.command}, {"config", job.settings}};
}

nlohmann::ordered_json picture_record(const FrameFile& input, std::string_view status) {
  return {{"input", input.path},
          {"frame", input.number ? nlohmann::ordered_json(*input.number) : nlohmann::ordered_json(nullptr)},
          {"status", status}};
}

class Pictures {
 public:
  Pictures(const FilterJob& job, Messages& messages)
      : job_(job),
        messages_(messages),
        session_(job.device, job.reuse),
        tally_(job.shot, job.keeps_going, messages),
        report_(job.report, about(job)) {
    if (!messages.quiet() || job.progress != ProgressStyle::automatic) bar_.emplace("dermis", job.progress);
  }

  int run() {
    for (const MissingFrames& missing : job_.shot.missing)
      for (const std::int64_t frame : missing.frames)
        report_.add(picture_record({with_frame_number("file", missing.pattern, {{}, frame}), frame}, "missing"));
    if (!job_.skips_existing) session_.open();
    tell(0, "reading", 0);
    read(0);
    for (std::size_t i = 0; i < all().size() && tally_.goes_on(); ++i) filter(i);
    finish_writing();
    tell(all().size() - 1, "done", 1);
    bar_.reset();
    int code = tally_.finish();
    if (code == 0 && copied_ == all().size() && copied_ > 0 && job_.shot.is_sequence && !job_.may_be_empty)
      code = report_empty(job_, messages_);
    report_.finish(code);
    return code;
  }

 private:
  const std::vector<PictureFiles>& all() const { return job_.shot.pictures; }

  /// Begins to read a picture, if there is one. Without a thread for it, it is read when it is asked for.
  void read(std::size_t i) {
    if (i < all().size()) arriving_ = std::async([this, i] { return read_unless_done(job_, all()[i]); });
  }

  void filter(std::size_t i) {
    const PictureFiles& files = all()[i];
    std::optional<Arrival> arrival;
    try {
      arrival = arriving_.get();
    } catch (...) {
      finish_writing();
      fail(i);
    }
    if (tally_.goes_on()) read(i + 1);
    if (!arrival) return;
    if (!arrival->picture) {
      finish_writing();
      tally_.succeed();
      report_.add(with_output(i, "skipped"));
      say_done(i, " is there already");
      return;
    }
    session_.device();  // without one there is nothing to go on with
    messages_.begin(files.input.path);
    try {
      if (arrival->why_again) messages_.note(again_text(files, *arrival->why_again));
      const auto told = [&](std::string_view what, double share) { tell(i, what, share); };
      FilteredPicture filtered = filter_picture(job_, files, std::move(arrival->picture), session_, messages_, told);
      filtered.why_again = arrival->why_again;
      finish_writing();
      if (tally_.goes_on()) write(i, std::move(filtered));
    } catch (...) {
      finish_writing();
      fail(i);
    }
  }

  /// How far the picture is, as told to filter_picture, and with it all of them.
  void tell(std::size_t i, std::string_view what, double share) {
    if (!bar_ || all().empty()) return;
    const auto count = static_cast<double>(all().size());
    bar_->update((static_cast<double>(i) + share) / count,
                 job_.shot.is_sequence ? fmt::format("{} of {}, {}", i + 1, all().size(), what) : std::string(what));
  }

  /// For a handler of what befell a picture.
  void fail(std::size_t i) {
    const Failure failure = tally_.fail(all()[i].input.path);
    nlohmann::ordered_json record = picture_record(all()[i].input, "failed");
    record["exit_code"] = failure.code;
    record["message"] = failure.message;
    report_.add(std::move(record));
  }

  nlohmann::ordered_json with_output(std::size_t i, std::string_view status) const {
    nlohmann::ordered_json record = picture_record(all()[i].input, status);
    record["output"] = all()[i].outputs.output;
    if (!all()[i].outputs.page.empty()) record["page"] = all()[i].outputs.page;
    return record;
  }

  struct Written {
    std::size_t number;
    std::unique_ptr<FilteredPicture> picture;
    std::future<double> write_ms;
  };

  void write(std::size_t i, FilteredPicture filtered) {
    writing_ = Written{i, std::make_unique<FilteredPicture>(std::move(filtered)), {}};
    writing_->write_ms = std::async(
        [this, i, picture = writing_->picture.get()] { return write_filtered(job_, all()[i].outputs, *picture); });
  }

  /// Waits for the picture that is being written, if there is one, and tells what became of it.
  void finish_writing() {
    if (!writing_) return;
    Written written = std::move(*writing_);
    writing_.reset();
    try {
      const auto& views = written.picture->views;
      report_filtered(job_, all()[written.number].outputs, *written.picture, written.write_ms.get());
      tally_.succeed();
      const bool is_copied =
          std::all_of(views.begin(), views.end(), [](const ViewResult& view) { return view.is_copied; });
      if (is_copied) ++copied_;
      nlohmann::ordered_json record = with_output(written.number, is_copied ? "copied" : "filtered");
      if (written.picture->why_again) record["why_again"] = *written.picture->why_again;
      record["views"] = nlohmann::ordered_json::array();
      for (const ViewResult& view : views) record["views"].push_back(nlohmann::ordered_json(json_of(view.report)));
      report_.add(std::move(record));
      if (job_.shot.is_sequence) say_done(written.number, "");
    } catch (...) {
      fail(written.number);
    }
  }

  void say_done(std::size_t i, std::string_view what) const {
    messages_.progress(fmt::format("{} of {}: {}{}", i + 1, all().size(), all()[i].outputs.output, what));
  }

  const FilterJob& job_;
  Messages& messages_;
  FilterSession session_;
  PictureTally tally_;
  RunReport report_;
  std::optional<ProgressBar> bar_;
  std::size_t copied_ = 0;  ///< pictures in which nothing scatters
  std::future<Arrival> arriving_;
  std::optional<Written> writing_;
};

}  // namespace

int filter_pictures(const FilterJob& job, Messages& messages) { return Pictures(job, messages).run(); }

}  // namespace dermis::program
