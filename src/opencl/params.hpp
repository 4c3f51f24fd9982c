// kernels/params.h, as C++.
#pragma once

#include "dermis/frame.hpp"

namespace dermis::params {
#include "params.h"

// Kernels take these by value: a size that differs from theirs would shift all arguments that follow.
static_assert(sizeof(ImageParams) == 2 * sizeof(Bytes) + 4 * sizeof(int));
static_assert(sizeof(FrameLayouts) == 10 * sizeof(ImageParams));
static_assert(sizeof(ViewLayouts) == 5 * sizeof(ImageParams));
static_assert(sizeof(ViewParams) == 2 * sizeof(int) + 12 * sizeof(float));
static_assert(sizeof(RunFlags) == 7 * sizeof(int));
static_assert(sizeof(TapLevelParams) == LEVEL_WORDS * sizeof(int));
static_assert(sizeof(FrameParams) == 8 * sizeof(int) + 10 * sizeof(float));
static_assert(sizeof(TileParams) == 6 * sizeof(int));
static_assert(sizeof(WindowLayout) == 8 * sizeof(Bytes));
static_assert(sizeof(WindowParams) == sizeof(WindowLayout) + 6 * sizeof(int));
static_assert(sizeof(TileMemory) == 2 * sizeof(WindowLayout) + 6 * sizeof(Bytes));
static_assert(sizeof(TapTables) == 5 * sizeof(Bytes));
static_assert(sizeof(TexelLevels) == (MOST_TEXEL_LEVELS + 1) * sizeof(Bytes) + 2 * sizeof(int));
static_assert(LARGEST_LIGHT == largest_light);
static_assert(sizeof(DiscCounts) == 4 * sizeof(int));
}  // namespace dermis::params
