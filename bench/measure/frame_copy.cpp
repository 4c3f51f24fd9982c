#include "measure/frame_copy.hpp"

#include "support/parallel.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace dermis::bench {

namespace {

constexpr std::size_t block = 4096;  // floats: four pages of 4 KiB

/// The depth is added to the first plane, so that it is read.
void copy_plainly(const float* from, float* to, std::size_t stride, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    to[i] = from[i] + from[3 * stride + i];
    to[stride + i] = from[stride + i];
    to[2 * stride + i] = from[2 * stride + i];
  }
}

#if defined(__x86_64__)
__attribute__((target("avx"))) void copy_past_caches(const float* from, float* to, std::size_t stride,
                                                     std::size_t begin, std::size_t end) {
  const float* depth = from + 3 * stride;
  for (std::size_t i = begin; i < end; i += 8) {
    _mm256_stream_ps(to + i, _mm256_add_ps(_mm256_load_ps(from + i), _mm256_load_ps(depth + i)));
    _mm256_stream_ps(to + stride + i, _mm256_load_ps(from + stride + i));
    _mm256_stream_ps(to + 2 * stride + i, _mm256_load_ps(from + 2 * stride + i));
  }
  _mm_sfence();
}

bool has_avx() { return __builtin_cpu_supports("avx") != 0; }
#else
constexpr auto copy_past_caches = copy_plainly;
bool has_avx() { return false; }
#endif

}  // namespace

FrameCopy::FrameCopy(std::size_t pixels)
    : stride_((pixels + block - 1) / block * block), from_(4 * stride_, 1.0F), to_(3 * stride_, 1.0F) {}

void FrameCopy::run() {
  static const auto copy = has_avx() ? copy_past_caches : copy_plainly;
  const std::size_t blocks = stride_ / block;
  on_all_cores([&](std::size_t worker, std::size_t workers) {
    copy(from_.data(), to_.data(), stride_, blocks * worker / workers * block, blocks * (worker + 1) / workers * block);
  });
}

}  // namespace dermis::bench
