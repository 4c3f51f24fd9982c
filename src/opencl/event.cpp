#include "dermis/event.hpp"

#include <utility>

#include "opencl/opencl.hpp"

namespace dermis {

Event::Event(cl_event adopted) : event_(adopted) {}

Event::~Event() {
  if (event_ != nullptr) clReleaseEvent(event_);
}

Event::Event(Event&& other) noexcept : event_(std::exchange(other.event_, nullptr)) {}

Event& Event::operator=(Event&& other) noexcept {
  std::swap(event_, other.event_);
  return *this;
}

void Event::wait() const {
  with_device_errors([&] { cl::Event(event_, true).wait(); });
}

}  // namespace dermis
