// The samples of discs, as the kernels read them.
#pragma once

#include <cstdint>
#include <vector>

#include "dermis/plan.hpp"
#include "opencl/params.hpp"

namespace dermis {

inline constexpr int most_disc_samples = 1024;

/// The number of samples of narrow and wide kernels.
params::DiscCounts disc_counts(const DiscOptions& options, std::uint32_t seed);

/// Appends the samples of a material, for its widest channel. Set i of DISC_STARTS shares the light beyond the distance
/// within which i / DISC_STARTS of it leave: sample j of n has the distance of the share in the middle of its part,
/// turned by j golden angles, and stands for the area on which its part of the light would be if R were there what it
/// is at that distance.
void append_disc(const Profile& profile, int channel, const DiscOptions& options,
                 std::vector<params::DiscParams>& discs, std::vector<params::SampleParams>& samples);

}  // namespace dermis
