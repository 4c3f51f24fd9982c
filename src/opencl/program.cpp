#include "opencl/program.hpp"

#include <mutex>
#include <set>
#include <sstream>

#include "opencl/device_cache.hpp"
#include "opencl/kernel_sources.hpp"

namespace dermis {

namespace {

void append_file(const std::string& name, std::set<std::string>& seen, std::string& source) {
  if (!seen.insert(name).second) return;
  constexpr std::string_view include = "#include \"";
  std::istringstream lines(kernel_sources().at(name));
  source += "#line 1 \"" + name + "\"\n";
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with(include)) {
      append_file(line.substr(include.size(), line.rfind('"') - include.size()), seen, source);
      source += "#line " + std::to_string(number + 1) + " \"" + name + "\"\n";
    } else {
      source += line + "\n";
    }
  }
}

/// The first line of a build log that tells of an error, else the first one.
std::string telling_line(const std::string& log) {
  std::istringstream lines(log);
  std::string first;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("error") != std::string::npos) return line;
    if (first.empty()) first = line;
  }
  return first;
}

/// What a build has failed of: its log tells it, if the driver has one.
std::string problem_of(const cl::Program& program, const cl::Device& device, cl_int error) {
  try {
    std::string line = telling_line(program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device));
    if (!line.empty()) return line;
  } catch (const cl::Error&) {
    // The error of the build says more than that of asking for its log.
  }
  return "OpenCL error " + std::to_string(error);
}

cl::Program build(const cl::Context& context, const cl::Device& device, const std::string& source,
                  const std::string& options) {
  // One at a time: not every device's compiler stands several threads, and PoCL's makes them wait for each other.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  cl::Program program(context, source);
  try {
    program.build({device}, (options + " -w").c_str());  // warnings are for tests
  } catch (const cl::Error& error) {
    throw Error(ErrorCode::device, "kernels", problem_of(program, device, error.err()), "a successful build");
  }
  return program;
}

}  // namespace

std::string assemble_source(const std::vector<std::string>& files) {
  std::set<std::string> seen;
  std::string source;
  for (const std::string& file : files) append_file(file, seen, source);
  return source;
}

cl::Program build_program(const Device& device, const std::vector<std::string>& files, const std::string& options) {
  std::string key = options;
  for (const std::string& file : files) key += " " + file;
  return cache_of(device).programs.get(key, [&] {
    return build(cl::Context(device.context(), true), cl::Device(device.id(), true), assemble_source(files), options);
  });
}

}  // namespace dermis
