// gather_map copies the depths of one shadow map, from any format, into the buffer of all maps.
#include "frame/space.h"

// A work-item has one texel.
kernel void gather_map(global const uchar* map, struct ImageParams map_at, int width, global float* maps,
                       int first_texel) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= width) return;
  maps[first_texel + y * width + x] = read_value(map, &map_at, width, x, y);
}
