/// One picture through the filter, in steps that may each run while others do theirs with the pictures before and
/// after.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands/filter_job.hpp"
#include "commands/filter_session.hpp"
#include "commands/input_report.hpp"
#include "commands/result_channels.hpp"
#include "commands/surface_input.hpp"
#include "files/result_record.hpp"
#include "report/messages.hpp"
#include "report/picture_page.hpp"
#include "report/stats_report.hpp"
#include "report/view_report.hpp"

namespace dermis::program {

struct ReadView {
  SurfaceInput input;
  double read_ms;
};

/// A picture with what the filter reads of it. The views point into the picture, so that this stays where it is.
struct ReadPicture {
  exr::Picture picture;
  std::vector<ReadView> views = {};
  ResultRecord record = {};

  explicit ReadPicture(exr::Picture its_picture) : picture(std::move(its_picture)) {}
  ReadPicture(const ReadPicture&) = delete;
  ReadPicture& operator=(const ReadPicture&) = delete;
};

/// What became of a view.
struct ViewResult {
  bool is_copied;  ///< as nothing in it scatters
  ResultChannels channels;
  StatsReport report;
  std::vector<float> light;                ///< RGB, for a map of tiles
  std::optional<ViewReport> views_report;  ///< if it is asked for
  std::optional<PageImages> page;          ///< if it is asked for
};

struct FilteredPicture {
  std::unique_ptr<ReadPicture> read;  ///< with the result in its channels
  std::vector<ViewResult> views;
  std::optional<std::string> why_again;  ///< as Arrival says
};

/// Is told what is being done with a picture, and how much of that is done, 0..1.
using Told = std::function<void(std::string_view what, double share)>;

/// What the result of a frame is to be made of. Throws Error(input_missing) for files that cannot be read.
ResultRecord record_of(const FilterJob& job, const FrameFile& frame);

/// The first step. Throws as check_outputs, exr::Picture::read and load_surface.
std::unique_ptr<ReadPicture> read_for_filter(const FilterJob& job, const PictureFiles& files);

/// What has come of the first step.
struct Arrival {
  std::unique_ptr<ReadPicture> picture;       ///< none: its result is there
  std::optional<std::string> why_again = {};  ///< if there is a result, but not the one that was asked for
};

/// The first step, unless the job skips results that are there and this one is whole and what would be made.
Arrival read_unless_done(const FilterJob& job, const PictureFiles& files);

std::string again_text(const PictureFiles& files, const std::string& why);

/// A view whose frame is ready for a plan.
struct PreparedView {
  std::vector<MaterialPixels> pixels;
  ResultChannels channels;
  std::vector<float> beauty;  ///< of the frame; or empty
  Frame frame;
};

/// Adds the channels of the result to the picture. Says what was found.
PreparedView prepare_view(const FilterJob& job, SurfaceInput& input, Messages& messages);

/// The second step, which says what it does.
FilteredPicture filter_picture(const FilterJob& job, const PictureFiles& files, std::unique_ptr<ReadPicture> read,
                               FilterSession& session, Messages& messages, const Told& told);

/// The third step: the result, and what is to be seen beside it. None takes its place before all are written. Returns
/// how long it took. Throws Error(output).
double write_filtered(const FilterJob& job, const OutputFiles& files, FilteredPicture& filtered);

/// Prints and writes what is to be told of it, once. Throws Error(output).
void report_filtered(const FilterJob& job, const OutputFiles& files, FilteredPicture& filtered, double write_ms);

}  // namespace dermis::program
