// A device's thread in a session: it owns the device worker, with its device and store of kernels. Internal
// to the session.
#pragma once
#include <memory>

#include "base/driver_threads.h"
#include "render/frame/device_worker.h"
#include "render/session/session_frame.h"

namespace sundog {

/// Its members are guarded by the loop's mutex.
struct DeviceThread {
  std::shared_ptr<DeviceWorker> worker;
  std::shared_ptr<SceneWorker> of_scenes;  // the same; null: its scene is the only one
  DriverThread driver;
  std::shared_ptr<SessionFrame> seen;  // the last frame that it took part in
  bool opening = false;                // it may be in a driver's compiler
  bool closed = false;                 // the worker, behind a frame
  bool leave = false, gone = false;
  bool abandoned = false;  // a frame did not wait for it, and nobody does
  // Of the last frame that was rendered to its end; 0: it made nothing.
  double pixels_a_second = 0, measured_pixels = 0;
};

}  // namespace sundog
