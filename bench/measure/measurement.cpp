#include "measure/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>

#include "dermis/error.hpp"
#include "measure/frame_copy.hpp"
#include "measure/peak_memory.hpp"
#include "measure/start_up.hpp"
#include "measure/truth.hpp"
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

/// Scenes, their truths and devices, each made once.
class Stage {
 public:
  explicit Stage(const Setup& setup) : device_name_(setup.device), threads_(setup.threads) {
    if (setup.picture) scenes_[setup.picture->spec] = std::make_unique<Scene>(*setup.picture);
  }

  const Scene& scene(const SceneSpec& spec) {
    std::unique_ptr<Scene>& its = scenes_[spec];
    if (!its) its = std::make_unique<Scene>(make_scene(spec));
    return *its;
  }

  const Truth& truth(const SceneSpec& spec) {
    std::unique_ptr<Truth>& its = truths_[spec];
    if (!truth_maker_) truth_maker_.emplace(device(0));
    if (!its) its = std::make_unique<Truth>(truth_maker_->truth_of(scene(spec)));
    return *its;
  }

  /// `exact` is the result of the exact method on a picture: three planes.
  void keep_truth(const SceneSpec& spec, const std::vector<float>& exact) {
    truths_[spec] = std::make_unique<Truth>(truth_of_picture(scene(spec), exact));
  }

  /// 0: as many threads as the setup says.
  const Device& device(int threads) {
    if (threads == 0) threads = threads_;
    std::unique_ptr<Device>& its = devices_[threads];
    if (!its) its = std::make_unique<Device>(Device::open(device_name_, threads));
    return *its;
  }

 private:
  std::string device_name_;
  int threads_;
  std::map<SceneSpec, std::unique_ptr<Scene>> scenes_;
  std::map<SceneSpec, std::unique_ptr<Truth>> truths_;
  std::map<int, std::unique_ptr<Device>> devices_;
  std::optional<TruthMaker> truth_maker_;
};

/// A case that is ready, and the times of its runs.
struct Runner {
  Row row;
  std::unique_ptr<Opponent> opponent;
  std::vector<double> ms = {};
  std::map<std::string, std::vector<double>> stages_ms = {};

  void run() {
    opponent->reset();
    ms.push_back(time_ms([&] { opponent->run(); }));
    if (const std::optional<Stats> stats = opponent->stats()) {
      stages_ms["prepare"].push_back(stats->prepare_ms);
      stages_ms["classify"].push_back(stats->classify_ms);
      stages_ms["scatter"].push_back(stats->scatter_ms);
      stages_ms["finish"].push_back(stats->finish_ms);
    }
  }

  void warm_up() {
    run();
    ms.clear();
    stages_ms.clear();
  }

  bool is_done(const Setup& setup) const {
    const double total_ms = std::accumulate(ms.begin(), ms.end(), 0.0);
    if (total_ms >= setup.enough_ms) return true;
    return static_cast<int>(ms.size()) >= setup.rounds && total_ms >= setup.min_ms;
  }
};

TapsDesign cheapest(const Case& what) {
  const std::optional<TapsDesign> design =
      cheapest_design(skin(), what.tolerance, skin_width_mm / what.scene.kernel_px);
  if (!design) throw Error(ErrorCode::usage, "--filter", what.name(), "a tolerance that some design can hold");
  return *design;
}

void measure_error(Row& row, const std::vector<float>& result, Stage& stage) {
  const SceneSpec& spec = row.what.scene;
  if (stage.scene(spec).covered == 0) return;
  const Truth& truth = stage.truth(spec);
  Distance off = distance(result, truth);
  row.rel_l2 = off.rel_l2;
  row.max_err = off.max_err;
  row.rel_l2_of_parts = std::move(off.rel_l2_of_parts);
  row.truth = truth.source;
}

Runner prepare(Case what, Stage& stage) {
  if (what.tolerance > 0) what.design = cheapest(what);
  Runner runner;
  Row& row = runner.row;
  row.what = what;
  row.loads = loads_of(what);
  const Scene& scene = stage.scene(what.scene);
  const Device& device = stage.device(what.threads);
  const PeakMemory peak;
  row.plan_ms = time_ms([&] { runner.opponent = make_opponent(what, scene, device); });
  row.first_run_ms = time_ms([&] { runner.opponent->run(); });
  row.peak_mb = peak.mb();
  row.scratch_mib = static_cast<double>(runner.opponent->scratch_bytes()) / (1024 * 1024);
  const std::vector<float> result = runner.opponent->result();
  const bool is_truth = what.is_on_picture() && what.family == Family::dermis_exact;
  if (is_truth) {
    stage.keep_truth(what.scene, result);
    runner.ms = {row.first_run_ms};  // it takes minutes
  }
  measure_error(row, result, stage);
  return runner;
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

/// Runs the cases round by round, each round in another order, until all are done.
void go_round(std::vector<Runner*> runners, Copies& copies, const Setup& setup, const Report& report) {
  std::mt19937 random(setup.seed);
  const std::size_t all = runners.size();
  copies.run();
  for (Runner* runner : runners) {
    if (runner->row.first_run_ms < setup.enough_ms) runner->warm_up();
  }
  copies.ms.clear();
  while (!runners.empty()) {
    report(preparation + (1 - preparation) * static_cast<double>(all - runners.size()) / static_cast<double>(all),
           std::to_string(runners.size()) + " cases going round");
    std::shuffle(runners.begin(), runners.end(), random);
    for (std::size_t i = 0; i < runners.size(); ++i) {
      // A machine's speed changes within a round, so the copy runs several times in each.
      if (i % 8 == 0) copies.run();
      runners[i]->run();
    }
    std::erase_if(runners, [&](const Runner* runner) { return runner->is_done(setup); });
  }
  if (copies.ms.empty()) copies.run();
}

void finish(Runner& runner, double copy_ms, std::size_t covered) {
  Row& row = runner.row;
  row.ms = percentile(runner.ms, 0.5);
  row.ms_p10 = percentile(runner.ms, 0.1);
  row.ms_p90 = percentile(runner.ms, 0.9);
  row.runs = static_cast<int>(runner.ms.size());
  if (row.runs == 0) row.plan_ms = row.first_run_ms = row.peak_mb = 0;  // the oracle's times are of no interest
  if (!runner.opponent || row.runs == 0) return;
  row.copy_ratio = row.ms / copy_ms;
  const double loads_per_ns = row.loads * static_cast<double>(covered) / (row.ms * 1e6);
  row.gb_s = 16 * loads_per_ns;
  row.gflop_s = 12 * loads_per_ns;
  if (runner.stages_ms.empty()) return;
  row.stages_ms.emplace();
  for (const auto& [name, values] : runner.stages_ms) (*row.stages_ms)[name] = percentile(values, 0.5);
}

/// Whether the case has one run or, by the oracle, none that is worth a time.
bool runs_once(const Case& what) {
  return what.family == Family::start_up ||
         (what.is_on_picture() && (what.family == Family::dermis_exact || what.family == Family::rule_2012));
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
    runners.push_back(what.family == Family::start_up ? start_up(what, setup.device) : prepare(what, stage));
    if (!runs_once(what)) going.push_back(&runners.back());
    if (what.family == Family::start_up) continue;
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
  if (setup.picture) {
    found.picture = setup.picture->name;
    for (const Part& part : stage.truth(setup.picture->spec).parts)
      found.parts.push_back({part.name, part.places.size()});
  }
  report(1, "");
  return found;
}

}  // namespace dermis::bench
