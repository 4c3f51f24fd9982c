// The attributes of a picture, from the header as it stands in the file.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/header.hpp"
#include "exr/header_check.hpp"
#include "exr/message_text.hpp"
#include "exr/picture_state.hpp"

namespace dermis::exr {
namespace {

enum class Element { int32, float32, float64 };

struct NumericType {
  std::string_view type;
  Element element;
};

/// Types whose values are numbers one after the other, as many as the value has bytes for.
constexpr std::array numeric_types = {
    NumericType{"int", Element::int32},           NumericType{"v2i", Element::int32},
    NumericType{"v3i", Element::int32},           NumericType{"float", Element::float32},
    NumericType{"v2f", Element::float32},         NumericType{"v3f", Element::float32},
    NumericType{"m33f", Element::float32},        NumericType{"m44f", Element::float32},
    NumericType{"floatvector", Element::float32}, NumericType{"double", Element::float64},
    NumericType{"v2d", Element::float64},         NumericType{"v3d", Element::float64},
    NumericType{"m33d", Element::float64},        NumericType{"m44d", Element::float64},
};

double number_at(std::string_view bytes, Element element) {
  const std::uint32_t low = little_endian(bytes);
  switch (element) {
    case Element::int32:
      return std::bit_cast<std::int32_t>(low);
    case Element::float32:
      return static_cast<double>(std::bit_cast<float>(low));
    default:
      return std::bit_cast<double>((std::uint64_t{little_endian(bytes.substr(4))} << 32) | low);
  }
}

std::vector<double> numbers_in(std::string_view bytes, Element element) {
  const std::size_t size = element == Element::float64 ? 8 : 4;
  std::vector<double> numbers;
  for (; bytes.size() >= size; bytes.remove_prefix(size)) numbers.push_back(number_at(bytes, element));
  return numbers;
}

/// Numbers with blanks or commas between them; empty if there is anything else.
std::vector<double> numbers_in_text(std::string_view text) {
  constexpr std::string_view separators = " \t\n,";
  std::vector<double> numbers;
  while (true) {
    const std::size_t start = text.find_first_not_of(separators);
    if (start == std::string_view::npos) return numbers;
    text.remove_prefix(start);
    const std::string_view word = text.substr(0, text.find_first_of(separators));
    double value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || stop != word.data() + word.size()) return {};
    numbers.push_back(value);
    text.remove_prefix(word.size());
  }
}

template <typename Header>
auto* find_attribute(Header& header, std::string_view name) {
  const auto it = std::find_if(header.begin(), header.end(),
                               [name](const HeaderAttribute& attribute) { return attribute.name == name; });
  return it == header.end() ? nullptr : &*it;
}

}  // namespace

std::vector<std::string> Picture::attribute_names() const {
  std::vector<std::string> names;
  for (const HeaderAttribute& attribute : state_->header) names.push_back(attribute.name);
  return names;
}

std::optional<std::string> Picture::text_attribute(std::string_view name) const {
  const HeaderAttribute* attribute = find_attribute(state_->header, name);
  return attribute != nullptr && attribute->type == "string" ? std::optional(attribute->value) : std::nullopt;
}

std::vector<double> Picture::number_attribute(std::string_view name) const {
  const HeaderAttribute* attribute = find_attribute(state_->header, name);
  if (attribute == nullptr) return {};
  if (attribute->type == "string") return numbers_in_text(attribute->value);
  const auto* const numeric = std::find_if(numeric_types.begin(), numeric_types.end(),
                                           [&](const NumericType& row) { return row.type == attribute->type; });
  return numeric == numeric_types.end() ? std::vector<double>{} : numbers_in(attribute->value, numeric->element);
}

void Picture::set_attribute(std::string_view name, std::string_view value) {
  if (name.empty() || name.size() > max_name || name.find('\0') != std::string_view::npos) {
    throw Error(ErrorCode::usage, "name of an attribute", '"' + escaped(name) + '"', "1 to 255 characters");
  }
  state_->description.attributes->set_text(name, value);
  const HeaderAttribute text{std::string(name), "string", std::string(value)};
  if (HeaderAttribute* before = find_attribute(state_->header, name)) {
    *before = text;
  } else {
    state_->header.push_back(text);
  }
}

}  // namespace dermis::exr
