/** @file
 * The C interface: opaque handles, error codes, no exceptions. The C++ headers beside it say more about each
 * thing; this is the part of them that other languages need.
 *
 * Functions return SUNDOG_OK or the kind of error, and put its line, file and place into `error`, their last
 * argument, which may be NULL. What they give back comes through the arguments before it, which stay as they
 * were when they fail. A handle is used by one thread at a time unless it says otherwise, and freed by its
 * own function, which takes NULL too. Texts are UTF-8. */
#ifndef SUNDOG_SUNDOG_H
#define SUNDOG_SUNDOG_H

#include <stddef.h>
#include <stdint.h>

/** Visible outside of the library. */
#define SUNDOG_C_API __attribute__((visibility("default")))

/** No function lets an exception out: C++ compilers hold it. */
#ifdef __cplusplus
#define SUNDOG_NOEXCEPT noexcept
extern "C" {
#else
#define SUNDOG_NOEXCEPT
#endif

/** How a function went. */
typedef enum sundog_status {
  SUNDOG_OK = 0,
  SUNDOG_USAGE = 1,    /**< an argument is wrong */
  SUNDOG_SCENE = 2,    /**< the scene or a file that it names is bad */
  SUNDOG_DEVICE = 3,   /**< no such device, or every device failed */
  SUNDOG_BUILD = 4,    /**< a kernel does not build */
  SUNDOG_IO = 5,       /**< a file cannot be read or written */
  SUNDOG_INTERNAL = 6, /**< all others, such as a want of memory */
  SUNDOG_STOPPED = 7   /**< a callback ended the render; the film so far is returned */
} sundog_status;

/** A scene, by its document. */
typedef struct sundog_scene sundog_scene;
/** A list of devices. */
typedef struct sundog_devices sundog_devices;
/** A finished or stopped render. */
typedef struct sundog_film sundog_film;
/** Devices that stay open. */
typedef struct sundog_session sundog_session;
/** What the last function that failed with it had to say. */
typedef struct sundog_error sundog_error;

/** "0.1.0". Valid for ever. */
SUNDOG_C_API const char* sundog_version(void) SUNDOG_NOEXCEPT;

/* --- errors ------------------------------------------------------------------------------------------- */

/** A handle for any number of calls, one after the other; NULL for want of memory. */
SUNDOG_C_API sundog_error* sundog_error_new(void) SUNDOG_NOEXCEPT;
/** One line; empty before the first failure, and for NULL. Valid until the next call with `error` fails. */
SUNDOG_C_API const char* sundog_error_line(const sundog_error* error) SUNDOG_NOEXCEPT;
/** The file at fault; empty where there is none. As above. */
SUNDOG_C_API const char* sundog_error_file(const sundog_error* error) SUNDOG_NOEXCEPT;
/** The place in it: a JSON pointer, "line 12". As above. */
SUNDOG_C_API const char* sundog_error_place(const sundog_error* error) SUNDOG_NOEXCEPT;
/** Any handle, or NULL. */
SUNDOG_C_API void sundog_error_free(sundog_error* error) SUNDOG_NOEXCEPT;

/* --- scenes ------------------------------------------------------------------------------------------- */

/** A scene or model file. */
SUNDOG_C_API sundog_status sundog_scene_load(const char* file, sundog_scene** scene,
                                             sundog_error* error) SUNDOG_NOEXCEPT;
/** The text of a scene; names of files in it count from `folder` (NULL: the current one). */
SUNDOG_C_API sundog_status sundog_scene_from_json(const char* text, const char* folder, sundog_scene** scene,
                                                  sundog_error* error) SUNDOG_NOEXCEPT;
/** Sets the value at a JSON pointer to that of a JSON text. */
SUNDOG_C_API sundog_status sundog_scene_set(sundog_scene* scene, const char* pointer, const char* json,
                                            sundog_error* error) SUNDOG_NOEXCEPT;
/** Adds or replaces a mesh that objects {"type": "mesh", "mesh": NAME} place. `positions` are x, y, z each;
 * `triangles` three indices each, counterclockwise seen from outside; `normals` (x, y, z) and `uvs` (u, v)
 * NULL or one a vertex. The numbers are copied. */
SUNDOG_C_API sundog_status sundog_scene_add_mesh(sundog_scene* scene, const char* name,
                                                 const float* positions, size_t vertex_count,
                                                 const uint32_t* triangles, size_t triangle_count,
                                                 const float* normals, const float* uvs,
                                                 sundog_error* error) SUNDOG_NOEXCEPT;
/** The same without a copy: the scene, its renders and sessions read the numbers where they are. When the
 * last of them needs them no longer, `release` is called with `user`, once and by any thread; an exception
 * that it throws is dropped. The numbers stay as they are until then. When this fails, `release` is not
 * called. NULL: the numbers stay until the process ends. */
SUNDOG_C_API sundog_status sundog_scene_hold_mesh(sundog_scene* scene, const char* name,
                                                  const float* positions, size_t vertex_count,
                                                  const uint32_t* triangles, size_t triangle_count,
                                                  const float* normals, const float* uvs,
                                                  void (*release)(void* user), void* user,
                                                  sundog_error* error) SUNDOG_NOEXCEPT;
/** Reads the whole scene: SUNDOG_SCENE with the place at fault. */
SUNDOG_C_API sundog_status sundog_scene_check(const sundog_scene* scene, sundog_error* error) SUNDOG_NOEXCEPT;
/** Any handle, or NULL. */
SUNDOG_C_API void sundog_scene_free(sundog_scene* scene) SUNDOG_NOEXCEPT;

/* --- devices ------------------------------------------------------------------------------------------ */

/** Every device, the broken ones too. */
SUNDOG_C_API sundog_status sundog_devices_list(sundog_devices** devices, sundog_error* error) SUNDOG_NOEXCEPT;
/** Those that a list of specs means ("cpu", "0:1", ...), separated by commas; NULL: the one estimated
 * fastest.
 */
SUNDOG_C_API sundog_status sundog_devices_choose(const char* specs, sundog_devices** devices,
                                                 sundog_error* error) SUNDOG_NOEXCEPT;
/** 0 for NULL. */
SUNDOG_C_API size_t sundog_devices_count(const sundog_devices* devices) SUNDOG_NOEXCEPT;
/** Valid as long as `devices`; NULL for an index out of range. */
SUNDOG_C_API const char* sundog_devices_label(const sundog_devices* devices, size_t index) SUNDOG_NOEXCEPT;
/** Why it cannot be used; empty where it can. */
SUNDOG_C_API const char* sundog_devices_problem(const sundog_devices* devices, size_t index) SUNDOG_NOEXCEPT;
/** Any handle, or NULL. */
SUNDOG_C_API void sundog_devices_free(sundog_devices* devices) SUNDOG_NOEXCEPT;

/* --- renders ------------------------------------------------------------------------------------------ */

/** Called some times a second by one thread at a time, the caller's or another. 0: continue; else the render
 * ends. */
typedef int (*sundog_progress)(uint64_t pixels_done, uint64_t pixels_total, double seconds, void* user);

/** How to render; all zero: the defaults. */
typedef struct sundog_options {
  const sundog_devices* devices; /**< NULL: the one estimated fastest */
  const char* aovs;              /**< "depth,normal": separated by commas; NULL: none */
  unsigned work_group_x;         /**< 0: the default */
  unsigned work_group_y;         /**< 0: 1 */
  int tile;                      /**< edge in pixels; 0: chosen by measured speed */
  double time_limit;             /**< seconds; 0: none */
  sundog_progress progress;      /**< NULL: none */
  void* user;                    /**< for `progress` */
} sundog_options;

/** Renders and waits. `options` NULL: all defaults. Several threads may render the same scene at once. With
 * SUNDOG_STOPPED and after the time limit there is a film too: sundog_film_complete() says 0. */
SUNDOG_C_API sundog_status sundog_render(const sundog_scene* scene, const sundog_options* options,
                                         sundog_film** film, sundog_error* error) SUNDOG_NOEXCEPT;
/** 1: every pixel has all its samples; 0: stopped, out of time, or NULL. */
SUNDOG_C_API int sundog_film_complete(const sundog_film* film) SUNDOG_NOEXCEPT;
/** The picture (`aov` NULL: linear RGBA) or an AOV: width * height * channels floats, row 0 at the top. Valid
 * as long as the film; any of the arguments behind `pixels` may be NULL. */
SUNDOG_C_API sundog_status sundog_film_pixels(const sundog_film* film, const char* aov, const float** pixels,
                                              int* width, int* height, int* channels,
                                              sundog_error* error) SUNDOG_NOEXCEPT;
/** By the file's extension: .png .jpg .exr .hdr .pfm, as `sundog render -o` does. */
SUNDOG_C_API sundog_status sundog_film_save(const sundog_film* film, const char* file,
                                            sundog_error* error) SUNDOG_NOEXCEPT;
/** Any handle, or NULL. */
SUNDOG_C_API void sundog_film_free(sundog_film* film) SUNDOG_NOEXCEPT;

/* --- sessions: devices that stay open and draw one scene after the other ------------------------------- */

/** What a session is at. */
typedef enum sundog_state {
  SUNDOG_IDLE = 0,
  SUNDOG_COMPILING = 1,
  SUNDOG_PREPARING = 2,
  SUNDOG_DRAWING = 3,
  SUNDOG_SETTLED = 4,
  SUNDOG_CANCELLED = 5,
  SUNDOG_FAILED = 6
} sundog_state;

/** Functions of a session are called by any thread; it is freed when no other call is in it. */
SUNDOG_C_API sundog_status sundog_session_open(const sundog_devices* devices, sundog_session** session,
                                               sundog_error* error) SUNDOG_NOEXCEPT;
/** Draws the scene as it is now; the newest one wins. Returns once it is read. */
SUNDOG_C_API sundog_status sundog_session_start(sundog_session* session, const sundog_scene* scene,
                                                sundog_error* error) SUNDOG_NOEXCEPT;
/** Stops drawing; the picture so far stays. */
SUNDOG_C_API sundog_status sundog_session_cancel(sundog_session* session,
                                                 sundog_error* error) SUNDOG_NOEXCEPT;
/** Waits at most so many seconds (below 0: for ever) for the picture to settle; `state` as it then is. */
SUNDOG_C_API sundog_status sundog_session_wait(const sundog_session* session, double seconds,
                                               sundog_state* state, sundog_error* error) SUNDOG_NOEXCEPT;
/** Copies the picture so far, linear RGBA, into `pixels`, which has room for `capacity` floats. Its size is
 * given in any case: 0x0 before the first pixel. SUNDOG_USAGE where there is too little room. */
SUNDOG_C_API sundog_status sundog_session_picture(const sundog_session* session, float* pixels,
                                                  size_t capacity, int* width, int* height,
                                                  sundog_error* error) SUNDOG_NOEXCEPT;
/** Any handle, or NULL. */
SUNDOG_C_API void sundog_session_free(sundog_session* session) SUNDOG_NOEXCEPT;

#ifdef __cplusplus
}
#endif
#endif
