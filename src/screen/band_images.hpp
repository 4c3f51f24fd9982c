// The images of a band of a frame in host memory, copied out of the caller's.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "screen/frame_images.hpp"
#include "screen/frame_size.hpp"

namespace dermis {

class BandImages {
 public:
  /// Has room for so many rows of the images of a frame.
  BandImages(const Frame& frame, std::span<const CallerImage, image_count> images, int most_rows);

  /// Reads rows of the images. Bands come from the top to the bottom: rows that are here already are kept, so that each
  /// is read once, before any row of an output that may lie over it is written.
  void load(RowRange rows);

  /// The frame of the rows that are here, with the camera of the whole frame.
  Frame frame() const;

  /// Writes rows of the outputs, of the whole frame, to the caller's.
  void write(RowRange rows) const;

  /// Bytes of each image for so many rows; 0 for one that is not there.
  static std::array<std::size_t, image_count> bytes(std::span<const CallerImage, image_count> images, int width,
                                                    int rows);

 private:
  struct BandImage {
    CallerImage callers;
    Layout layout;                  ///< here: rows of a channel after those of another
    std::vector<std::byte> memory;  ///< empty if there is no such image
  };

  Frame whole_;
  std::array<BandImage, image_count> images_;
  RowRange rows_{0, 0};
};

}  // namespace dermis
