/// Work that was handed to a queue of the caller.
#pragma once

#include <utility>

struct _cl_command_queue;
struct _cl_event;
using cl_command_queue = struct _cl_command_queue*;
using cl_event = struct _cl_event*;

namespace dermis {

/// The event of the last command of some work. Releases its OpenCL event when it goes.
class Event {
 public:
  explicit Event(cl_event adopted);
  ~Event();
  Event(Event&& other) noexcept;
  Event& operator=(Event&& other) noexcept;
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;

  /// Blocks until the work is done. Throws Error(device) if it failed.
  void wait() const;
  cl_event handle() const { return event_; }
  /// Hands the OpenCL event over to the caller, who releases it.
  cl_event release() { return std::exchange(event_, nullptr); }

 private:
  cl_event event_;
};

}  // namespace dermis
