// Runs a test with each way of tracing rays: sixteen together, one at a time, and with the compact tracer.
#pragma once
#include "bench/rays/ray_tracer.h"
#include "catch.h"
#include "devices.h"

/// Calls test(compiled scene, tracer, coherent) for each way of tracing on each device.
void for_each_tracer(const sundog::SceneDescription& description, const auto& test) {
  using namespace sundog;
  struct Way {
    const char* name;
    Tracer tracer;
    bool coherent;
  };
  SceneDescription scene = description;
  for (const DeviceInfo& info : test_devices())
    for (const Way& way : {Way{"together", Tracer::wide, true}, Way{"alone", Tracer::wide, false},
                           Way{"compact", Tracer::compact, false}}) {
      if (info.native_vector_width <= 1 && way.tracer == Tracer::wide) continue;
      DYNAMIC_SECTION(info.label() << ", " << way.name) {
        Device device(info);
        scene.render.tracer = way.tracer;
        const CompiledScene flat = compile(scene);
        RayTracer tracer(device, flat);
        test(flat, tracer, way.coherent);
      }
    }
}
