// Each device is tuned by a process of its own, which is ended when its budget is over: no driver can be
// asked to stop compiling.
#pragma once
#include <string>

#include "bench/commands/bench_options.h"

namespace sundog {

struct TuneOptions {
  BenchOptions bench;  // scenes, devices, overrides
  double budget = 60;  // seconds for a device
  bool show = false, forget = false;
  std::string export_to, import_from;
  std::string worker;  // "P:D" or "P:D/N": this is the process that tunes one device
};

/// Tunes the devices in turn and prints what was found, until one fails; the exit status. Throws DeviceError
/// where the budget was too short for a result of any.
int tune_devices(const TuneOptions& options);

/// The other side: tunes the device `worker`, keeps what it finds and prints it to stdout, with lines about
/// its steps between.
int tune_one_device(const TuneOptions& options);

}  // namespace sundog
