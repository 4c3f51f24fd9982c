// A picture of one black channel with the attributes of a spec, written by OpenImageIO.
#pragma once

#include <OpenImageIO/imageio.h>

#include <vector>

#include "dermis/exr.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

inline dermis::exr::Picture picture_with(const OIIO::ImageSpec& spec) {
  const TemporaryFolder folder;
  const auto output = OIIO::ImageOutput::create("x.exr");
  const std::vector<float> values(static_cast<std::size_t>(spec.width * spec.height));
  REQUIRE(output->open(folder / "x.exr", spec));
  REQUIRE(output->write_image(OIIO::TypeFloat, values.data()));
  REQUIRE(output->close());
  return dermis::exr::Picture::read(folder / "x.exr");
}
