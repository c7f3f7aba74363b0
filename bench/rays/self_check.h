// Tests whether a device can be trusted: builds every kernel for it, renders a small scene and compares the
// picture with the plain C++ integrator's, which does not use OpenCL.
#pragma once
#include <functional>
#include <string>

#include "device/devices.h"
#include "scene/description.h"

namespace sundog {

/// Glass with a liquid in it, a mirror, a mesh, a checkered floor and shadows through filters, 64x48 pixels.
/// Its edges are placed so that rounding moves rays from one object to another in a few pixels at most.
SceneDescription self_check_scene();

struct SelfCheck {
  enum class Status { ok, differs, failed } status = Status::failed;
  int kernels = 0;  // kernel files built
  double build_seconds = 0, render_seconds = 0;
  std::uint64_t pixels = 0, differing = 0;  // of the picture; those more than 0.02 (linear colour) off
  double greatest = 0;                      // greatest difference
  std::string problem;                      // the error, if it failed
  std::string log;                          // the compiler's, if a kernel did not build
};

/// Never throws. A driver that crashes ends the process, so `on_stage` is called before each stage.
SelfCheck check_device(const DeviceInfo& info, const std::function<void(const std::string&)>& on_stage);

/// The other devices or drivers besides a failed one. sound: one works, so the failed one can be left out.
/// unasked: some were not checked. none: no other works.
enum class Others { sound, unasked, none };

/// A remedy for a driver's problem, chosen by the problem's text; empty if the text already names one.
std::string advice(const std::string& problem, Others others);

/// A remedy for a driver that failed while its devices were listed.
std::string driver_advice(const std::string& problem, Others others);

}  // namespace sundog
