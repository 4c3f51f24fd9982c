#include "commands/dry_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <initializer_list>
#include <string>
#include <vector>

#include "commands/filter_picture.hpp"
#include "commands/filter_session.hpp"
#include "commands/picture_tally.hpp"
#include "dermis/error.hpp"
#include "exr/message_text.hpp"
#include "report/standard_output.hpp"

namespace dermis::program {
namespace {

/// Bytes of what a picture needs.
struct PictureMemory {
  std::size_t picture = 0;  ///< all channels and those that are added, as they are written
  std::size_t images = 0;   ///< what is read from it as float
  std::size_t work = 0;     ///< of the filter on the host
  std::size_t device = 0;

  std::size_t while_filtered() const { return picture + images + work; }
};

/// Of the process as it is.
std::size_t resident_bytes() {
  std::size_t all = 0;
  std::size_t resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

std::string mib(std::size_t bytes) { return fmt::format("{:.0f} MiB", static_cast<double>(bytes) / (1024 * 1024)); }

std::size_t pixels_of(const exr::Picture& picture) {
  return static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height());
}

std::size_t bytes_of(const exr::Picture& picture) {
  std::size_t bytes = 0;
  for (const exr::Channel& channel : picture.channels()) bytes += dermis::bytes_of(channel.format);
  return bytes * pixels_of(picture);
}

std::size_t bytes_of(std::initializer_list<const std::vector<float>*> images) {
  std::size_t values = 0;
  for (const std::vector<float>* image : images) values += image->size();
  return values * sizeof(float);
}

std::size_t bytes_of(const LoadedFrame& frame) {
  return bytes_of(
      {&frame.light, &frame.albedo, &frame.depth, &frame.material, &frame.mask, &frame.matte, &frame.normal});
}

std::size_t bytes_of(const SurfaceInput& input) {
  std::size_t bytes = bytes_of(input.loaded) + bytes_of({&input.view_factors});
  if (input.translucency)
    bytes += bytes_of({&input.translucency->position, &input.translucency->normal, &input.translucency->thickness});
  for (const LoadedView& view : input.loaded_views)
    bytes += bytes_of(view.images) + bytes_of({&view.position, &view.normal});
  return bytes;
}

/// Adds what a view needs that scatters. Of the views of a picture one is filtered at a time.
void add_view(const FilterJob& job, SurfaceInput& input, FilterSession& session, Messages& messages,
              PictureMemory& memory) {
  const PreparedView view = prepare_view(job, input, messages);
  const ChosenTaps taps = taps_of(job, view.pixels, input.lighting);
  const std::size_t pixels = pixels_of(input.picture);
  const std::size_t images = bytes_of(input) + 3 * sizeof(float) * pixels * (view.beauty.empty() ? 1 : 3);
  memory.device = std::max(
      memory.device, images + Plan::scratch_bytes(session.device(), taps.materials, FrameDescription::of(view.frame),
                                                  taps.options, input.picture.width(), input.picture.height()));
  // The beauty, the same before, the other passes, and the light after scattering to put it together from.
  if (!view.beauty.empty()) memory.work = std::max(memory.work, 4 * 3 * sizeof(float) * pixels);
}

/// What would become of a picture that is to be made.
PictureMemory check_picture(const FilterJob& job, const PictureFiles& files, ReadPicture& read, FilterSession& session,
                            Messages& messages, bool& is_copied) {
  PictureMemory memory;
  is_copied = true;
  for (ReadView& view : read.views) {
    warn_of_input(view.input.roles, view.input.camera, messages);
    memory.images += bytes_of(view.input);
    if (!view.input.scatters && !job.may_be_empty && !job.shot.is_sequence) require_scattering(view.input, job.surface);
    if (!view.input.scatters) continue;
    add_view(job, view.input, session, messages, memory);
    is_copied = false;
  }
  memory.picture = bytes_of(read.picture);
  std::string others;
  for (const std::string& path : pictures_read(job.surface, files.input))
    if (path != files.input.path) others += fmt::format("{}{}", others.empty() ? " with " : ", ", exr::escaped(path));
  print(fmt::format("{}: {} x {}{}, is {} as {}, {} of host memory, {} of device memory\n",
                    exr::escaped(files.input.path), read.picture.width(), read.picture.height(), others,
                    is_copied ? "copied" : "filtered", exr::escaped(files.outputs.output), mib(memory.while_filtered()),
                    mib(memory.device)));
  return memory;
}

}  // namespace

int dry_run(FilterJob job, Messages& messages) {
  job.options.cache_folder.clear();
  PictureTally tally(job.shot, job.keeps_going, messages);
  FilterSession session(job.device, job.reuse);
  std::size_t filtered = 0;
  std::size_t copied = 0;
  std::size_t there = 0;
  PictureMemory most;
  for (auto files = job.shot.pictures.begin(); files != job.shot.pictures.end() && tally.goes_on(); ++files) {
    messages.begin(files->input.path);
    try {
      const Arrival arrival = read_unless_done(job, *files);
      if (!arrival.picture) {
        print(fmt::format("{}: {} is there already\n", exr::escaped(files->input.path),
                          exr::escaped(files->outputs.output)));
        ++there;
      } else {
        if (arrival.why_again) messages.note(again_text(*files, *arrival.why_again));
        bool is_copied = false;
        const PictureMemory its = check_picture(job, *files, *arrival.picture, session, messages, is_copied);
        most = {std::max(most.picture, its.picture), std::max(most.images, its.images), std::max(most.work, its.work),
                std::max(most.device, its.device)};
        ++(is_copied ? copied : filtered);
      }
      tally.succeed();
    } catch (...) {
      tally.fail(files->input.path);
    }
  }
  const std::size_t of_program = resident_bytes();  // with its libraries, and no picture any more
  // One picture is filtered while the next one is read and the last one is written.
  const std::size_t beside = job.shot.pictures.size() > 1 ? 2 * most.picture + most.images : 0;
  if (!job.shot.pictures.empty())
    print(fmt::format(
        "{} to filter, {} to copy, {} there already; about {} of host memory with {} of the program, and "
        "{} of device memory\n",
        filtered, copied, there, mib(of_program + most.while_filtered() + beside), mib(of_program), mib(most.device)));
  return tally.finish();
}

}  // namespace dermis::program
