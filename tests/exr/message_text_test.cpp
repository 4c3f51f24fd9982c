#include "exr/message_text.hpp"

#include <string>
#include <utility>
#include <vector>

#include "support/catch.hpp"
#include "support/random.hpp"

using dermis::exr::escaped;
using dermis::exr::escaped_lines;
using dermis::exr::shown;

TEST_CASE("text of any language stays as it is", "[text]") {
  for (const std::string text : {"Haut_Größe", "皮膚.R", "кожа", "جلد", "𝒮kin", "a b/c\\d'e\"f`$(g)", "\u00A0\u00AD"}) {
    INFO(text);
    CHECK(escaped(text) == text);
  }
}

TEST_CASE("what steers a terminal, ends a line or is no UTF-8 is escaped", "[text]") {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"a\x1b[31mb", "a\\x1b[31mb"},
      {"a\nb\rc\td", "a\\x0ab\\x0dc\\x09d"},
      {std::string("a\0b", 3), "a\\x00b"},
      {"\x7f", "\\x7f"},
      {"\xc2\x9b"
       "31m",
       "\\xc2\\x9b31m"},  // CSI as one character
      {"\u202Eexr.\u202C", "\\xe2\\x80\\xaeexr.\\xe2\\x80\\xac"},
      {"\u2066x\u2069", "\\xe2\\x81\\xa6x\\xe2\\x81\\xa9"},
      {"\u2028\u2029", "\\xe2\\x80\\xa8\\xe2\\x80\\xa9"},
      {"\u200F", "\\xe2\\x80\\x8f"},
      {"\x9b", "\\x9b"},
      {"a\xff", "a\\xff"},
      {"\xe2\x80", "\\xe2\\x80"},                   // cut
      {"\xc0\x8a", "\\xc0\\x8a"},                   // a line end in two bytes
      {"\xe0\x80\x9b", "\\xe0\\x80\\x9b"},          // in three
      {"\xed\xa0\x80", "\\xed\\xa0\\x80"},          // a surrogate
      {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"}  // beyond the last character
  };
  for (const auto& [text, wanted] : cases) {
    INFO(wanted);
    CHECK(escaped(text) == wanted);
  }
  CHECK(escaped_lines("a\nb\r\n\u202E\n") == "a\nb\\x0d\n\\xe2\\x80\\xae\n");
}

TEST_CASE("no bytes become anything but harmless text, and it stays so", "[text]") {
  Random random(43);
  for (int i = 0; i < 2000; ++i) {
    std::string text;
    for (int length = random.integer(0, 12); length > 0; --length)
      text += random.coin() ? static_cast<char>(random.integer(0, 255)) : "\xe2\x80\xae\xc2\x9b"[random.integer(0, 4)];
    const std::string once = escaped(text);
    CHECK(escaped(once) == once);
    for (const char c : once) CHECK((static_cast<unsigned char>(c) >= 0x20 && c != 0x7f));
  }
}

TEST_CASE("values are cut after 80 bytes, other text after as many as wanted", "[text]") {
  const std::string longest(80, 'x');
  CHECK(shown(longest) == longest);
  CHECK(shown(longest + 'x') == longest + "...");
  CHECK(escaped("\x1b\x1b\x1b", 2) == "\\x1b\\x1b...");
  CHECK(escaped(std::string(1 << 20, 'x')).size() == 1003);
  CHECK(escaped("äääääääääää", 3) == "ää...");
}
