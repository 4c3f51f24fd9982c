#include "commands/filter_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "commands/filter_picture.hpp"
#include "commands/filter_session.hpp"
#include "commands/picture_tally.hpp"
#include "dermis/error.hpp"

namespace dermis::program {
namespace {

/// For a call in which nothing scatters at all. Of a part of a sequence that may be as it should be.
void report_empty(const FilterJob& job, Messages& messages) {
  const std::string option = job.surface.profiles.front().id ? "--material" : "--profile";
  const std::string seen =
      fmt::format("{} pictures in which nothing scatters, which are copied", job.shot.pictures.size());
  const std::string wanted = "something that scatters, or --allow-empty";
  if (!job.shot.is_part) throw Error(ErrorCode::role_missing, option, seen, wanted);
  messages.warn(ErrorCode::role_missing, option, fmt::format("{}; want {}", seen, wanted));
}

class Pictures {
 public:
  Pictures(const FilterJob& job, Messages& messages)
      : job_(job), messages_(messages), session_(job.device, job.reuse), tally_(job.shot, job.keeps_going, messages) {}

  int run() {
    if (!job_.skips_existing) session_.open();
    read(0);
    for (std::size_t i = 0; i < all().size() && tally_.goes_on(); ++i) filter(i);
    finish_writing();
    const int code = tally_.finish();
    if (code == 0 && copied_ == all().size() && copied_ > 0 && job_.shot.is_sequence && !job_.may_be_empty)
      report_empty(job_, messages_);
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
      tally_.fail(files.input.path);
    }
    if (tally_.goes_on()) read(i + 1);
    if (!arrival) return;
    if (!arrival->picture) {
      finish_writing();
      tally_.succeed();
      say_done(i, " is there already");
      return;
    }
    session_.device();  // without one there is nothing to go on with
    messages_.begin(files.input.path);
    try {
      if (arrival->why_again) messages_.note(again_text(files, *arrival->why_again));
      FilteredPicture filtered = filter_picture(job_, files, std::move(arrival->picture), session_, messages_);
      finish_writing();
      if (tally_.goes_on()) write(i, std::move(filtered));
    } catch (...) {
      finish_writing();
      tally_.fail(files.input.path);
    }
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
    const PictureFiles& files = all()[written.number];
    try {
      report_filtered(job_, files.outputs, *written.picture, written.write_ms.get());
      tally_.succeed();
      const auto& views = written.picture->views;
      if (std::all_of(views.begin(), views.end(), [](const ViewResult& view) { return view.is_copied; })) ++copied_;
      if (job_.shot.is_sequence) say_done(written.number, "");
    } catch (...) {
      tally_.fail(files.input.path);
    }
  }

  void say_done(std::size_t i, std::string_view what) const {
    messages_.progress(fmt::format("{} of {}: {}{}", i + 1, all().size(), all()[i].outputs.output, what));
  }

  const FilterJob& job_;
  Messages& messages_;
  FilterSession session_;
  PictureTally tally_;
  std::size_t copied_ = 0;  ///< pictures in which nothing scatters
  std::future<Arrival> arriving_;
  std::optional<Written> writing_;
};

}  // namespace

int filter_pictures(const FilterJob& job, Messages& messages) { return Pictures(job, messages).run(); }

}  // namespace dermis::program
