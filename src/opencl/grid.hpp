// The work-items that a kernel is launched with.
#pragma once

#include <vector>

#include "opencl/device.hpp"
#include "opencl/opencl.hpp"

namespace dermis {

/// A work-item for each column and row, and the size of a work-group. Groups that do not divide the columns or the rows
/// go beyond them, where kernels do nothing.
struct Grid {
  int columns;
  int rows = 1;
  int group_columns = 1;
  int group_rows = 1;
};

/// Columns of a work-group on GPUs: two times what works in step, of any vendor.
inline constexpr int group_line = 64;

/// Work-groups that suit the device: lines on GPUs, single items elsewhere, for PoCL compiles a kernel for every size
/// of group that it is launched with.
inline Grid lines(const Device& device, int columns, int rows = 1) {
  return {columns, rows, item_is_pixel(device) ? group_line : 1, 1};
}

/// Puts a kernel on a queue, to start after some events.
inline cl::Event enqueue(const cl::CommandQueue& queue, const cl::Kernel& kernel, const Grid& grid,
                         const std::vector<cl::Event>& after = {}) {
  const auto whole_groups = [](int items, int group) { return (items + group - 1) / group * group; };
  cl::Event event;
  queue.enqueueNDRangeKernel(
      kernel, cl::NullRange,
      cl::NDRange(whole_groups(grid.columns, grid.group_columns), whole_groups(grid.rows, grid.group_rows)),
      cl::NDRange(grid.group_columns, grid.group_rows), after.empty() ? nullptr : &after, &event);
  return event;
}

}  // namespace dermis
