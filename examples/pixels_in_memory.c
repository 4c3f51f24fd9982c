/* A caller in C with its pixels in memory: float RGB light and float depth in, scattered light out. */
#include <dermis/dermis.h>
#include <stdio.h>
#include <stdlib.h>

enum { width = 160, height = 90 };

static float light[3 * width * height], depth[width * height], scattered[3 * width * height];

static void check(dermis_code code) {
  if (code == DERMIS_DONE) return;
  fprintf(stderr, "%s\n", dermis_error_message());
  exit(code);
}

int main(void) {
  /* A wall 100 mm away, lit from the left up to a hard shadow edge just before the middle; 4 px to the millimetre. */
  for (int i = 0; i < width * height; ++i) {
    depth[i] = 100;
    for (int c = 0; c < 3; ++c) light[3 * i + c] = i % width < width / 2 - 2 ? 1 : 0.02F;
  }
  dermis_frame* frame = NULL;
  check(dermis_frame_create(width, height, &frame));
  check(dermis_frame_set_image(frame, "light", light, NULL));
  check(dermis_frame_set_image(frame, "depth", depth, NULL));
  check(dermis_frame_set_output(frame, "scattered", scattered, NULL));
  check(dermis_frame_set_perspective(frame, 400, 400, width / 2.0, height / 2.0));
  check(dermis_frame_set_mm_per_unit(frame, 1));

  /* A pixel spans 0.25 mm of the wall, which decides how many taps the quality takes. */
  dermis_profile* skin = NULL;
  check(dermis_profile_create("skin", &skin));
  dermis_settings* settings = NULL;
  check(dermis_settings_create(&settings));
  check(dermis_settings_set(settings, "quality", "final"));
  check(dermis_settings_add_material(settings, 0, skin, 0.25));

  dermis_device* device = NULL;
  check(dermis_device_open(NULL, 0, &device));
  dermis_plan* plan = NULL;
  check(dermis_plan_create(device, settings, frame, &plan));
  check(dermis_plan_run(plan, frame, NULL, NULL, NULL));

  const int centre = 3 * (width * (height / 2) + width / 2);
  printf("before %.3f %.3f %.3f\n", light[centre], light[centre + 1], light[centre + 2]);
  printf("after  %.3f %.3f %.3f\n", scattered[centre], scattered[centre + 1], scattered[centre + 2]);
  dermis_plan_release(plan);
  dermis_device_release(device);
  dermis_settings_release(settings);
  dermis_profile_release(skin);
  dermis_frame_release(frame);
  return 0;
}
