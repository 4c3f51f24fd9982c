#include "report/run_report.hpp"

#include <utility>

#include "files/output_file.hpp"
#include "report/json_text.hpp"

namespace dermis::program {

RunReport::RunReport(std::string path, nlohmann::ordered_json about) : path_(std::move(path)), all_(std::move(about)) {
  all_["exit_code"] = nullptr;  // as long as the call runs
  all_["pictures"] = nlohmann::ordered_json::array();
  write();
}

void RunReport::add(nlohmann::ordered_json picture) {
  if (path_.empty()) return;
  all_["pictures"].push_back(std::move(picture));
  if (std::chrono::steady_clock::now() - last_ >= std::chrono::seconds(5)) write();
}

void RunReport::finish(int code) {
  all_["exit_code"] = code;
  write();
}

void RunReport::write() {
  if (path_.empty()) return;
  write_file("--report", path_, json_text(all_));
  last_ = std::chrono::steady_clock::now();
}

}  // namespace dermis::program
