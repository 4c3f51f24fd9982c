// The image library for those who link OpenImageIO, as users of dermis_exr do.
#include "exr/image_library.hpp"

namespace dermis::exr {

const ImageLibrary& image_library() { return *dermis_image_library(); }

}  // namespace dermis::exr
