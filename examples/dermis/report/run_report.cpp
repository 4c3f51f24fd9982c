#include "report/run_report.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <utility>

#include "files/output_file.hpp"
#include "report/html.hpp"
#include "report/json_text.hpp"

namespace dermis::program {
namespace {

using nlohmann::ordered_json;

/// A row for a picture, with a link to its page if it has one beside this one.
std::string row_of(const ordered_json& picture) {
  const std::filesystem::path page = picture.value("page", "");
  const std::string name = html_of(std::filesystem::path(picture["input"].get<std::string>()).filename().string());
  const std::string frame = picture["frame"].is_null() ? "" : picture["frame"].dump();
  double ms = 0;
  std::size_t warnings = 0;
  for (const ordered_json& view : picture.value("views", ordered_json::array())) {
    ms += view["times_ms"]["total"].get<double>();
    warnings += view["warnings"].size();
  }
  return fmt::format(
      "<tr><td>{}</td><td>{}</td><td{}>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", frame,
      page.empty() ? name : fmt::format("<a href=\"{}\">{}</a>", link_to(page.filename().string()), name),
      picture["status"] == "failed" || picture["status"] == "missing" ? " class=\"bad\"" : "",
      html_of(picture["status"].get<std::string>()), ms > 0 ? fmt::format("{:.0f} ms", ms) : "",
      warnings > 0 ? std::to_string(warnings) : "", html_of(picture.value("message", "")));
}

/// The pictures of a call as a page.
std::string list_page(const ordered_json& all) {
  const std::string code = all["exit_code"].is_null() ? "it runs" : "exit code " + all["exit_code"].dump();
  std::string rows;
  for (const ordered_json& picture : all["pictures"]) rows += row_of(picture);
  return page_of("dermis filter",
                 fmt::format("<p>{} pictures, {}</p>\n<table>\n<tr><th>Frame</th><th>Picture</th><th>Status</th>"
                             "<th>Time</th><th>Warnings</th><th>Error</th></tr>\n{}</table>\n<h2>Command</h2>\n"
                             "<pre>dermis {}</pre>\n",
                             all["pictures"].size(), code, rows, html_of(all["command"].get<std::string>())));
}

}  // namespace

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
  write_file("--report", path_, path_.ends_with(".html") ? list_page(all_) : json_text(all_));
  last_ = std::chrono::steady_clock::now();
}

}  // namespace dermis::program
