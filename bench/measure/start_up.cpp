#include "measure/start_up.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "dermis/error.hpp"
#include "dermis/plan.hpp"
#include "measure/peak_memory.hpp"
#include "opponents/opponents.hpp"
#include "report/stopwatch.hpp"

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

[[noreturn]] void become_child(int to_parent, const std::string& cache, const std::string& device_name) {
  dup2(to_parent, STDOUT_FILENO);
  setenv("POCL_CACHE_DIR", cache.c_str(), 1);
  setenv("CUDA_CACHE_PATH", cache.c_str(), 1);
  std::string program = "/proc/self/exe";
  std::string child = "--start-up-child";
  std::string device = "--device";
  std::string name = device_name;
  char* const arguments[] = {program.data(), child.data(), name.empty() ? nullptr : device.data(), name.data(),
                             nullptr};
  execv(program.c_str(), arguments);
  _exit(127);
}

StartUp run_child(const std::string& cache, const std::string& device_name) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw Error(ErrorCode::device, "start-up", "no pipe", "a pipe");
  const pid_t child = fork();
  if (child == 0) become_child(ends[1], cache, device_name);
  close(ends[1]);
  std::string text;
  std::array<char, 256> part{};
  for (ssize_t size = 0; (size = read(ends[0], part.data(), part.size())) > 0;) text.append(part.data(), size);
  close(ends[0]);
  int status = -1;
  if (child < 0 || waitpid(child, &status, 0) != child || status != 0) {
    throw Error(ErrorCode::device, "start-up", fmt::format("exit status {} of a second process", status), "success");
  }
  const auto found = nlohmann::json::parse(text);
  return {found.at("plan_ms"), found.at("first_run_ms"), found.at("second_plan_ms"), found.at("peak_mb")};
}

}  // namespace

StartUp measure_start_up(bool cache_is_filled, const std::string& device_name) {
  const CacheFolder cache;
  if (cache_is_filled) run_child(cache.path(), device_name);
  return run_child(cache.path(), device_name);
}

void run_start_up_child(const std::string& device_name) {
  const Case what;
  const Scene scene = make_scene(what.scene);
  const Device device = Device::open(device_name);
  const auto make_plan = [&] { return Plan(device, scene.materials, {.depth = true}, {.taps = what.design}); };
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
