// Sessions on devices: after any edits the settled picture has the bits of a cold render; a camera's edit
// uploads no geometry; a pick shows what the AOVs show.
#include "render/session/render_session.h"

#include <chrono>
#include <thread>

#include "catch.h"
#include "compile/compiled_scene.h"
#include "device/choice.h"
#include "devices.h"
#include "new_formula.h"
#include "render/device/kernel_config.h"
#include "same_bits.h"
#include "scene/integrators.h"
#include "scene/load.h"
#include "scenes.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

using Scene = std::shared_ptr<const SceneDescription>;

/// The session's picture of the scene once it is settled.
Image settled(RenderSession& session, const SceneDescription& scene, bool general_kernels) {
  SessionSettings settings;
  settings.general_kernels = general_kernels;
  session.start(std::make_shared<const SceneDescription>(scene), settings);
  session.wait();
  const Snapshot snapshot = session.snapshot();
  INFO(snapshot.error);
  REQUIRE(snapshot.state == SessionState::settled);
  CHECK(snapshot.shown == snapshot.generation);
  return *snapshot.picture;
}

void check_settled(RenderSession& session, const SceneDescription& scene, const DeviceInfo& device,
                   bool general_kernels = false) {
  CHECK(same_bits(settled(session, scene, general_kernels), scenes::render_on(device, scene).image));
}

/// Until the kernels for edits to come are built.
void wait_until_prepared(RenderSession& session) {
  for (int i = 0; i < 8000 && !session.snapshot(false).prepared; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
  REQUIRE(session.snapshot(false).prepared);
}

bool has_kernels(const DeviceInfo& info, const CompiledScene& scene, const KernelConfig& kernels) {
  return Device(info).has(integrator_of(scene.integrator).entry, kernels.defines(), kernels.generated);
}

/// Until the session has built these kernels of the scene.
void wait_for_kernels(const DeviceInfo& device, const CompiledScene& scene, const KernelConfig& kernels) {
  for (int i = 0; i < 2000 && !has_kernels(device, scene, kernels); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  REQUIRE(has_kernels(device, scene, kernels));
}

/// Draws the scene until its own kernels are there. A session that draws builds none for edits to come.
void draw_until_built(RenderSession& session, const SceneDescription& scene, const DeviceInfo& device) {
  const CompiledScene compiled = compile(scene);
  const KernelConfig own = make_kernel_config(compiled, device);
  for (int i = 0; i < 2000 && !has_kernels(device, compiled, own); ++i) {
    settled(session, scene, true);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  REQUIRE(has_kernels(device, compiled, own));
}

/// The field less a part of itself.
SdfNode with_hole(const SdfNode& field) {
  SdfNode moved, whole;
  moved.kind = SdfNode::Kind::transform;
  moved.offset = dvec3(0.4);
  moved.children = {field};
  whole.kind = SdfNode::Kind::subtract;
  whole.smooth = 0.1;
  whole.children = {field, moved};
  return whole;
}

SceneDescription mesh_scene() {
  SceneDescription scene = scene_of(bumpy_sphere(8));
  scene.image.width = 30;
  scene.image.height = 22;
  scene.render.samples = 2;
  return scene;
}

}  // namespace

TEST_CASE("after edits the settled picture has the bits of a cold render") {
  on_every_device([](const DeviceInfo& device) {
    RenderSession session(std::vector<DeviceInfo>{device});
    SceneDescription scene = scenes::shipped_small("spheres");
    check_settled(session, scene, device);
    scene.camera.position += dvec3(0.2, 0.1, 0);
    check_settled(session, scene, device);
    scene.materials[0].diffuse = dvec3(0.1, 0.5, 0.2);
    check_settled(session, scene, device);
    scene.lights.back().intensity *= 0.5;
    scene.objects.back().world_from_object[3].y += 0.2;
    check_settled(session, scene, device);
    if (device.label() != test_devices().front().label()) return;  // kernels of passes: on one device
    scene.render.sampling.threshold = 0.05;
    scene.render.samples = 8;
    check_settled(session, scene, device);
    scene.render.sampling.threshold = 0;
    scene.render.sampling.subsample = true;
    scene.render.samples = 2;
    check_settled(session, scene, device);
  });
}

TEST_CASE("a session goes from one scene to another, of other kernels, and back") {
  const DeviceInfo& device = test_devices().front();
  RenderSession session(std::vector<DeviceInfo>{device});
  SceneDescription fractal = scenes::shipped_small("mandelbulb");
  check_settled(session, mesh_scene(), device);
  check_settled(session, fractal, device);
  check_settled(session, scenes::shipped_small("hollow_ice_exact"), device);
  fractal.fields[0].root.formula.steps[0].values[0] += 1;
  check_settled(session, fractal, device);
  fractal.camera.position *= 0.9;
  check_settled(session, fractal, device);
  check_settled(session, mesh_scene(), device);
}

TEST_CASE("several devices settle on the picture of several devices' bits") {
  const std::vector<DeviceInfo>& devices = test_devices();
  if (devices.size() < 2) return;
  // Each pixel has the bits of one of the devices: which one is a matter of speed.
  const SceneDescription scene = scenes::shipped_small("spheres");  // as above: its kernels are there
  // The session ends with its picture. Once it rests it builds general kernels, on llvmpipe for a minute.
  const Image shared = settled(*std::make_unique<RenderSession>(devices), scene, true);
  std::vector<Image> single;
  for (const DeviceInfo& device : devices) single.push_back(scenes::render_on(device, scene).image);
  const std::size_t pixels = shared.data.size() / 4;
  for (std::size_t p = 0; p < pixels; ++p)
    REQUIRE(std::ranges::any_of(single, [&](const Image& image) {
      return std::equal(&image.data[4 * p], &image.data[4 * p] + 4, &shared.data[4 * p]);
    }));
}

TEST_CASE("a camera's edit builds no tree and uploads no geometry") {
  const DeviceInfo& device = test_devices().front();
  RenderSession session(std::vector<DeviceInfo>{device});
  SceneDescription scene = mesh_scene();
  check_settled(session, scene, device);
  CHECK(session.snapshot().work.compiled.bvhs == 2);
  CHECK(session.snapshot().work.bytes_uploaded > 0);
  scene.camera.position += dvec3(0.1, 0, 0);
  check_settled(session, scene, device);
  const EditWork camera = session.snapshot().work;
  CHECK(camera.compiled == CompileWork{});
  CHECK(camera.bytes_uploaded == 0);
  CHECK(camera.kernels_built == 0);
  scene.materials.back().diffuse = dvec3(0.3);
  check_settled(session, scene, device);
  const EditWork color = session.snapshot().work;
  CHECK(color.compiled.bvhs == 0);
  CHECK(color.tables_uploaded == 1);
  CHECK(color.bytes_uploaded <= 1024);
}

TEST_CASE("a pick shows what the first surface is") {
  const DeviceInfo& device = test_devices().front();
  RenderSession session(std::vector<DeviceInfo>{device});
  const SceneDescription scene = scenes::shipped_small("spheres");
  session.start(std::make_shared<const SceneDescription>(scene));
  session.wait();
  RenderOptions options;
  options.aovs = {"object", "material", "depth", "normal", "position"};
  const RenderResult whole = scenes::render_on(device, scene, options);
  for (const auto& [x, y] : {std::pair{18, 13}, std::pair{2, 24}, std::pair{18, 0}}) {
    INFO(x << ", " << y);
    const std::optional<Picked> picked = session.pick(x, y);
    REQUIRE(picked);
    CHECK(picked->object == static_cast<int>(whole.aovs.at("object").pixel(x, y)[0]));
    CHECK(picked->material == static_cast<int>(whole.aovs.at("material").pixel(x, y)[0]));
    CHECK(picked->depth == whole.aovs.at("depth").pixel(x, y)[0]);
    CHECK(picked->normal.y == whole.aovs.at("normal").pixel(x, y)[1]);
    CHECK(picked->position.x == whole.aovs.at("position").pixel(x, y)[0]);
  }
}

TEST_CASE(
    "general kernels draw the same bits as a scene's own, and an edit that wants others waits for none") {
  const DeviceInfo& device = test_devices().front();
  auto session = std::make_unique<RenderSession>(std::vector<DeviceInfo>{device});
  SceneDescription scene = scenes::shipped_small("mandelbulb");
  scene.render.max_depth = 3;
  check_settled(*session, scene, device, true);
  wait_until_prepared(*session);
  // Kernels that no cache has: of an odd depth, with a highlight and a light of another kind.
  scene.render.max_depth = 4;
  scene.materials.back().exponent = 7.5;
  scene.materials.back().reflection = dvec3(0.2);
  scene.lights.emplace_back();
  scene.lights.back().type = LightType::ambient;
  const auto drawn_at_once = [&](const SceneDescription& edited) {
    Image image = settled(*session, edited, true);
    CHECK(session->snapshot().work.kernels_built == 0);
    return image;
  };
  const Image general = drawn_at_once(scene);
  wait_until_prepared(*session);
  const Image own = drawn_at_once(scene);
  CHECK(same_bits(general, own));
  CHECK(same_bits(own, scenes::render_on(device, scene).image));
  // Fog and a lens have general kernels of their own. Other formulas are interpreted.
  std::vector<SceneDescription> others(3, scene);
  others[0].fog.density = 0.1;
  others[1].camera.lens.radius = 0.02;
  others[2].fields[0] = new_formula("length(p) - 1 + 0.1 * sin(5 * p.x)").fields[0];
  others[2].fields[0].root = with_hole(others[2].fields[0].root);
  if (!calls_functions(device)) others.pop_back();
  std::vector<Image> drawn;
  for (const SceneDescription& other : others) drawn.push_back(drawn_at_once(other));
  // Without the session, which would build kernels for edits to come beside the cold renders.
  session.reset();
  for (std::size_t i = 0; i < others.size(); ++i)
    CHECK(same_bits(drawn[i], scenes::render_on(device, others[i]).image));
}

TEST_CASE("general kernels of paths draw the same bits as a scene's own, after most edits at once") {
  const DeviceInfo& device = test_devices().front();
  RenderSession session(std::vector<DeviceInfo>{device});
  SceneDescription scene = scenes::shipped_small("cornell_path");
  scene.render.samples = 2;
  check_settled(session, scene, device, true);
  const CompiledScene first = compile(scene);
  wait_for_kernels(device, first, general_config(first, device));
  // Kernels that no scene that ships has: of an odd highlight, a glass that absorbs, and lamps among many.
  scene.materials.back().exponent = 7.5;
  scene.materials.back().reflection = dvec3(0.2);
  scene.materials.back().roughness = 0.3;
  scene.lights.emplace_back();
  scene.lights.back().type = LightType::point;
  scene.lights.back().position = dvec3(0.5, 0.5, 0.5);
  check_settled(session, scene, device, true);
  CHECK(session.snapshot().work.kernels_built == 0);
  draw_until_built(session, scene, device);
  check_settled(session, scene, device, true);
}

TEST_CASE("kernels stand in for others that leave harmless features out") {
  const DeviceInfo& device = test_devices().front();
  const CompiledScene scene = compile(scenes::shipped_small("spheres"));
  const KernelConfig own = make_kernel_config(scene, device), general = general_config(scene, device);
  CHECK(stands_in(general, own));
  CHECK(stands_in(own, own));
  CHECK_FALSE(stands_in(own, general));
  CompiledScene foggy = scene;
  foggy.features.fog = true;
  const KernelConfig fog = make_kernel_config(foggy, device);
  CHECK_FALSE(stands_in(general, fog));
  CHECK(std::ranges::count_if(general_configs(scene, device),
                              [&](const KernelConfig& one) { return stands_in(one, fog); }) == 1);
  CHECK_FALSE(stands_in(general_config(compile(scenes::shipped_small("mandelbulb")), device), own));
  const CompiledScene bulb = compile(scenes::shipped_small("mandelbulb"));
  const KernelConfig interpreting = interpreting_config(bulb, device);
  CompiledScene sphere = bulb;
  sphere.field_source = "another";
  sphere.features.field_flags = SDF_SMOOTH;
  CHECK(stands_in(interpreting, make_kernel_config(sphere, device)));
  CHECK_FALSE(stands_in(general_config(bulb, device), make_kernel_config(sphere, device)));
  sphere.sdf_parameters.edit()[0] = 0;
  CHECK_FALSE(stands_in(interpreting, make_kernel_config(sphere, device)));
  CHECK_FALSE(stands_in(interpreting, own));
  const CompiledScene patterns = compile(scenes::shipped_small("patterns"));
  CHECK(stands_in(general_config(patterns, device), make_kernel_config(patterns, device)));
  // Surface coordinates turn the frame in which layers are sampled: other noise.
  const CompiledScene layers =
      compile(load_scene(SUNDOG_SOURCE_DIR "/tests/support/every_feature/layers.json"));
  const KernelConfig layered = make_kernel_config(layers, device);
  CHECK(general_config(layers, device).numbers.at("HAS_UV") == layered.numbers.at("HAS_UV"));
  KernelConfig with_coordinates = layered;
  with_coordinates.numbers.at("HAS_UV") = 1;
  CHECK_FALSE(stands_in(with_coordinates, layered));
}

TEST_CASE("a session renders frames to their end, and draws between them") {
  const DeviceInfo& device = test_devices().front();
  RenderSession session(std::vector<DeviceInfo>{device});
  SceneDescription scene = mesh_scene();
  RenderOptions options;
  options.aovs = {"depth"};
  const auto flat = [](const SceneDescription& of) {
    return std::make_shared<const CompiledScene>(compile(of));
  };
  const RenderResult first = session.render(flat(scene), options);
  CHECK(first.complete);
  const RenderResult cold = scenes::render_on(device, scene, options);
  CHECK(same_bits(first.image, cold.image));
  CHECK(same_bits(first.aovs.at("depth"), cold.aovs.at("depth")));
  CHECK(first.counts == cold.counts);
  check_settled(session, scene, device);
  const auto shown = session.snapshot().shown;
  scene.camera.position += dvec3(0.1, 0, 0);
  const RenderResult second = session.render(flat(scene));
  CHECK(same_bits(second.image, scenes::render_on(device, scene).image));
  CHECK(second.devices.at(0).kernels_built == 0);
  CHECK(session.snapshot().shown == shown);
  CHECK_FALSE(session.pick(1, 1));
  check_settled(session, scene, device);
}

TEST_CASE(
    "while a kernel is built that no other stands in for, other edits are drawn; then it needs no compiler") {
  const DeviceInfo& device = test_devices().front();
  RenderSession session(std::vector<DeviceInfo>{device});
  SceneDescription usual = scenes::shipped_small("mandelbulb");
  usual.render.max_depth = 3;  // as above, so that its general kernels are in the cache
  check_settled(session, usual, device, true);
  SceneDescription field = new_formula("length(p) - 1");
  field.fields[0].root = {};
  field.fields[0].root.kind = SdfNode::Kind::native;
  field.fields[0].root.code = fmt::format("return length3(p) - 1.0f;  // {}", new_number());
  session.start(std::make_shared<const SceneDescription>(field));
  while (session.snapshot(false).kernels_waiting == 0) session.wait_for_change(0, 0.01);
  SceneDescription turned = usual;
  turned.camera.position += dvec3(0.2, 0, 0);
  session.start(std::make_shared<const SceneDescription>(turned));
  session.wait();
  const Snapshot drawn = session.snapshot(false);
  CHECK(drawn.kernels_waiting > 0);
  CHECK(drawn.work.kernels_built == 0);
  CHECK(drawn.work.bytes_uploaded == 0);
  check_settled(session, turned, device, true);
  session.start(std::make_shared<const SceneDescription>(field));
  session.wait();
  CHECK(session.snapshot().state == SessionState::settled);
  check_settled(session, field, device, true);
}
