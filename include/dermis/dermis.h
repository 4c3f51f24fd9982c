/* dermis for C, and for languages that call C: what dermis.hpp offers, behind handles.
 *
 * Functions return 0, or a dermis_code that says what went wrong; dermis_error_* then tell it in words, per thread.
 * Handles are made by dermis_*_create or _open and given back by the function of the same kind that ends in _release,
 * which takes NULL, too. Plans, devices and profiles may be used by several threads at once, all other handles by one
 * at a time. Strings are UTF-8. Settings and images go by name, so that what is added later needs no new functions. */
#ifndef DERMIS_DERMIS_H
#define DERMIS_DERMIS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct _cl_context;
struct _cl_device_id;
struct _cl_mem;
struct _cl_command_queue;
struct _cl_event;

typedef struct dermis_device dermis_device;
typedef struct dermis_profile dermis_profile;
typedef struct dermis_settings dermis_settings;
typedef struct dermis_frame dermis_frame;
typedef struct dermis_plan dermis_plan;
typedef struct dermis_stats dermis_stats;

/* The exit codes of the dermis program. */
typedef enum dermis_code {
  DERMIS_DONE = 0,
  DERMIS_STOPPED = 1,           /* the progress function returned 0: nothing was written */
  DERMIS_USAGE = 2,             /* an argument is outside what is allowed */
  DERMIS_INPUT_MISSING = 3,     /* a file that should be read is not there */
  DERMIS_INPUT_UNSUPPORTED = 4, /* a file or an image is damaged, or of a kind dermis does not take */
  DERMIS_ROLE_MISSING = 5,      /* the frame lacks an image or the camera that the filter needs */
  DERMIS_OUTPUT = 6,            /* a result cannot be written */
  DERMIS_DEVICE = 7,            /* no OpenCL device, or it refused the work, or no memory */
  DERMIS_INTERNAL = 8           /* a defect of dermis */
} dermis_code;

/* "0.1.0" */
const char* dermis_version(void);

/* Of the last function of this thread that did not return 0: all of it in one line, and its parts, which are empty if
 * there are none. They hold until the next call of this thread. */
const char* dermis_error_message(void);
const char* dermis_error_argument(void);
const char* dermis_error_seen(void);
const char* dermis_error_wanted(void);

/* Devices. `name`: a number, a type ("CPU", "GPU") or a part of the name of a device or its platform; NULL or "": that
 * of the environment variable DERMIS_DEVICE, or the first GPU, or the first one. `threads`: of a CPU; 0: all. */
dermis_code dermis_device_count(size_t* count);
dermis_code dermis_device_open(const char* name, int threads, dermis_device** device);
/* The caller's own, which are retained. */
dermis_code dermis_device_adopt(struct _cl_context* context, struct _cl_device_id* id, dermis_device** device);
const char* dermis_device_name(const dermis_device* device);
const char* dermis_device_type(const dermis_device* device); /* "CPU", "GPU", "accelerator" or "other" */
struct _cl_context* dermis_device_context(const dermis_device* device);
struct _cl_device_id* dermis_device_id(const dermis_device* device);
void dermis_device_release(dermis_device* device);

/* A profile, as the program spells it: "skin", "burley:1/0.6/0.4", "walk:12/7/2,albedo=0.8/0.55/0.2", ... */
dermis_code dermis_profile_create(const char* text, dermis_profile** profile);
/* R(r), 1/mm^2, of channel 0, 1 or 2; the share of the light within r; and the distance within which a share leaves. */
dermis_code dermis_profile_radial(const dermis_profile* profile, int channel, double r_mm, double* value_per_mm2);
dermis_code dermis_profile_cdf(const dermis_profile* profile, int channel, double r_mm, double* share);
dermis_code dermis_profile_radius(const dermis_profile* profile, int channel, double share, double* r_mm);
void dermis_profile_release(dermis_profile* profile);

/* What a plan computes: materials, and settings by name, of which dermis_setting_name lists all and
 * dermis_setting_help tells what each is; NULL beyond the last. */
dermis_code dermis_settings_create(dermis_settings** settings);
dermis_code dermis_settings_set(dermis_settings* settings, const char* name, const char* value);
/* `pixel_mm`: the size of a pixel on its surface at its median depth, which decides how many taps a quality takes; 0:
 * not known. Without an image of ids there is one material, whose id does not count. */
dermis_code dermis_settings_add_material(dermis_settings* settings, int id, const dermis_profile* profile,
                                         double pixel_mm);
const char* dermis_setting_name(size_t number);
const char* dermis_setting_help(size_t number);
void dermis_settings_release(dermis_settings* settings);

typedef enum dermis_format {
  DERMIS_F16 = 0,
  DERMIS_F32 = 1,
  DERMIS_U8 = 2,
  DERMIS_U16 = 3,
  DERMIS_U32 = 4
} dermis_format;

/* Where the values of an image lie. Strides in bytes; 0: packed, RGB side by side. */
typedef struct dermis_layout {
  int format; /* a dermis_format; another number is refused */
  ptrdiff_t channel_stride;
  ptrdiff_t pixel_stride;
  ptrdiff_t row_stride;
  size_t offset; /* bytes to pixel (0, 0) */
} dermis_layout;

/* A G-buffer. It owns no pixels: they stay where they are until its last use. Images to read: light, albedo, depth,
 * material, mask, matte, normal, beauty; to write: scattered, result. A NULL pointer takes an image away; a NULL layout
 * is packed f32. */
dermis_code dermis_frame_create(int width, int height, dermis_frame** frame);
dermis_code dermis_frame_set_image(dermis_frame* frame, const char* name, const void* pixels,
                                   const dermis_layout* layout);
dermis_code dermis_frame_set_output(dermis_frame* frame, const char* name, void* pixels, const dermis_layout* layout);
/* The same in a buffer of the device; for images to read and to write. */
dermis_code dermis_frame_set_buffer(dermis_frame* frame, const char* name, struct _cl_mem* buffer,
                                    const dermis_layout* layout);
/* Pixel (i, j) has its centre at (i + 0.5, j + 0.5), y down; depth z is seen at center + focal * (X, Y) / z. */
dermis_code dermis_frame_set_perspective(dermis_frame* frame, double focal_x_px, double focal_y_px, double center_x_px,
                                         double center_y_px);
dermis_code dermis_frame_set_orthographic(dermis_frame* frame, double px_per_unit_x, double px_per_unit_y);
dermis_code dermis_frame_set_mm_per_unit(dermis_frame* frame, double mm_per_unit);
/* A view of what the camera of the frame does not see: a handle of its own, whose images are light, albedo, position,
 * normal and material. `to_camera`: row by row the 3 x 4 matrix from its positions to the axes of the frame's camera
 * (right, down, away). The frame keeps what it needs of it but the pixels. */
dermis_code dermis_frame_add_view(dermis_frame* frame, const dermis_frame* view, const double to_camera[12]);
void dermis_frame_release(dermis_frame* frame);

/* Called with the share of the work that is done, 0..1; 0 stops it. */
typedef int (*dermis_progress)(double share, void* user);

/* Builds the kernels and the taps for frames that have the images of `frame`, of any size. */
dermis_code dermis_plan_create(const dermis_device* device, const dermis_settings* settings, const dermis_frame* frame,
                               dermis_plan** plan);
/* Filters a frame and waits for it. `progress` and `stats` may be NULL. */
dermis_code dermis_plan_run(const dermis_plan* plan, const dermis_frame* frame, dermis_progress progress, void* user,
                            dermis_stats** stats);
/* Puts the work on the caller's queue, after `wait_count` events; all images are buffers. Never blocks. `done`, unless
 * it is NULL, receives an event that the caller releases. */
dermis_code dermis_plan_enqueue(const dermis_plan* plan, const dermis_frame* frame, struct _cl_command_queue* queue,
                                size_t wait_count, struct _cl_event* const* wait, struct _cl_event** done);
dermis_code dermis_plan_scratch_bytes(const dermis_plan* plan, int width, int height, size_t* bytes);
void dermis_plan_release(dermis_plan* plan);

/* Numbers of a run: dermis_stats_name lists them; NULL beyond the last. Times end in _ms, the others count pixels. */
const char* dermis_stats_name(size_t number);
dermis_code dermis_stats_value(const dermis_stats* stats, const char* name, double* value);
void dermis_stats_release(dermis_stats* stats);

#ifdef __cplusplus
}
#endif

#endif
