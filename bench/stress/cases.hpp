// The groups of cases. Each adds its rows.
#pragma once

#include <random>
#include <vector>

#include "stress/filter.hpp"
#include "stress/rows.hpp"

namespace dermis::bench {

void add_light_cases(std::vector<StressRow>& rows, const StressFilter& flat, std::mt19937& engine);
void add_frame_cases(std::vector<StressRow>& rows, const StressFilter& flat, std::mt19937& engine);
void add_depth_cases(std::vector<StressRow>& rows, const StressFilter& deep, std::mt19937& engine);
void add_camera_cases(std::vector<StressRow>& rows, const StressFilter& deep, std::mt19937& engine);
void add_bad_light_cases(std::vector<StressRow>& rows, const Device& device, const StressFilter& deep,
                         std::mt19937& engine);
void add_method_cases(std::vector<StressRow>& rows, const Device& device, std::mt19937& engine);
void add_width_cases(std::vector<StressRow>& rows, const Device& device, std::mt19937& engine);

/// Depth that is none: background.
StressRow missing_depth(const StressFilter& deep, const StressField& field, std::mt19937& engine);

}  // namespace dermis::bench
