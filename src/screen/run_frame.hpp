// Runs a frame on a plan and waits for it: at once, or band by band where memory does not suffice for all rows.
#pragma once

#include <span>

#include "screen/frame_images.hpp"
#include "screen/plan_state.hpp"
#include "screen/reuse.hpp"

namespace dermis {

/// `images` are those of the frame, checked. `reuse` is what the frame before has left, or null.
Stats run_frame(const Plan::State& plan, const Frame& frame, std::span<const CallerImage, image_count> images,
                Reuse::State* reuse, const Progress& progress);

/// Throws Error(device) if the memory that a run may take does not suffice for all rows of a frame whose images are
/// buffers.
void check_memory(const Plan::State& plan, const FrameSize& frame);

}  // namespace dermis
