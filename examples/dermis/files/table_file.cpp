#include "files/table_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>

#include "arguments/number_argument.hpp"
#include "dermis/error.hpp"
#include "exr/message_text.hpp"
#include "files/input_file.hpp"

namespace dermis::program {
namespace {

constexpr std::size_t values_per_row = 4;
constexpr std::size_t most_rows = 4096;  // a plan looks at all of them again and again
constexpr std::array<const char*, values_per_row> column_names = {"r_mm", "R", "G", "B"};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> blocks_of(std::string_view line) {
  std::vector<std::string_view> blocks;
  for (;;) {
    const std::size_t at = line.find(',');
    blocks.push_back(trimmed(line.substr(0, at)));
    if (at == std::string_view::npos) return blocks;
    line.remove_prefix(at + 1);
  }
}

class Reader {
 public:
  Reader(std::string_view argument, const std::string& path) : argument_(argument), path_(path) {}

  std::vector<TableRow> read() {
    std::istringstream file(read_text(argument_, path_, "a CSV file of r_mm,R,G,B"));
    std::vector<TableRow> rows;
    bool first = true;
    for (std::string line; std::getline(file, line);) {
      ++line_;
      constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
      if (line_ == 1 && line.starts_with(byte_order_mark)) line.erase(0, byte_order_mark.size());
      const std::string_view content = trimmed(std::string_view(line).substr(0, line.find('#')));
      if (content.empty()) continue;
      const auto blocks = blocks_of(content);
      if (rows.size() == most_rows) fail("one more row", fmt::format("at most {} rows", most_rows));
      if (!first || !is_header(blocks)) rows.push_back(read_row(blocks, rows.empty() ? -1 : rows.back().r_mm));
      first = false;
    }
    line_ = 0;
    check_all(rows);
    return rows;
  }

 private:
  /// A line without a single number.
  static bool is_header(const std::vector<std::string_view>& blocks) {
    return std::none_of(blocks.begin(), blocks.end(),
                        [](std::string_view block) { return parse_real(block).has_value(); });
  }

  TableRow read_row(const std::vector<std::string_view>& blocks, double last_mm) const {
    if (blocks.size() != values_per_row)
      fail(fmt::format("{} column{}", blocks.size(), blocks.size() == 1 ? "" : "s"), "four: r_mm,R,G,B");
    TableRow row{read_number(blocks, 0), {}};
    if (row.r_mm != 0 && (row.r_mm < 1e-9 || row.r_mm > 1e9))
      fail(fmt::format("r_mm = {}", row.r_mm), "0 or 1e-9 to 1e9 mm");
    if (row.r_mm <= last_mm) fail(fmt::format("r_mm = {} after {}", row.r_mm, last_mm), "ascending distances");
    for (std::size_t channel = 0; channel < 3; ++channel) row.value[channel] = read_number(blocks, channel + 1);
    return row;
  }

  double read_number(const std::vector<std::string_view>& blocks, std::size_t column) const {
    const auto number = parse_real(blocks[column]);
    if (!number || *number < 0 || *number > 1e100)
      fail(fmt::format("{} = {}", column_names[column], exr::shown(blocks[column])), "a number from 0 to 1e100");
    return *number;
  }

  void check_all(const std::vector<TableRow>& rows) const {
    if (rows.size() < 2) fail(fmt::format("{} row{} in all", rows.size(), rows.size() == 1 ? "" : "s"), "2 or more");
    for (std::size_t channel = 0; channel < 3; ++channel)
      if (std::none_of(rows.begin(), rows.end(), [&](const TableRow& row) { return row.value[channel] >= 1e-100; }))
        fail(fmt::format("nothing above 0 in column {}", column_names[channel + 1]), "light in every channel");
  }

  [[noreturn]] void fail(std::string_view seen, std::string_view wanted) const {
    const std::string place = line_ > 0 ? fmt::format(" line {}", line_) : "";
    throw Error(ErrorCode::input_unsupported, fmt::format("{} {}{}", argument_, path_, place), seen, wanted);
  }

  std::string argument_;
  std::string path_;
  int line_ = 0;  // 0 for the file as a whole
};

}  // namespace

std::vector<TableRow> read_table(std::string_view argument, const std::string& path) {
  return Reader(argument, path).read();
}

}  // namespace dermis::program
