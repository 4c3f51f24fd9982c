// Commands on a queue, of which each starts after the one before, whether the queue runs in order or not.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "dermis/event.hpp"
#include "opencl/grid.hpp"
#include "opencl/image_buffers.hpp"
#include "opencl/opencl.hpp"

namespace dermis {

class CommandChain {
 public:
  /// The first command starts after these events.
  explicit CommandChain(cl::CommandQueue queue, std::span<const cl_event> wait_for = {}) : queue_(std::move(queue)) {
    for (const cl_event event : wait_for) last_.emplace_back(event, true);
  }

  const cl::CommandQueue& queue() const { return queue_; }

  /// The next command starts after that event, too, unless it is null.
  void wait_for(const cl::Event& event) {
    if (event() != nullptr) last_.push_back(event);
  }

  cl::Event launch(const cl::Kernel& kernel, const Grid& grid) { return add(enqueue(queue_, kernel, grid, last_)); }

  template <class Value>
  void fill(const cl::Buffer& buffer, Value value, std::size_t offset, std::size_t bytes) {
    cl::Event event;
    queue_.enqueueFillBuffer(buffer, value, offset, bytes, before(), &event);
    add(event);
  }

  /// Writes rows to the start of a buffer, from a copy of them, so that the caller's need not stay.
  template <class Row>
  void write(const cl::Buffer& buffer, const std::vector<Row>& rows) {
    auto copy = std::make_unique<std::vector<Row>>(rows);
    cl::Event event;
    queue_.enqueueWriteBuffer(buffer, CL_FALSE, 0, rows.size() * sizeof(Row), copy->data(), before(), &event);
    event.setCallback(  // where that fails, the copy stays, as the device may still read it
        CL_COMPLETE, [](cl_event, cl_int, void* its_copy) { delete static_cast<std::vector<Row>*>(its_copy); },
        copy.release());
    add(event);
  }

  /// The event of the last command.
  const cl::Event& last() const { return last_.front(); }

  /// Hands the commands to the device, and their last event to the caller.
  Event hand_over() const {
    queue_.flush();
    cl::Event copy = last();
    return Event(std::exchange(copy(), nullptr));
  }

 private:
  const std::vector<cl::Event>* before() const { return last_.empty() ? nullptr : &last_; }

  cl::Event add(const cl::Event& event) {
    last_ = std::vector{event};
    return event;
  }

  cl::CommandQueue queue_;
  std::vector<cl::Event> last_;
};

/// Throws Error(usage) unless there is a queue and all images are buffers, as for work that nobody waits for.
inline void check_enqueued(cl_command_queue queue, std::span<const CallerImage> images) {
  if (queue == nullptr) throw Error(ErrorCode::usage, "queue", "nullptr", "an OpenCL command queue");
  for (const CallerImage& image : images) {
    if (image.host != nullptr) throw Error(ErrorCode::usage, image.name, "host memory", "a buffer, to enqueue");
  }
}

}  // namespace dermis
