// The image library for the program, which loads it at the first call.
#include <dlfcn.h>

#include <cstdint>

#include "dermis/error.hpp"
#include "exr/image_library.hpp"
#include "exr/memory_limit.hpp"

namespace dermis::exr {
namespace {

using Entry = const ImageLibrary* (*)();

/// The message of the loader names the file.
[[noreturn]] void cannot_load() {
  throw Error(ErrorCode::input_missing, "image library", dlerror(), "the module that is installed with dermis");
}

const ImageLibrary& load() {
  // Measured: below 750 MB the loader or OpenEXR's threads fail.
  require_addresses("image library", std::uint64_t{850} << 20, std::uint64_t{10} << 20);
  // The loader puts the folder of the program in place of $ORIGIN. To bind all functions of 260 libraries at once would
  // take a tenth longer. The module stays loaded, for threads of those libraries run to the end.
  void* const module = dlopen("$ORIGIN/" DERMIS_IMAGE_MODULE, RTLD_LAZY | RTLD_LOCAL);
  if (module == nullptr) cannot_load();
  void* const entry = dlsym(module, "dermis_image_library");
  if (entry == nullptr) cannot_load();
  return *reinterpret_cast<Entry>(entry)();
}

}  // namespace

const ImageLibrary& image_library() {
  static const ImageLibrary& library = load();
  return library;
}

}  // namespace dermis::exr
