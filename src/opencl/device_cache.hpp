// Programs and taps that the plans of one device share. They do not change once they are made.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/device.hpp"
#include "dermis/profile.hpp"
#include "dermis/tap_tables.hpp"
#include "opencl/opencl.hpp"
#include "opencl/recent.hpp"

namespace dermis {

/// Taps are fitted to this.
struct FitKey {
  Profile profile;
  TapsDesign design;
  bool operator==(const FitKey&) const = default;
};

struct DeviceCache {
  /// The key is files and build options. A program holds a few MB of code; a caller who changes options, or the images
  /// of its frames, needs a handful of them.
  Recent<std::string, cl::Program> programs{16, [](const cl::Program&) { return 1; }};
  /// A usual level table takes 0.7 MB, so ninety fit.
  Recent<FitKey, std::shared_ptr<const Taps>> taps{std::size_t{64} << 20,
                                                   [](const auto& its) { return bytes_of(*its); }};
  /// Designs without a rank, with the rank that was found for them.
  Recent<FitKey, TapsDesign> designs{1024, [](const TapsDesign&) { return 1; }};

  /// Queues that no run has.
  std::vector<cl::CommandQueue> queues;
  std::mutex queues_mutex;

  /// Buffers that no run has, for copies of images; the last ones to come back are kept.
  std::vector<cl::Buffer> copies;
  std::mutex copies_mutex;

  static std::size_t bytes_of(const Taps& taps);
};

/// The cache that a device shares with its copies.
DeviceCache& cache_of(const Device& device);

/// A queue that measures times, for one run at a time: the run's commands have ended when it gives the queue back. The
/// device keeps the queue for the next run.
class BorrowedQueue {
 public:
  /// The device outlives it.
  explicit BorrowedQueue(const Device& device);
  ~BorrowedQueue();
  BorrowedQueue(const BorrowedQueue&) = delete;
  BorrowedQueue& operator=(const BorrowedQueue&) = delete;

  const cl::CommandQueue& operator*() const { return queue_; }

 private:
  DeviceCache& cache_;
  cl::CommandQueue queue_;
};

/// A buffer for a copy of an image, for one run at a time. The device keeps it for the next run.
class BorrowedBuffer {
 public:
  /// The device outlives it. Throws as device_buffer.
  BorrowedBuffer(const Device& device, std::string_view name, std::size_t bytes);
  ~BorrowedBuffer();
  BorrowedBuffer(BorrowedBuffer&&) noexcept = default;
  BorrowedBuffer& operator=(BorrowedBuffer&&) = delete;
  BorrowedBuffer(const BorrowedBuffer&) = delete;
  BorrowedBuffer& operator=(const BorrowedBuffer&) = delete;

  const cl::Buffer& operator*() const { return buffer_; }

 private:
  DeviceCache& cache_;
  cl::Buffer buffer_;
};

}  // namespace dermis
