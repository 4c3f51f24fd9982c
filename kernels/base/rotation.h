// Random rotation of the tap axes (Jimenez et al. 2015, section 6), in integers only, so that every device agrees.
#include "base/vector.h"

// An index of RotationParams for each pixel: a mix of its position and the seed by the finalizer of MurmurHash3.
static inline vint rotation_index(vint x, vint y, uint seed) {
#if V == 1
#define AS_UINT(v) as_uint(v)
#define AS_INT(v) as_int(v)
  uint h;
#else
#define AS_UINT(v) JOIN(as_uint, V)(v)
#define AS_INT(v) as_vint(v)
  JOIN(uint, V) h;
#endif
  h = (AS_UINT(x) * 0x9E3779B1u) ^ (AS_UINT(y) * 0x85EBCA77u) ^ (seed * 0xC2B2AE3Du);
  h ^= h >> 16;
  h *= 0x85EBCA6Bu;
  h ^= h >> 13;
  h *= 0xC2B2AE35u;
  h ^= h >> 16;
  return AS_INT(h >> 24);
#undef AS_UINT
#undef AS_INT
}
