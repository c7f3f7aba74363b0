/** @file
 * The C interface, for use from other languages: opaque handles, error codes, no exceptions. The C++ headers
 * in this folder document each function in more detail.
 *
 * Functions return SUNDOG_OK or the kind of error, and store its message, file and place in `error`, their
 * last argument, which may be NULL. Results are stored through the arguments before it, which are unchanged
 * on failure. Use a handle from one thread at a time unless stated otherwise, and free it with its own
 * function, which accepts NULL. Texts are UTF-8. */
#ifndef SUNDOG_SUNDOG_H
#define SUNDOG_SUNDOG_H

#include <stddef.h>
#include <stdint.h>

/** Exports a symbol. */
#define SUNDOG_C_API __attribute__((visibility("default")))

/** Marks functions that do not throw. */
#ifdef __cplusplus
#define SUNDOG_NOEXCEPT noexcept
extern "C" {
#else
#define SUNDOG_NOEXCEPT
#endif

/** The result of a function. */
typedef enum sundog_status {
  SUNDOG_OK = 0,
  SUNDOG_USAGE = 1,    /**< an argument is invalid */
  SUNDOG_SCENE = 2,    /**< the scene or a file that it names is invalid */
  SUNDOG_DEVICE = 3,   /**< no such device, or every device failed */
  SUNDOG_BUILD = 4,    /**< a kernel does not build */
  SUNDOG_IO = 5,       /**< a file cannot be read or written */
  SUNDOG_INTERNAL = 6, /**< anything else, such as lack of memory */
  SUNDOG_STOPPED = 7   /**< a callback ended the render; the film so far is returned */
} sundog_status;

/** A scene: a JSON document and meshes. */
typedef struct sundog_scene sundog_scene;
/** A list of devices. */
typedef struct sundog_devices sundog_devices;
/** A finished or stopped render. */
typedef struct sundog_film sundog_film;
/** Devices that stay open and draw scenes. */
typedef struct sundog_session sundog_session;
/** Details of the last failure. */
typedef struct sundog_error sundog_error;

/** The library's version, "0.2.0". Valid forever. */
SUNDOG_C_API const char* sundog_version(void) SUNDOG_NOEXCEPT;

/* --- errors ------------------------------------------------------------------------------------------- */

/** Returns an error handle, which consecutive calls may share; NULL if out of memory. */
SUNDOG_C_API sundog_error* sundog_error_new(void) SUNDOG_NOEXCEPT;
/** The message, one line; empty before the first failure and for NULL. Valid until the next failure. */
SUNDOG_C_API const char* sundog_error_line(const sundog_error* error) SUNDOG_NOEXCEPT;
/** The file at fault; empty if none. Valid until the next failure. */
SUNDOG_C_API const char* sundog_error_file(const sundog_error* error) SUNDOG_NOEXCEPT;
/** The place in that file: a JSON pointer, or "line 12". Valid until the next failure. */
SUNDOG_C_API const char* sundog_error_place(const sundog_error* error) SUNDOG_NOEXCEPT;
/** Frees a handle; accepts NULL. */
SUNDOG_C_API void sundog_error_free(sundog_error* error) SUNDOG_NOEXCEPT;

/* --- scenes ------------------------------------------------------------------------------------------- */

/** Reads a scene or model file. */
SUNDOG_C_API sundog_status sundog_scene_load(const char* file, sundog_scene** scene,
                                             sundog_error* error) SUNDOG_NOEXCEPT;
/** Reads the scene at a frame of its animation; frames may have fractions. */
SUNDOG_C_API sundog_status sundog_scene_load_frame(const char* file, double frame, sundog_scene** scene,
                                                   sundog_error* error) SUNDOG_NOEXCEPT;
/** Reads a scene from text; file names in it are relative to `folder` (NULL: the current one). */
SUNDOG_C_API sundog_status sundog_scene_from_json(const char* text, const char* folder, sundog_scene** scene,
                                                  sundog_error* error) SUNDOG_NOEXCEPT;
/** Sets the value at a JSON pointer, given as JSON text. */
SUNDOG_C_API sundog_status sundog_scene_set(sundog_scene* scene, const char* pointer, const char* json,
                                            sundog_error* error) SUNDOG_NOEXCEPT;
/** Adds or replaces a mesh that objects {"type": "mesh", "mesh": NAME} place. `positions` are x, y, z each;
 * `triangles` three indices each, counterclockwise seen from outside; `normals` (x, y, z) and `uvs` (u, v)
 * NULL or one per vertex. The numbers are copied. */
SUNDOG_C_API sundog_status sundog_scene_add_mesh(sundog_scene* scene, const char* name,
                                                 const float* positions, size_t vertex_count,
                                                 const uint32_t* triangles, size_t triangle_count,
                                                 const float* normals, const float* uvs,
                                                 sundog_error* error) SUNDOG_NOEXCEPT;
/** sundog_scene_add_mesh() without a copy: the scene, its renders and sessions read the numbers in place. The
 * last of them calls `release` with `user`, once, from any thread; exceptions from it are dropped. The
 * numbers must not change until then. If this function fails, `release` is not called. NULL: the numbers must
 * last until the process ends. */
SUNDOG_C_API sundog_status sundog_scene_hold_mesh(sundog_scene* scene, const char* name,
                                                  const float* positions, size_t vertex_count,
                                                  const uint32_t* triangles, size_t triangle_count,
                                                  const float* normals, const float* uvs,
                                                  void (*release)(void* user), void* user,
                                                  sundog_error* error) SUNDOG_NOEXCEPT;
/** Validates the whole scene: SUNDOG_SCENE with the place at fault. */
SUNDOG_C_API sundog_status sundog_scene_check(const sundog_scene* scene, sundog_error* error) SUNDOG_NOEXCEPT;
/** Frees a handle; accepts NULL. */
SUNDOG_C_API void sundog_scene_free(sundog_scene* scene) SUNDOG_NOEXCEPT;

/* --- devices ------------------------------------------------------------------------------------------ */

/** Lists every device, including unusable ones. */
SUNDOG_C_API sundog_status sundog_devices_list(sundog_devices** devices, sundog_error* error) SUNDOG_NOEXCEPT;
/** Selects devices by comma-separated specs ("cpu", "0:1", ...); NULL: the device estimated fastest. */
SUNDOG_C_API sundog_status sundog_devices_choose(const char* specs, sundog_devices** devices,
                                                 sundog_error* error) SUNDOG_NOEXCEPT;
/** Number of devices; 0 for NULL. */
SUNDOG_C_API size_t sundog_devices_count(const sundog_devices* devices) SUNDOG_NOEXCEPT;
/** A device's label. Valid until `devices` is freed; NULL for an index out of range. */
SUNDOG_C_API const char* sundog_devices_label(const sundog_devices* devices, size_t index) SUNDOG_NOEXCEPT;
/** Why the device is unusable, or empty. Valid until `devices` is freed; NULL for an index out of range. */
SUNDOG_C_API const char* sundog_devices_problem(const sundog_devices* devices, size_t index) SUNDOG_NOEXCEPT;
/** Frees a handle; accepts NULL. */
SUNDOG_C_API void sundog_devices_free(sundog_devices* devices) SUNDOG_NOEXCEPT;

/** Waits, for at most a minute, for threads that a stopped render or session has left in a driver. */
SUNDOG_C_API void sundog_wait_for_threads(void) SUNDOG_NOEXCEPT;

/* --- renders ------------------------------------------------------------------------------------------ */

/** Called a few times a second by one thread at a time, not always the caller's. Return 0 to continue; other
 * values end the render. */
typedef int (*sundog_progress)(uint64_t pixels_done, uint64_t pixels_total, double seconds, void* user);

/** Options of a render; all zero: the defaults. */
typedef struct sundog_options {
  const sundog_devices* devices; /**< NULL: the device estimated fastest */
  const char* aovs;              /**< separated by commas: "depth,normal"; NULL: none */
  unsigned work_group_x;         /**< 0: the default */
  unsigned work_group_y;         /**< 0: 1 */
  int tile;                      /**< edge in pixels; 0: chosen by measured speed */
  double time_limit;             /**< seconds; 0: none */
  sundog_progress progress;      /**< NULL: none */
  void* user;                    /**< passed to `progress` */
} sundog_options;

/** Renders and waits. `options` NULL: all defaults. Several threads may render the same scene at once. After
 * SUNDOG_STOPPED or the time limit, `film` holds the picture so far and sundog_film_complete() is 0. */
SUNDOG_C_API sundog_status sundog_render(const sundog_scene* scene, const sundog_options* options,
                                         sundog_film** film, sundog_error* error) SUNDOG_NOEXCEPT;
/** 1: every pixel has all its samples; 0: stopped, out of time, or NULL. */
SUNDOG_C_API int sundog_film_complete(const sundog_film* film) SUNDOG_NOEXCEPT;
/** A warning about the render, one line; `index` from 0. Valid until the film is freed; NULL: no more. */
SUNDOG_C_API const char* sundog_film_warning(const sundog_film* film, size_t index) SUNDOG_NOEXCEPT;
/** The picture (`aov` NULL: linear RGBA) or an AOV: width * height * channels floats, row 0 at the top. Valid
 * until the film is freed; any argument after `pixels` may be NULL. */
SUNDOG_C_API sundog_status sundog_film_pixels(const sundog_film* film, const char* aov, const float** pixels,
                                              int* width, int* height, int* channels,
                                              sundog_error* error) SUNDOG_NOEXCEPT;
/** Writes the picture as `sundog render -o` does; the extension selects .png .jpg .exr .hdr or .pfm. */
SUNDOG_C_API sundog_status sundog_film_save(const sundog_film* film, const char* file,
                                            sundog_error* error) SUNDOG_NOEXCEPT;
/** Frees a handle; accepts NULL. */
SUNDOG_C_API void sundog_film_free(sundog_film* film) SUNDOG_NOEXCEPT;

/* --- sessions: devices that stay open and draw one scene after another --------------------------------- */

/** The activity of a session. */
typedef enum sundog_state {
  SUNDOG_IDLE = 0,
  SUNDOG_COMPILING = 1,
  SUNDOG_PREPARING = 2,
  SUNDOG_DRAWING = 3,
  SUNDOG_SETTLED = 4,
  SUNDOG_CANCELLED = 5,
  SUNDOG_FAILED = 6
} sundog_state;

/** Opens devices. A session is thread-safe, except that it must not be freed during a call. */
SUNDOG_C_API sundog_status sundog_session_open(const sundog_devices* devices, sundog_session** session,
                                               sundog_error* error) SUNDOG_NOEXCEPT;
/** Draws the scene as it is now, replacing the previous scene. Returns once the scene is read. */
SUNDOG_C_API sundog_status sundog_session_start(sundog_session* session, const sundog_scene* scene,
                                                sundog_error* error) SUNDOG_NOEXCEPT;
/** Stops drawing; the picture so far remains. */
SUNDOG_C_API sundog_status sundog_session_cancel(sundog_session* session,
                                                 sundog_error* error) SUNDOG_NOEXCEPT;
/** Waits for the picture to settle, for at most `seconds` (below 0: forever), then stores the state. */
SUNDOG_C_API sundog_status sundog_session_wait(const sundog_session* session, double seconds,
                                               sundog_state* state, sundog_error* error) SUNDOG_NOEXCEPT;
/** Copies the picture so far, linear RGBA, into `pixels`, which has room for `capacity` floats. Always stores
 * its size: 0x0 before the first pixel. SUNDOG_USAGE if `capacity` is too small. */
SUNDOG_C_API sundog_status sundog_session_picture(const sundog_session* session, float* pixels,
                                                  size_t capacity, int* width, int* height,
                                                  sundog_error* error) SUNDOG_NOEXCEPT;
/** Frees a handle; accepts NULL. */
SUNDOG_C_API void sundog_session_free(sundog_session* session) SUNDOG_NOEXCEPT;

#ifdef __cplusplus
}
#endif
#endif
