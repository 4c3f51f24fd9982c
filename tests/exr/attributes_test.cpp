#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "exr/picture_with.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using dermis::exr::Picture;

TEST_CASE("the attributes of a file are read as text and as numbers") {
  Random random(31);
  std::array<float, 16> matrix;
  for (float& value : matrix) value = static_cast<float>(random.uniform(-100, 100));
  const int whole = random.integer(-1000, 1000);
  const auto real = static_cast<float>(random.uniform(-1000, 1000));
  OIIO::ImageSpec spec(3, 2, 1, OIIO::TypeHalf);
  spec.attribute("a/whole", whole);
  spec.attribute("a/real", real);
  spec.attribute("a/matrix", OIIO::TypeMatrix44, matrix.data());
  spec.attribute("a/text", "skin");
  spec.attribute("a/number", " 39.5 ");
  spec.attribute("a/numbers", "1,-2e3 4");
  spec.attribute("a/unit", "50 mm");
  const Picture picture = picture_with(spec);

  REQUIRE(picture.number_attribute("a/whole") == std::vector<double>{static_cast<double>(whole)});
  REQUIRE(picture.number_attribute("a/real") == std::vector<double>{static_cast<double>(real)});
  REQUIRE(picture.number_attribute("a/matrix") == std::vector<double>(matrix.begin(), matrix.end()));
  REQUIRE(picture.number_attribute("a/number") == std::vector<double>{39.5});
  REQUIRE(picture.number_attribute("a/numbers") == std::vector<double>{1, -2000, 4});
  REQUIRE(picture.number_attribute("a/unit").empty());
  REQUIRE(picture.number_attribute("a/text").empty());
  REQUIRE(picture.number_attribute("nothing").empty());
  REQUIRE(picture.number_attribute("channels").empty());
  REQUIRE(picture.text_attribute("a/text") == "skin");
  REQUIRE_FALSE(picture.text_attribute("a/whole"));
  REQUIRE_FALSE(picture.text_attribute("nothing"));
  const std::vector<std::string> names = picture.attribute_names();
  REQUIRE(std::find(names.begin(), names.end(), "a/matrix") != names.end());
}

TEST_CASE("an attribute that is set is there, once") {
  Picture picture({0, 0, 4, 4}, {0, 0, 4, 4});
  REQUIRE(picture.attribute_names().empty());
  picture.set_attribute("a", "1");
  picture.set_attribute("a", "2");
  REQUIRE(picture.attribute_names() == std::vector<std::string>{"a"});
  REQUIRE(picture.text_attribute("a") == "2");
  REQUIRE(picture.number_attribute("a") == std::vector<double>{2});
}
