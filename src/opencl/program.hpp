// From embedded kernel files to a built OpenCL program.
#pragma once

#include <string>
#include <vector>

#include "dermis/device.hpp"
#include "opencl/opencl.hpp"

namespace dermis {

/// Puts kernel files together, each #include of one replaced by its text the first time and dropped after that.
std::string assemble_source(const std::vector<std::string>& files);

/// A program before it is built: build_program takes both.
struct ProgramSource {
  std::vector<std::string> files;
  std::string options;
};

/// A build option that defines a name.
inline std::string build_constant(const char* name, int value) {
  return std::string(" -D") + name + "=" + std::to_string(value);
}

/// Builds the files with the options, once per device. Throws Error(device) with the first error of the
/// build log.
cl::Program build_program(const Device& device, const std::vector<std::string>& files, const std::string& options);

}  // namespace dermis
