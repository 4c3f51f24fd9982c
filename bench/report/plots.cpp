#include "report/plots.hpp"

#include "dermis/error.hpp"
#include "report/gnuplot.hpp"

namespace dermis::bench {

void prepare_plots(const std::filesystem::path& folder) {
  program::need_gnuplot("--plot");
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw Error(ErrorCode::output, "--plot", folder.string(), "a folder, or a name for one in a folder that is there");
  }
}

void draw_plots(const std::filesystem::path& folder, const Measurement& measurement) {
  draw_time_error(folder, measurement);
  if (measurement.picture.empty()) draw_costs(folder, measurement);
}

}  // namespace dermis::bench
