// A frame with lights on a queue, waited for or not.
#pragma once

#include <span>

#include "lighting/light_tables.hpp"
#include "opencl/device_cache.hpp"
#include "opencl/memory_pool.hpp"

namespace dermis {

/// Runs `launch(commands, images, memory)` on a queue of the device, and waits for it.
template <class Launch>
void run_lit(const Device& device, MemoryPool<LightMemory>& memories, const cl::Program& program, int width, int height,
             std::span<const CallerImage> images, std::span<const Light> lights, const Launch& launch) {
  const BorrowedQueue queue(device);
  CommandChain commands(*queue);
  const ImageBuffers bound(device, *queue, width, height, images);
  const BorrowedMemory<LightMemory> memory(memories, device, *queue, sizes_of(lights));
  const BoundLights bound_lights(device, commands, program, lights, *memory);
  launch(commands, bound, *memory);
  bound.read_back();
}

/// Puts it on a queue of the caller. Throws Error(usage) if an image is in host memory.
template <class Launch>
Event enqueue_lit(const Device& device, MemoryPool<LightMemory>& memories, const cl::Program& program, int width,
                  int height, std::span<const CallerImage> images, std::span<const Light> lights, const Launch& launch,
                  cl_command_queue queue, std::span<const cl_event> wait_for) {
  check_enqueued(queue, images);
  check_enqueued(queue, map_images(lights));
  CommandChain commands(cl::CommandQueue(queue, true), wait_for);
  const ImageBuffers bound(device, commands.queue(), width, height, images);
  auto lent = memories.take_in_turn(device, sizes_of(lights));
  commands.wait_for(lent.used_until);
  const BoundLights bound_lights(device, commands, program, lights, *lent.memory);
  launch(commands, bound, *lent.memory);
  lent.used_until = cl::Event(commands.last());
  memories.give_back(std::move(lent));
  return commands.hand_over();
}

}  // namespace dermis
