/// OpenImageIO without its talk.
#pragma once

#include <OpenImageIO/imageio.h>

#include <mutex>

namespace dermis::exr {

/// While this lives, OpenImageIO prints no debug messages: some builds do so by default, for each attribute that they
/// cannot store.
class Quiet {
 public:
  Quiet() {
    const std::lock_guard lock(mutex_);
    if (count_++ > 0) return;
    OIIO::getattribute("debug", before_);
    OIIO::attribute("debug", 0);
  }
  ~Quiet() {
    const std::lock_guard lock(mutex_);
    if (--count_ == 0) OIIO::attribute("debug", before_);
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  // Of several threads, as the attribute is.
  static inline std::mutex mutex_;
  static inline int count_ = 0;
  static inline int before_ = 0;
};

}  // namespace dermis::exr
