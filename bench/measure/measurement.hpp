// Times and errors of many cases, measured side by side.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/device.hpp"
#include "measure/case.hpp"

namespace dermis::bench {

struct TwoBuilds;

/// The device, the picture if there is one, and the time to spend.
struct Setup {
  std::string device;                 ///< as for Device::open
  int threads = 0;                    ///< of cases that do not name their own; 0: all
  std::optional<Scene> picture = {};  ///< for cases on a picture
  int rounds = 7;                     ///< least runs of a case
  double min_ms = 300;                ///< least time of all runs of a case
  double enough_ms = 1500;            ///< a case whose runs take so long together has no more, whatever `rounds` says
  unsigned seed = 1;                  ///< of the order within a round
  TwoBuilds* builds = nullptr;        ///< run each case in turn; no errors are measured then
};

/// The times of the other build in the same rounds.
struct OtherTimes {
  double ms = 0;                        ///< median
  double ratio = 0;                     ///< Row::ms / ms: below 1 where this build is faster
  double ratio_p10 = 0, ratio_p90 = 0;  ///< of the ratios within the rounds
};

/// The results of one case. Times are of the wall clock.
struct Row {
  Case what;
  double ms = 0;  ///< median
  double ms_p10 = 0, ms_p90 = 0;
  int runs = 0;
  double copy_ratio = 0;            ///< ms / time of FrameCopy on a frame of that size
  double loads = 0;                 ///< image reads per pixel; 0 where that is not the measure
  double gb_s = 0;                  ///< 16 bytes per load: three floats of light and one of depth, from whatever cache
  double gflop_s = 0;               ///< 12 per load: a multiply-add of light and one of the weight for three channels
  std::optional<OtherTimes> other;  ///< none if that build lacks the case
  std::optional<double> rel_l2, max_err;
  std::vector<double> rel_l2_of_parts;  ///< as Measurement::parts
  std::string truth;
  double plan_ms = 0;  ///< until it can run; of a start-up, the first plan of the process
  double first_run_ms = 0;
  double peak_mb = 0;  ///< memory beyond the scene's, at the worst moment until the first result; of a start-up, of all
  double scratch_mib = 0;                                  ///< of dermis: device memory beyond the images
  std::optional<double> second_plan_ms;                    ///< of a start-up
  std::optional<std::map<std::string, double>> stages_ms;  ///< of dermis: medians of Stats
};

/// Some of a picture's pixels, of which errors are told, too.
struct PartSize {
  std::string name;
  std::size_t pixels;
};

struct Measurement {
  DeviceInfo device;
  double load_before = 0;                              ///< load_average() before it began
  std::string picture = {};                            ///< its name
  std::string against = {};                            ///< the folder of the other build, if there is one
  std::vector<PartSize> parts = {};                    ///< of the picture
  std::map<std::pair<int, int>, double> copy_ms = {};  ///< median by size of frame
  std::vector<Row> rows = {};                          ///< in the order of the cases
};

/// Is told what is going on, and the share that is done, 0..1.
using Report = std::function<void(double share, const std::string& what)>;

/// Prepares each case and compares its first result with the truth; then goes round all of them, in random order, until
/// each has had its runs. The first round does not count, but for what takes seconds. If there are cases on a picture,
/// the exact method on it is the first of them.
Measurement measure_cases(const std::vector<Case>& cases, const Setup& setup, const Report& report);

}  // namespace dermis::bench
