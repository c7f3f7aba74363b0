// A kernel that interprets a new formula draws until the formula's own is built; both draw the same bits.
#include <algorithm>

#include "catch.h"
#include "compile/compiled_scene.h"
#include "devices.h"
#include "new_formula.h"
#include "render/frame/tile_renderer.h"
#include "scene/integrators.h"
#include "scenes.h"
#include "wait_for_builder.h"

using namespace sundog;

TEST_CASE("a formula's own kernel takes over from the interpreter between tiles, and no bit changes") {
  const DeviceInfo& info = test_devices().front();
  Device device(info);
  KernelStore store(info);
  LaunchWatch watch;
  RenderTimes times;
  RenderOptions options;
  options.kernels = KernelChoice::own_when_built;
  const CompiledScene first = compile(scenes::shipped_small("mandelbulb"));
  CompiledScene other = first;
  const CompiledScene formula = compile(new_formula("length(p) - 1 + 0.1 * sin(9 * p.y)"));
  other.field_source = formula.field_source;
  other.sdf_parameters = formula.sdf_parameters;
  other.sdf_fields = formula.sdf_fields;
  other.features.field_flags = formula.features.field_flags;
  TileRenderer renderer(device, first, options, times, watch, &store);
  const Integrator& integrator = *find_integrator(first.integrator);
  store.builder().want({integrator.entry, integrator.kernel, interpreting_config(first, info)});
  wait_for(store.builder());

  renderer.change_scene(other, options, times);
  CHECK(renderer.update().built == 0);
  CHECK(interprets(renderer.config()));
  TileRequest request;
  request.tile = {0, 0, 24, 18};
  request.sample_count = other.info.samples;
  const StopFlags flags;
  const TileResult early = renderer.render(request, flags);
  wait_for(store.builder());
  const TileResult late = renderer.render(request, flags);
  CHECK_FALSE(interprets(renderer.config()));
  CHECK(early.sums == late.sums);
  CHECK(std::ranges::any_of(late.sums, [](const float4& sum) { return sum.x > 0; }));
}
