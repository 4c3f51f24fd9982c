#include "measure/start_up.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "dermis/error.hpp"
#include "dermis/plan.hpp"
#include "measure/peak_memory.hpp"
#include "opponents/opponents.hpp"
#include "report/stopwatch.hpp"
#include "support/child_process.hpp"

namespace dermis::bench {

namespace {

using program::time_ms;

/// A new folder for a cache, below the folder for temporary files.
class CacheFolder {
 public:
  CacheFolder() : path_((std::filesystem::temp_directory_path() / "dermis-bench-XXXXXX").string()) {
    if (mkdtemp(path_.data()) == nullptr) throw Error(ErrorCode::output, "start-up", path_, "a folder to make");
  }
  ~CacheFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  CacheFolder(const CacheFolder&) = delete;
  CacheFolder& operator=(const CacheFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

StartUp run_child(const std::string& cache, const std::string& device_name) {
  ChildProcess child({.path = "/proc/self/exe",
                      .arguments = {"--start-up-child", cache, "--device", device_name},
                      .environment = {{"POCL_CACHE_DIR", cache}, {"CUDA_CACHE_PATH", cache}}});
  const std::optional<std::string> text = child.read_line();
  if (const int status = child.wait(); !text || status != 0) {
    throw Error(ErrorCode::device, "start-up", fmt::format("exit status {} of a second process", status), "success");
  }
  const auto found = nlohmann::json::parse(*text);
  return {found.at("plan_ms"), found.at("first_run_ms"), found.at("second_plan_ms"), found.at("peak_mb")};
}

}  // namespace

StartUp measure_start_up(bool cache_is_filled, const std::string& device_name) {
  const CacheFolder cache;
  if (cache_is_filled) run_child(cache.path(), device_name);
  return run_child(cache.path(), device_name);
}

void run_start_up_child(const std::string& device_name, const std::string& cache) {
  const Case what;
  const Scene scene = make_scene(what.scene);
  const Device device = Device::open(device_name);
  const Options options{.taps = what.design, .cache_folder = cache + "/taps"};
  const auto make_plan = [&] { return Plan(device, scene.materials, {.depth = true}, options); };
  std::optional<Plan> first, second;
  const double plan_ms = time_ms([&] { first.emplace(make_plan()); });
  // The filter has its own plan, equal to the first, as its images must not be made while the clock runs.
  const std::unique_ptr<Opponent> filter = make_dermis(what, scene, device);
  const double first_run_ms = time_ms([&] { filter->run(); });
  const double second_plan_ms = time_ms([&] { second.emplace(make_plan()); });
  fmt::print("{}\n", nlohmann::json{{"plan_ms", plan_ms},
                                    {"first_run_ms", first_run_ms},
                                    {"second_plan_ms", second_plan_ms},
                                    {"peak_mb", process_peak_mb()}}
                         .dump());
}

}  // namespace dermis::bench
