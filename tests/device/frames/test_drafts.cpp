// Drafts: kernels of all features draw a scene until its own are built. They round otherwise, and that is
// all.
#include <algorithm>
#include <cmath>

#include "base/environment.h"
#include "catch.h"
#include "compile/compiled_scene.h"
#include "device/choice.h"
#include "devices.h"
#include "new_formula.h"
#include "render/frame/tile_renderer.h"
#include "render/session/render_session.h"
#include "same_bits.h"
#include "scene/integrators.h"
#include "scenes.h"
#include "temporary_folder.h"
#include "wait_for_builder.h"

using namespace sundog;

namespace {

/// The device, with a cache of its own.
DeviceInfo with_cache(const DeviceInfo& info, const std::filesystem::path& folder) {
  DeviceInfo other = info;
  HostEnvironment environment = value_of(info.environment);
  environment.cache = folder;
  other.environment = std::make_shared<const HostEnvironment>(environment);
  return other;
}

Tile whole(const CompiledScene& scene) {
  return {0, 0, static_cast<int>(scene.info.width), static_cast<int>(scene.info.height)};
}

/// The share of the pixels whose colour is another by more than rounding makes it.
double share_of_others(const std::vector<float4>& a, const std::vector<float4>& b) {
  std::size_t others = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto differs = [](float x, float y) { return !(std::abs(x - y) <= 1e-4f * (1 + std::abs(y))); };
    others += differs(a[i].x, b[i].x) || differs(a[i].y, b[i].y) || differs(a[i].z, b[i].z);
  }
  return static_cast<double>(others) / static_cast<double>(a.size());
}

}  // namespace

TEST_CASE("drafts draw the shipped scenes but for rounding, and give way to the scenes' own kernels") {
  const TemporaryFolder folder;
  const DeviceInfo& own_info = test_devices().front();
  if (!calls_functions(own_info)) return;  // there are no drafts
  const DeviceInfo info = with_cache(own_info, folder / "cache");
  const CompiledScene first = compile(scenes::shipped_small("spheres"));
  Device device(info), own_device(own_info);
  KernelStore store(info);
  LaunchWatch watch;
  RenderTimes times;
  RenderOptions options, own_options;
  options.kernels = KernelChoice::own_when_built;
  TileRenderer renderer(device, first, options, times, watch, &store);
  TileRenderer own(own_device, first, own_options, times, watch, nullptr);
  const Integrator& integrator = *find_integrator(first.integrator);
  store.builder().want({integrator.entry, integrator.kernel, draft_config(first, info)});
  wait_for(store.builder());

  for (const char* name : {"relief", "textures", "hollow_ice", "cornell", "lights", "fractal_in_ice"}) {
    const CompiledScene scene = compile(scenes::shipped_small(name));
    INFO(name);
    renderer.change_scene(scene, options, times);
    CHECK(renderer.update().built == 0);
    REQUIRE(renderer.draws_draft());
    TileRequest request;
    request.tile = whole(scene);
    request.sample_count = scene.info.samples;
    const TileResult draft = renderer.render(request, {});
    own.change_scene(scene, own_options, times);
    CHECK(share_of_others(draft.sums, own.render(request, {}).sums) < 0.01);
  }

  // A session shows one and then, to the bit, what the scene's own kernels draw.
  RenderSession session(std::vector<DeviceInfo>{info});
  session.start(std::make_shared<const SceneDescription>(scenes::shipped_small("spheres")));
  session.wait();
  // Textures, and a formula that is in no cache.
  const std::string file = SUNDOG_SOURCE_DIR "/scenes/textures.json";
  nlohmann::json document = read_scene_document(file);
  document["image"]["width"] = 48, document["image"]["height"] = 36;
  document["render"] = {{"samples", 1}};
  document["objects"].push_back({{"type", "formula"},
                                 {"material", document["materials"].begin().key()},
                                 {"distance", fmt::format("length(p) - 0.4 + {}e-12", new_number())}});
  const auto scene = std::make_shared<const SceneDescription>(load_scene_document(document, file));
  const Generation generation = session.start(scene);
  Snapshot now = session.snapshot();
  while (!(now.shown == generation && now.samples > 0) && now.state != SessionState::failed) {
    session.wait_for_change(now.revision, 0.1);
    now = session.snapshot();
  }
  INFO(now.error);
  CHECK(now.state == SessionState::drawing);  // not complete, though each pixel is there
  CHECK(now.draft);
  CHECK(state_text(now) == "building a kernel");
  CHECK(now.kernels_waiting > 0);
  CHECK(now.work.kernels_built == 0);
  const std::shared_ptr<const Image> draft = now.picture;
  session.wait();
  now = session.snapshot();
  CHECK(now.state == SessionState::settled);
  CHECK_FALSE(now.draft);
  const Image cold = scenes::render_on(own_info, *scene).image;
  CHECK(same_bits(*now.picture, cold));
  std::size_t others = 0;
  for (std::size_t i = 0; i < cold.data.size(); ++i)
    others += std::abs(cold.data[i] - draft->data[i]) > 1e-3f;
  CHECK(others < cold.data.size() / 100);
}
