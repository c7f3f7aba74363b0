// The benches' frames are a session's: the bits of a render, in the groups that are asked for, and no time
// for a frame in which a launch failed.
#include "bench/frames/frame_runner.h"

#include "base/environment.h"
#include "base/error.h"
#include "base/faults.h"
#include "catch.h"
#include "devices.h"
#include "same_bits.h"
#include "scenes.h"
#include "test_meshes.h"

using namespace sundog;

TEST_CASE("a bench's frames have the bits and the counts of a render, in the groups that it asks for") {
  const DeviceInfo& device = test_devices().front();
  const CompiledScene scene = compile(scenes::shipped_small("spheres"));
  const RenderResult rendered = render(scene, {device});
  FrameRunner frames(device, scene);
  CHECK(frames.greatest_group() > 0);
  CHECK(frames.times().upload > 0);
  for (const WorkGroup& group :
       {WorkGroup{}, WorkGroup{WorkGroup::Kind::fixed, 2, 4}, WorkGroup{WorkGroup::Kind::fixed, 8, 1}}) {
    frames.use(group);
    CHECK(frames.run() > 0);
    CHECK(same_bits(frames.image(), rendered.image));
    CHECK(frames.counts() == rendered.counts);
    const KernelTimes& times = frames.kernel_times().at("render_whitted");
    CHECK(times.launches > 0);
    if (group.kind != WorkGroup::Kind::fixed) continue;
    CHECK(times.local_x == group.x);
    CHECK(times.local_y == group.y);
  }
}

TEST_CASE("a frame in which a launch failed has no time, and the next one has the same bits again") {
  // A CPU reads the tables of the mesh where they are: 100,000 triangles are far above a MiB.
  for (const SceneDescription& description :
       {scenes::shipped_small("spheres"), scene_of(bumpy_sphere(160))}) {
    DeviceInfo device = test_devices().front();
    const CompiledScene scene = compile(description);
    const RenderResult rendered = render(scene, {device});
    HostEnvironment environment = value_of(device.environment);
    environment.faults = std::make_shared<Faults>("launch=-36@" + std::to_string(device.platform) + ":" +
                                                  std::to_string(device.device) + "#1");
    device.environment = std::make_shared<const HostEnvironment>(environment);
    FrameRunner frames(device, scene);
    CHECK_THROWS_AS(frames.run(), DeviceError);
    CHECK(frames.run() > 0);
    CHECK(same_bits(frames.image(), rendered.image));
  }
}
