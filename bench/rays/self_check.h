// Whether a device can be trusted: every kernel is built for it, and a small scene is drawn and compared with
// the picture of the plain C++ integrator, which shares nothing with OpenCL.
#pragma once
#include <functional>
#include <string>

#include "device/devices.h"
#include "scene/description.h"

namespace sundog {

/// Glass with a liquid in it, a mirror, a mesh, a checkered floor and shadows through filters, 64x48 pixels.
/// Its edges are where rounding cannot move a ray from one thing to another in more than a few pixels.
SceneDescription self_check_scene();

struct SelfCheck {
  enum class Status { ok, differs, failed } status = Status::failed;
  int kernels = 0;  // files that were built
  double build_seconds = 0, render_seconds = 0;
  std::uint64_t pixels = 0, differing = 0;  // of the picture; more than 0.02 (linear colour) off
  double greatest = 0;                      // difference
  std::string problem;                      // when it failed: what happened
  std::string log;                          // the compiler's, when a kernel did not build
};

/// Never throws; a driver that crashes takes the process along, so `on_stage` hears what is tried next.
SelfCheck check_device(const DeviceInfo& info, const std::function<void(const std::string&)>& on_stage);

/// The devices or drivers beside a failed one. sound: one works, so the failed one can be left out. unasked:
/// some were not checked. none: no other works.
enum class Others { sound, unasked, none };

/// A remedy for a driver's problem, chosen by the problem's text; empty where that text names one.
std::string advice(const std::string& problem, Others others);

/// A remedy for a driver that failed while its devices were listed.
std::string driver_advice(const std::string& problem, Others others);

}  // namespace sundog
