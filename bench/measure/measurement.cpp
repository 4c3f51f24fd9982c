#include "measure/measurement.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <random>

#include "dermis/error.hpp"
#include "measure/copy.hpp"
#include "measure/peak_memory.hpp"
#include "measure/percentile.hpp"
#include "measure/start_up.hpp"
#include "measure/truth.hpp"
#include "opponents/opponents.hpp"
#include "support/machine.hpp"
#include "support/stopwatch.hpp"

namespace dermis::bench {

namespace {

/// What share of the progress is preparation.
constexpr double preparation = 0.6;

/// Scenes, their truths and devices, each made once.
class Stage {
 public:
  explicit Stage(std::string device_name) : device_name_(std::move(device_name)) {}

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

  const Device& device(int threads) {
    std::unique_ptr<Device>& its = devices_[threads];
    if (!its) its = std::make_unique<Device>(Device::open(device_name_, threads));
    return *its;
  }

 private:
  std::string device_name_;
  std::map<SceneSpec, std::unique_ptr<Scene>> scenes_;
  std::map<SceneSpec, std::unique_ptr<Truth>> truths_;
  std::map<int, std::unique_ptr<Device>> devices_;
  std::optional<TruthMaker> truth_maker_;
};

/// A case that is ready, and the times of its runs.
struct Runner {
  Row row;
  std::unique_ptr<Opponent> opponent;
  std::vector<double> ms;
  std::map<std::string, std::vector<double>> stages_ms;

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

  bool is_done(const Effort& effort) const {
    // What takes seconds is not run often.
    constexpr double enough_ms = 1500;
    const double total_ms = std::accumulate(ms.begin(), ms.end(), 0.0);
    const auto runs = static_cast<int>(ms.size());
    if (total_ms >= enough_ms) return true;
    return runs >= effort.rounds && total_ms >= effort.min_ms;
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
  const Distance off = distance(result, truth);
  row.rel_l2 = off.rel_l2;
  row.max_err = off.max_err;
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
  measure_error(row, runner.opponent->result(), stage);
  return runner;
}

Row start_up_row(const Case& what, const std::string& device_name) {
  const StartUp found = measure_start_up(what.cache_is_filled, device_name);
  Row row;
  row.what = what;
  row.loads = loads_of(what);
  row.ms = row.ms_p10 = row.ms_p90 = found.plan_ms + found.first_run_ms;
  row.runs = 1;
  row.plan_ms = found.plan_ms;
  row.first_run_ms = found.first_run_ms;
  row.second_plan_ms = found.second_plan_ms;
  row.peak_mb = found.peak_mb;
  return row;
}

void go_round(std::vector<Runner*> runners, std::map<std::pair<int, int>, FrameCopy>& copies,
              std::map<std::pair<int, int>, std::vector<double>>& copy_ms, const Effort& effort, const Report& report) {
  std::mt19937 random(effort.seed);
  const std::size_t all = runners.size();
  for (auto& [size, copy] : copies) copy.run();
  while (!runners.empty()) {
    report(preparation + (1 - preparation) * static_cast<double>(all - runners.size()) / static_cast<double>(all),
           std::to_string(runners.size()) + " cases going round");
    std::shuffle(runners.begin(), runners.end(), random);
    for (std::size_t i = 0; i < runners.size(); ++i) {
      // The copy as often as needed to see the machine's mood all through the round.
      if (i % 8 == 0) {
        for (auto& [size, copy] : copies) copy_ms[size].push_back(time_ms([&copy = copy] { copy.run(); }));
      }
      runners[i]->run();
    }
    std::erase_if(runners, [&](const Runner* runner) { return runner->is_done(effort); });
  }
}

void finish(Runner& runner, double copy_ms, const Scene& scene) {
  Row& row = runner.row;
  row.ms = percentile(runner.ms, 0.5);
  row.ms_p10 = percentile(runner.ms, 0.1);
  row.ms_p90 = percentile(runner.ms, 0.9);
  row.runs = static_cast<int>(runner.ms.size());
  row.copy_ratio = row.ms / copy_ms;
  const double loads_per_ns = row.loads * static_cast<double>(scene.covered) / (row.ms * 1e6);
  row.gb_s = 16 * loads_per_ns;
  row.gflop_s = 12 * loads_per_ns;
  if (runner.stages_ms.empty()) return;
  row.stages_ms.emplace();
  for (const auto& [name, values] : runner.stages_ms) (*row.stages_ms)[name] = percentile(values, 0.5);
}

}  // namespace

Measurement measure_cases(const std::vector<Case>& cases, const std::string& device_name, const Effort& effort,
                          const Report& report) {
  Stage stage(device_name);
  Measurement found{.device = stage.device(0).info(), .load_before = load_average()};
  std::vector<Runner> runners(cases.size());
  std::vector<Runner*> going;
  std::map<std::pair<int, int>, FrameCopy> copies;
  std::map<std::pair<int, int>, std::vector<double>> copy_ms;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    report(preparation * static_cast<double>(i) / static_cast<double>(cases.size()), cases[i].name());
    if (cases[i].family == Family::start_up) {
      runners[i].row = start_up_row(cases[i], device_name);
      continue;
    }
    runners[i] = prepare(cases[i], stage);
    going.push_back(&runners[i]);
    copies.try_emplace({cases[i].scene.width, cases[i].scene.height}, stage.scene(cases[i].scene).pixels());
  }
  go_round(going, copies, copy_ms, effort, report);
  for (const auto& [size, values] : copy_ms) found.copy_ms[size] = percentile(values, 0.5);
  for (Runner& runner : runners) {
    const SceneSpec& spec = runner.row.what.scene;
    if (runner.opponent) finish(runner, found.copy_ms.at({spec.width, spec.height}), stage.scene(spec));
    found.rows.push_back(std::move(runner.row));
  }
  report(1, "");
  return found;
}

}  // namespace dermis::bench
