#include "measure/runner.hpp"

#include "dermis/error.hpp"
#include "measure/peak_memory.hpp"
#include "opponents/opponents.hpp"
#include "report/stopwatch.hpp"

namespace dermis::bench {

namespace {

using program::time_ms;

TapsDesign cheapest(const Case& what) {
  const std::optional<TapsDesign> design =
      cheapest_design(skin(), what.tolerance, skin_width_mm / what.scene.kernel_px);
  if (!design) throw Error(ErrorCode::usage, "--filter", what.name(), "a tolerance that some design can hold");
  return *design;
}

}  // namespace

Stage::Stage(const Setup& setup) : device_name_(setup.device), threads_(setup.threads) {
  if (setup.picture) scenes_[setup.picture->spec] = std::make_unique<Scene>(*setup.picture);
}

const Scene& Stage::scene(const SceneSpec& spec) {
  std::unique_ptr<Scene>& its = scenes_[spec];
  if (!its) its = std::make_unique<Scene>(make_scene(spec));
  return *its;
}

const Truth& Stage::truth(const SceneSpec& spec) {
  std::unique_ptr<Truth>& its = truths_[spec];
  if (!truth_maker_) truth_maker_.emplace(device(0));
  if (!its) its = std::make_unique<Truth>(truth_maker_->truth_of(scene(spec)));
  return *its;
}

void Stage::keep_truth(const SceneSpec& spec, const std::vector<float>& exact) {
  truths_[spec] = std::make_unique<Truth>(truth_of_picture(scene(spec), exact));
}

const Device& Stage::device(int threads) {
  if (threads == 0) threads = threads_;
  std::unique_ptr<Device>& its = devices_[threads];
  if (!its) its = std::make_unique<Device>(Device::open(device_name_, threads));
  return *its;
}

void Runner::run() {
  opponent->reset();
  ms.push_back(time_ms([&] { opponent->run(); }));
  if (const std::optional<Stats> stats = opponent->stats()) {
    stages_ms["prepare"].push_back(stats->prepare_ms);
    stages_ms["classify"].push_back(stats->classify_ms);
    stages_ms["scatter"].push_back(stats->scatter_ms);
    stages_ms["finish"].push_back(stats->finish_ms);
  }
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
  return runner;
}

}  // namespace dermis::bench
