// The image is a pure function of scene and settings: the same bits for every work-group size, tile, run,
// interruption and sub-device.
#include <atomic>
#include <glm/gtc/matrix_transform.hpp>

#include "base/environment.h"
#include "base/error.h"
#include "base/file.h"
#include "catch.h"
#include "devices.h"
#include "same_bits.h"
#include "scene/load.h"
#include "scenes.h"
#include "temporary_folder.h"
#include "test_meshes.h"

using namespace sundog;
using glm::dvec3;

namespace {

// Without a mesh, but with every secondary effect: glass with liquid in it, a mirror, shadows through
// filters, several samples.
SceneDescription busy_scene() {
  SceneDescription scene = scenes::line_of_sight({0.6, 2.4, 6}, {0, 0.1, 0});
  scene.camera.fov = 35;
  scene.image.width = 37;
  scene.image.height = 29;
  scene.render.samples = 3;
  scene.render.max_depth = 6;
  scene.image.background_top = {0.2, 0.4, 0.9};
  LightDescription point;
  point.position = {-4, 6, 5};
  scene.lights.push_back(point);
  const int floor = scenes::add_white(scene);
  scene.materials[static_cast<std::size_t>(floor)].checker = true;
  const int ice = scenes::add_dielectric(scene, 1.31, {0.1, 0.05, 0.02}, 10);
  const int wine = scenes::add_dielectric(scene, 1.34, {0.5, 1.4, 1.2}, 20);
  scenes::place(scene, PlaneShape{}, floor, glm::translate(glm::dmat4(1), dvec3(0, -1, 0)));
  scenes::place(scene, RoundBoxShape{{0.9, 0.9, 0.9}, 0.1}, ice);
  scenes::place(scene, SphereShape{0.6}, wine);
  scenes::place(scene, SphereShape{0.7}, scenes::add_mirror(scene, 0.8),
                glm::translate(glm::dmat4(1), dvec3(1.9, -0.3, -0.4)));
  return scene;
}

// busy_scene() with a mesh of glass and a lamp, smaller: the compact tracer is slow on processors.
SceneDescription busy_mesh_scene() {
  SceneDescription scene = busy_scene();
  scene.image.width = 21;
  scene.image.height = 17;
  scene.render.samples = 2;
  LightDescription lamp;
  lamp.type = LightType::sphere;
  lamp.position = {3, 4, 2};
  lamp.samples = 2;
  scene.lights.push_back(lamp);
  scene.meshes = {bumpy_sphere(12)};
  scenes::place(scene, MeshShape{0}, scenes::add_dielectric(scene, 1.5, {0.3, 0.1, 0.2}, 5),
                glm::scale(glm::translate(glm::dmat4(1), dvec3(-1.7, -0.2, 0.9)), dvec3(0.6)));
  scenes::place(scene, MeshShape{0}, scenes::add_white(scene),
                glm::rotate(glm::translate(glm::dmat4(1), dvec3(0.4, 0.3, -2.2)), 0.8, dvec3(1, 1, 0)));
  return scene;
}

/// By the scene's own kernels: no other test has general ones with a rounded box, which take longer to build.
RenderResult render_by_own(const DeviceInfo& device, const SceneDescription& scene,
                           const RenderOptions& options = {}) {
  return render(compile(scene), {device}, options);
}

RenderOptions with_group(WorkGroup::Kind kind, std::size_t size) {
  RenderOptions options;
  options.work_group = {kind, size, 1};
  return options;
}

RenderOptions with_tile(int tile) {
  RenderOptions options;
  options.tile = tile;
  return options;
}

void check_work_groups(const DeviceInfo& device, const SceneDescription& scene) {
  const RenderResult reference = render_by_own(device, scene);
  REQUIRE(reference.complete);
  REQUIRE(reference.counts[COUNT_REFRACTION] > 0);
  CHECK(same_bits(render_by_own(device, scene).image, reference.image));
  CHECK(
      same_bits(render_by_own(device, scene, with_group(WorkGroup::Kind::driver, 0)).image, reference.image));
  for (const std::size_t size : {1u, 3u, 8u, 64u})
    CHECK(same_bits(render_by_own(device, scene, with_group(WorkGroup::Kind::fixed, size)).image,
                    reference.image));
  for (const int tile : {4, 12, 33, 64}) {
    const RenderResult tiled = render_by_own(device, scene, with_tile(tile));
    CHECK(same_bits(tiled.image, reference.image));
    CHECK(tiled.counts == reference.counts);
  }
}

// Solids and a mesh of glass, whose kernels test_drivers_agree has every driver compile anyway. Few pixels,
// in two tiles of 33: llvmpipe draws them twelve times.
SceneDescription scene_of_every_driver() {
  SceneDescription scene = load_scene(SUNDOG_SOURCE_DIR "/tests/support/every_feature/glass.json");
  scene.image.width = 36;
  scene.image.height = 10;
  return scene;
}

}  // namespace

TEST_CASE("the image has the same bits for every work-group size, tile size and run") {
  const std::string first = test_devices().front().label();
  on_every_device([&](const DeviceInfo& device) {
    check_work_groups(device, device.label() == first ? busy_scene() : scene_of_every_driver());
  });
}

TEST_CASE(
    "the image of a mesh has the same bits for every work-group size, tile size and run, by each tracer") {
  SceneDescription scene = busy_mesh_scene();
  for (const DeviceInfo& device : picture_devices())
    for (const Tracer tracer : {Tracer::automatic, Tracer::compact}) {
      if (tracer == Tracer::compact && device.native_vector_width <= 1) continue;  // is the automatic one
      DYNAMIC_SECTION(device.label() << (tracer == Tracer::compact ? ", compact" : "")) {
        scene.render.tracer = tracer;
        check_work_groups(device, scene);
      }
    }
}

TEST_CASE("a tuning's options reach the integrator's build, not that of AOVs, and keep the bits") {
  const TemporaryFolder folder;
  SceneDescription scene = busy_mesh_scene();
  scene.render.tracer = Tracer::compact;
  DeviceInfo device = test_devices().front();
  RenderOptions options;
  options.aovs = {"depth"};
  const RenderResult usual = render_by_own(device, scene, options);
  HostEnvironment environment = value_of(device.environment);
  environment.build_log = folder.path().string();
  device.environment = std::make_shared<const HostEnvironment>(environment);
  options.tuning = [](const DeviceInfo&) {
    Tuning tuning;
    tuning.options = "-DNODE_LOOP=2";
    return tuning;
  };
  CHECK(same_bits(render_by_own(device, scene, options).image, usual.image));
  for (const auto& file : std::filesystem::directory_iterator(folder.path())) {
    const std::string log = read_file(file.path());
    const bool has = log.substr(0, log.find("== log ==")).find(" -DNODE_LOOP=2\n") != std::string::npos;
    CHECK(has == file.path().filename().string().starts_with("render_whitted-"));
  }
  CHECK(folder.entries() == 2);
}

TEST_CASE("a path-traced image has the same bits for every work-group size, tile size, run and pass") {
  SceneDescription scene = busy_mesh_scene();
  scene.render.integrator = "path";
  scene.render.sampler = SAMPLER_SOBOL;
  scene.render.samples = 4;
  scene.materials.front().specular = dvec3(0.2);
  scene.materials.back().roughness = 0.3;
  scene.materials.back().reflection = dvec3(0.3);
  const DeviceInfo device = test_devices().front();
  check_work_groups(device, scene);
  SceneDescription growing = scene;
  growing.render.sampling.progressive = true;
  CHECK(same_bits(render_by_own(device, growing).image, render_by_own(device, scene).image));
}

TEST_CASE("programs as GPUs get them, inlined and with state kept in memory, draw the same bits") {
  SceneDescription scene = busy_mesh_scene();
  scene.render.tracer = Tracer::compact;
  const DeviceInfo device = test_devices().front();
  HostEnvironment environment = value_of(device.environment);
  environment.build_options = "-DDEVICE_INLINES_ALL";
  DeviceInfo like_gpu = device;
  like_gpu.environment = std::make_shared<const HostEnvironment>(std::move(environment));
  for (const char* integrator : {"whitted", "path"}) {
    CAPTURE(integrator);
    scene.render.integrator = integrator;
    CHECK(same_bits(render_by_own(like_gpu, scene).image, render_by_own(device, scene).image));
  }
}

TEST_CASE("sub-devices compute the same bits as the whole device") {
  const SceneDescription scene = busy_scene();
  for (const DeviceInfo& device : test_devices()) {
    if (device.max_sub_devices < 2) continue;
    DYNAMIC_SECTION(device.label()) {
      DeviceInfo part = device;
      part.sub_units = 1;
      CHECK(same_bits(render_by_own(part, scene).image, render_by_own(device, scene).image));
    }
  }
}

TEST_CASE("an interrupted frame is resumed to the same bits") {
  const SceneDescription scene = busy_scene();
  const TemporaryFolder folder;
  const DeviceInfo device = test_devices().front();
  const RenderResult reference = render_by_own(device, scene);
  std::atomic<bool> stop{false};
  RenderOptions options = with_tile(8);
  options.resume = folder.path() / "frame.checkpoint";
  options.stop = &stop;
  options.on_progress = [&](const RenderProgress& progress) {
    stop = progress.pixels_done > progress.pixels_total / 3;
  };
  const RenderResult part = render_by_own(device, scene, options);
  REQUIRE_FALSE(part.complete);
  REQUIRE(std::filesystem::exists(options.resume));

  SECTION("with what was done kept") {
    options.stop = nullptr;
    std::uint64_t first_report = 0;
    options.on_progress = [&](const RenderProgress& progress) {
      first_report = first_report ? first_report : progress.pixels_done;
    };
    const RenderResult whole = render_by_own(device, scene, options);
    CHECK(whole.complete);
    CHECK(same_bits(whole.image, reference.image));
    CHECK(first_report > whole.image.data.size() / 4 / 3);
  }
  SECTION("but not into another scene") {
    SceneDescription other = scene;
    other.camera.fov = 36;
    CHECK_THROWS_AS(render_by_own(device, other, options), UsageError);
  }
  SECTION("and a damaged checkpoint is refused") {
    std::filesystem::resize_file(options.resume, std::filesystem::file_size(options.resume) - 5);
    CHECK_THROWS_AS(render_by_own(device, scene, options), SceneError);
  }
}

TEST_CASE("two devices share a frame without changing it") {
  const SceneDescription scene = busy_scene();
  for (const DeviceInfo& device : test_devices()) {
    if (device.max_sub_devices < 2) continue;
    DYNAMIC_SECTION(device.label()) {
      DeviceInfo part = device;
      part.sub_units = 1;
      const RenderResult shared = render(compile(scene), {part, part}, with_tile(8));
      CHECK(same_bits(shared.image, render_by_own(device, scene).image));
      CHECK(shared.devices.size() == 2);
      CHECK(shared.devices[0].tiles + shared.devices[1].tiles == 5 * 4);
    }
  }
}

TEST_CASE("the image has the same bits however the frame is split among devices") {
  const SceneDescription scene = busy_scene();
  for (const DeviceInfo& device : test_devices()) {
    if (device.max_sub_devices < 2) continue;
    DYNAMIC_SECTION(device.label()) {
      DeviceInfo part = device;
      part.sub_units = 1;
      const RenderResult reference = render_by_own(device, scene);
      for (const Split& split :
           {Split{}, Split{Split::Kind::fixed, {}}, Split{Split::Kind::fixed, {3, 1, 1}},
            Split{Split::Kind::fixed, {0, 0, 1}}, Split{Split::Kind::fixed, {1e-9, 1, 0}}}) {
        RenderOptions options;
        options.split = split;
        const RenderResult shared = render(compile(scene), {part, part, part}, options);
        CHECK(shared.complete);
        CHECK(same_bits(shared.image, reference.image));
        CHECK(shared.counts == reference.counts);
        double shares = 0;
        for (const DeviceReport& report : shared.devices) shares += report.share;
        CHECK(shares == Approx(1));
        if (!split.shares.empty() && split.shares[0] == 3)
          CHECK(shared.devices[0].share == Approx(20 / 29.0));
      }
    }
  }
}

TEST_CASE("a device that cannot be opened leaves the frame to the others") {
  const SceneDescription scene = busy_scene();
  const DeviceInfo device = test_devices().front();
  DeviceInfo broken = device;
  broken.problem = "taken out by the test";
  const RenderResult result = render(compile(scene), {broken, device});
  CHECK(result.complete);
  CHECK_FALSE(result.devices[0].ready);  // whether it is retired depends on whether it was heard of in time
  CHECK(result.devices[1].share == 1);
  CHECK_THROWS_AS(render(compile(scene), {broken, broken}), DeviceError);
}
