// kernels/params.h, as C++.
#pragma once

namespace dermis::params {
#include "params.h"

// Kernels take these by value: a size that differs from theirs would shift all arguments that follow.
static_assert(sizeof(ImageParams) == 2 * 8 + 4 * 4);
static_assert(sizeof(FrameLayouts) == 10 * sizeof(ImageParams));
static_assert(sizeof(ViewLayouts) == 5 * sizeof(ImageParams));
static_assert(sizeof(ViewParams) == 14 * 4);
static_assert(sizeof(RunFlags) == 7 * 4);
static_assert(sizeof(FrameParams) == 15 * 4);
static_assert(sizeof(TileParams) == 6 * 4);
static_assert(sizeof(WindowLayout) == 8 * 8);
static_assert(sizeof(WindowParams) == sizeof(WindowLayout) + 6 * 4);
static_assert(sizeof(TileMemory) == 2 * sizeof(WindowLayout) + 6 * 8);
static_assert(sizeof(TapTables) == 5 * 8);
static_assert(sizeof(TexelLevels) == (MOST_TEXEL_LEVELS + 1) * 8 + 2 * 4);
static_assert(sizeof(DiscCounts) == 4 * 4);
}  // namespace dermis::params
