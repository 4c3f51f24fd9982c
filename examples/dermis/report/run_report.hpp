/// --report: what became of each picture of a call, as JSON, or as a page that leads to those of the pictures.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

namespace dermis::program {

/// The file is whole whenever somebody reads it: it is written again as
/// pictures come, not too often, and at the end.
class RunReport {
 public:
  /// No report if `path` is empty, a page if it ends in .html. `about` stands
  /// before the pictures. Throws Error(output).
  RunReport(std::string path, nlohmann::ordered_json about);

  /// Adds the record of a picture. Throws Error(output).
  void add(nlohmann::ordered_json picture);

  /// The exit code, with which the report is complete. Throws Error(output).
  void finish(int code);

 private:
  void write();

  std::string path_;
  nlohmann::ordered_json all_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace dermis::program
