// Cases made ready to run, and what they run on.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "measure/measurement.hpp"
#include "measure/truth.hpp"
#include "opponents/opponent.hpp"

namespace dermis::bench {

/// Scenes, their truths and devices, each made once.
class Stage {
 public:
  explicit Stage(const Setup& setup);

  const Scene& scene(const SceneSpec& spec);
  const Truth& truth(const SceneSpec& spec);

  /// `exact` is the result of the exact method on a picture: three planes.
  void keep_truth(const SceneSpec& spec, const std::vector<float>& exact);

  /// 0: as many threads as the setup says.
  const Device& device(int threads);

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
  Row row = {};
  std::unique_ptr<Opponent> opponent = {};
  std::vector<double> ms = {};
  std::map<std::string, std::vector<double>> stages_ms = {};
  std::vector<double> other_ms = {};  ///< of the other build, one per run of this one; none if it lacks the case

  void run();
};

/// Makes the opponent and runs it once.
Runner prepare(Case what, Stage& stage);

}  // namespace dermis::bench
