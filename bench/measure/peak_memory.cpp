#include "measure/peak_memory.hpp"

#include <algorithm>
#include <fstream>
#include <string>

namespace dermis::bench {

namespace {

/// A line of /proc/self/status, MB of 2^20 bytes; 0 if there is none.
double status_mb(const std::string& key) {
  std::ifstream lines("/proc/self/status");
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(key)) return std::stod(line.substr(key.size())) / 1024;
  }
  return 0;
}

bool take_mark_back() {
  std::ofstream file("/proc/self/clear_refs");
  file << "5";
  return static_cast<bool>(file.flush());
}

}  // namespace

PeakMemory::PeakMemory() : start_mb_(take_mark_back() ? status_mb("VmRSS:") : -1) {}

double PeakMemory::mb() const { return start_mb_ < 0 ? 0 : std::max(0.0, process_peak_mb() - start_mb_); }

double process_peak_mb() { return status_mb("VmHWM:"); }

}  // namespace dermis::bench
