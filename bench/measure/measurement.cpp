#include "measure/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>

#include "measure/frame_copy.hpp"
#include "measure/runner.hpp"
#include "measure/start_up.hpp"
#include "measure/two_builds.hpp"
#include "opponents/opponents.hpp"
#include "report/stopwatch.hpp"
#include "support/machine.hpp"

namespace dermis::bench {

namespace {

using program::time_ms;

/// The share of the progress that is preparation.
constexpr double preparation = 0.6;

/// The value with `share` of the others below it; 0 if there are no values.
double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

bool is_picture_truth(const Case& what) { return what.is_on_picture() && what.family == Family::dermis_exact; }

bool is_done(const Runner& runner, const Setup& setup) {
  const double total_ms = std::accumulate(runner.ms.begin(), runner.ms.end(), 0.0);
  if (total_ms >= setup.enough_ms) return true;
  return static_cast<int>(runner.ms.size()) >= setup.rounds && total_ms >= setup.min_ms;
}

/// Compares the first result with the truth. The exact method on a picture, which comes first, is the truth.
void measure_error(Runner& runner, Stage& stage) {
  Row& row = runner.row;
  const SceneSpec& spec = row.what.scene;
  if (stage.scene(spec).covered == 0) return;
  const std::vector<float> result = runner.opponent->result();
  if (is_picture_truth(row.what)) stage.keep_truth(spec, result);
  const Truth& truth = stage.truth(spec);
  Distance off = distance(result, truth);
  row.rel_l2 = off.rel_l2;
  row.max_err = off.max_err;
  row.rel_l2_of_parts = std::move(off.rel_l2_of_parts);
  row.truth = truth.source;
}

Runner start_up(const Case& what, const std::string& device_name) {
  const StartUp found = measure_start_up(what.cache_is_filled, device_name);
  Runner runner;
  Row& row = runner.row;
  row.what = what;
  row.loads = loads_of(what);
  row.plan_ms = found.plan_ms;
  row.first_run_ms = found.first_run_ms;
  row.second_plan_ms = found.second_plan_ms;
  row.peak_mb = found.peak_mb;
  runner.ms = {found.plan_ms + found.first_run_ms};
  return runner;
}

/// Copies of frames of all sizes, and their times.
struct Copies {
  std::map<std::pair<int, int>, FrameCopy> by_size = {};
  std::map<std::pair<int, int>, std::vector<double>> ms = {};

  void run() {
    for (auto& [size, copy] : by_size) ms[size].push_back(time_ms([&copy = copy] { copy.run(); }));
  }
};

void run_in(AnsweringProcess& build, const std::string& name, std::vector<double>& ms) {
  if (const std::optional<double> answer = build.run_ms(name)) ms.push_back(*answer);
}

/// One run here; or one of each build, if it knows the case, in either order.
void run_once(Runner& runner, TwoBuilds* builds, bool other_is_first) {
  if (builds == nullptr) return runner.run();
  const std::string name = runner.row.what.name();
  if (other_is_first) run_in(builds->other, name, runner.other_ms);
  run_in(builds->own, name, runner.ms);
  if (!other_is_first) run_in(builds->other, name, runner.other_ms);
}

void warm_up(Runner& runner, TwoBuilds* builds) {
  run_once(runner, builds, false);
  runner.ms.clear();
  runner.stages_ms.clear();
  runner.other_ms.clear();
}

/// Runs the cases round by round, each round in another order, until all are done.
void go_round(std::vector<Runner*> runners, Copies& copies, const Setup& setup, const Report& report) {
  std::mt19937 random(setup.seed);
  const std::size_t all = runners.size();
  copies.run();
  for (Runner* runner : runners) {
    if (runner->row.first_run_ms < setup.enough_ms) warm_up(*runner, setup.builds);
  }
  copies.ms.clear();
  while (!runners.empty()) {
    report(preparation + (1 - preparation) * static_cast<double>(all - runners.size()) / static_cast<double>(all),
           std::to_string(runners.size()) + " cases going round");
    std::shuffle(runners.begin(), runners.end(), random);
    for (std::size_t i = 0; i < runners.size(); ++i) {
      // A machine's speed changes within a round, so the copy runs several times in each.
      if (i % 8 == 0) copies.run();
      run_once(*runners[i], setup.builds, random() % 2 == 0);
    }
    std::erase_if(runners, [&](const Runner* runner) { return is_done(*runner, setup); });
  }
  if (copies.ms.empty()) copies.run();
}

std::optional<OtherTimes> other_times(const Runner& runner) {
  if (runner.other_ms.empty()) return std::nullopt;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < runner.ms.size(); ++i) ratios.push_back(runner.ms[i] / runner.other_ms[i]);
  const double ms = percentile(runner.other_ms, 0.5);
  return OtherTimes{ms, percentile(runner.ms, 0.5) / ms, percentile(ratios, 0.1), percentile(ratios, 0.9)};
}

void finish(Runner& runner, double copy_ms, std::size_t covered) {
  Row& row = runner.row;
  row.ms = percentile(runner.ms, 0.5);
  row.ms_p10 = percentile(runner.ms, 0.1);
  row.ms_p90 = percentile(runner.ms, 0.9);
  row.runs = static_cast<int>(runner.ms.size());
  row.other = other_times(runner);
  if (!runner.opponent) return;
  row.copy_ratio = row.ms / copy_ms;
  const double loads_per_ns = row.loads * static_cast<double>(covered) / (row.ms * 1e6);
  row.gb_s = 16 * loads_per_ns;
  row.gflop_s = 12 * loads_per_ns;
  if (runner.stages_ms.empty()) return;
  row.stages_ms.emplace();
  for (const auto& [name, values] : runner.stages_ms) (*row.stages_ms)[name] = percentile(values, 0.5);
}

}  // namespace

Measurement measure_cases(const std::vector<Case>& cases, const Setup& setup, const Report& report) {
  Stage stage(setup);
  Measurement found{.device = stage.device(0).info(), .load_before = load_average()};
  std::vector<Runner> runners;
  std::vector<Runner*> going;
  Copies copies;
  runners.reserve(cases.size());
  for (const Case& what : cases) {
    report(preparation * static_cast<double>(runners.size()) / static_cast<double>(cases.size()), what.name());
    const bool is_start_up = what.family == Family::start_up;
    Runner& runner = runners.emplace_back(is_start_up ? start_up(what, setup.device) : prepare(what, stage));
    if (is_start_up) continue;
    if (setup.builds == nullptr) measure_error(runner, stage);
    if (is_picture_truth(what)) {
      runner.ms = {runner.row.first_run_ms};  // one run takes minutes
    } else {
      going.push_back(&runner);
    }
    copies.by_size.try_emplace({what.scene.width, what.scene.height}, stage.scene(what.scene).pixels());
  }
  go_round(going, copies, setup, report);
  for (const auto& [size, values] : copies.ms) found.copy_ms[size] = percentile(values, 0.5);
  for (Runner& runner : runners) {
    const SceneSpec& spec = runner.row.what.scene;
    const bool is_start_up = !runner.opponent;
    finish(runner, is_start_up ? 1 : found.copy_ms.at({spec.width, spec.height}),
           is_start_up ? 0 : stage.scene(spec).covered);
    found.rows.push_back(std::move(runner.row));
  }
  if (setup.picture) found.picture = setup.picture->name;
  if (setup.picture && setup.builds == nullptr) {
    for (const Part& part : stage.truth(setup.picture->spec).parts)
      found.parts.push_back({part.name, part.places.size()});
  }
  report(1, "");
  return found;
}

}  // namespace dermis::bench
