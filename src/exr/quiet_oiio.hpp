/// OpenImageIO without its talk.
#pragma once

#include <OpenImageIO/imageio.h>

namespace dermis::exr {

/// While this lives, OpenImageIO prints no debug messages: some builds do so by default, for each attribute that they
/// cannot store.
class Quiet {
 public:
  Quiet() {
    OIIO::getattribute("debug", before_);
    OIIO::attribute("debug", 0);
  }
  ~Quiet() { OIIO::attribute("debug", before_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  int before_ = 0;
};

}  // namespace dermis::exr
