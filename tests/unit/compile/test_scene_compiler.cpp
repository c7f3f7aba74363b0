// Scenes compiled in parts: after any edits the bytes are those of a scene that is compiled by itself, and an
// edit makes only the parts that it concerns.
#include "compile/scene_compiler.h"

#include <cstring>
#include <functional>
#include <random>

#include "assets.h"
#include "catch.h"
#include "every_kind.h"
#include "scene/load.h"
#include "scenes.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

/// The first thing in which two scenes differ; empty where they are the same to the bit.
std::string difference(const CompiledScene& a, const CompiledScene& b) {
  if (std::memcmp(&a.info, &b.info, sizeof a.info) != 0) return "info";
  std::string where;
#define COMPARE_TABLE(type, host_type, name, label)                                 \
  if (a.name.size() != b.name.size() ||                                             \
      std::memcmp(a.name.data(), b.name.data(), a.name.size() * sizeof(host_type))) \
    where += #name " ";
  SCENE_TABLES(COMPARE_TABLE)
#undef COMPARE_TABLE
#define COMPARE_FEATURE(type, definition, name, effect) \
  if (a.features.name != b.features.name) where += "feature " #name " ";
  SCENE_FEATURES(COMPARE_FEATURE)
#undef COMPARE_FEATURE
  if (a.features.shapes != b.features.shapes) where += "shapes ";
  if (a.features.camera_inside != b.features.camera_inside) where += "camera_inside ";
  if (a.features.unbounded != b.features.unbounded) where += "unbounded ";
  if (a.features.bvh_stack != b.features.bvh_stack) where += "bvh_stack ";
  if (a.field_source != b.field_source) where += "field_source ";
  if (a.pattern_source != b.pattern_source) where += "pattern_source ";
  if (a.origin != b.origin) where += "origin ";
  if (a.figures.sah_cost != b.figures.sah_cost || a.figures.bytes != b.figures.bytes ||
      a.figures.mean_block_fill != b.figures.mean_block_fill)
    where += "figures ";
  return where;
}

SceneDescription shipped(const std::string& name) {
  return load_scene(std::string(SUNDOG_SOURCE_DIR) + "/scenes/" + name + ".json");
}

using Edit = std::function<void(SceneDescription&, std::mt19937&)>;

double number(std::mt19937& random) { return std::uniform_real_distribution<>(0, 1)(random); }

std::size_t one_of(std::mt19937& random, std::size_t count) { return random() % count; }

/// Edits of each part; those that a scene has nothing for do nothing.
std::vector<Edit> edits() {
  return {
      [](auto& s, auto& r) { s.camera.position += dvec3(number(r), number(r), number(r)); },
      [](auto& s, auto& r) { s.camera.fov = 20 + 50 * number(r); },
      [](auto& s, auto&) { s.camera.lens.radius = s.camera.lens.radius > 0 ? 0 : 0.1; },
      [](auto& s, auto& r) {  // far from the origin, and back
        const dvec3 far(number(r) < 0.5 ? 1000 : 0, 0, 0);
        s.camera.target = far;
        s.camera.position = far + dvec3(0, 1, 4);
      },
      [](auto& s, auto& r) { s.image.width = 8 + int(one_of(r, 9)); },
      [](auto& s, auto& r) { s.render.samples = 1 + int(one_of(r, 4)); },
      [](auto& s, auto& r) { s.render.filter = one_of(r, 2) ? Filter::tent : Filter::box; },
      [](auto& s, auto& r) {
        if (!s.lights.empty()) s.lights[one_of(r, s.lights.size())].intensity = number(r);
      },
      [](auto& s, auto& r) {
        const std::vector<LightDescription> all = every_light();
        s.lights.push_back(all[one_of(r, all.size())]);
      },
      [](auto& s, auto&) {
        if (!s.lights.empty()) s.lights.pop_back();
      },
      [](auto& s, auto& r) {
        s.environment.type = one_of(r, 2) ? EnvironmentType::gradient : EnvironmentType::none;
        s.environment.top = dvec3(number(r));
      },
      [](auto& s, auto& r) { s.fog.density = one_of(r, 2) ? 0.1 : 0; },
      [](auto& s, auto& r) {
        if (!s.materials.empty()) s.materials[one_of(r, s.materials.size())].diffuse = dvec3(number(r));
      },
      [](auto& s, auto& r) {
        if (!s.materials.empty())
          s.materials[one_of(r, s.materials.size())].reflection = dvec3(double(one_of(r, 2)));
      },
      [](auto& s, auto& r) {
        if (!s.materials.empty()) s.materials[one_of(r, s.materials.size())].roughness = number(r);
      },
      [](auto& s, auto& r) {
        if (!s.materials.empty()) s.materials[one_of(r, s.materials.size())].opacity = one_of(r, 2) ? 0.5 : 1;
      },
      [](auto& s, auto& r) {
        if (s.media.size() > 1) s.media[one_of(r, s.media.size())].absorption = dvec3(double(one_of(r, 2)));
      },
      [](auto& s, auto& r) {
        if (!s.objects.empty())
          s.objects[one_of(r, s.objects.size())].world_from_object[3] += glm::dvec4(number(r), 0, 0, 0);
      },
      [](auto& s, auto& r) {
        const std::vector<Shape> all = every_solid();
        scenes::place(s, all[one_of(r, all.size())], -1);
      },
      [](auto& s, auto&) {
        if (s.objects.size() > 1) s.objects.pop_back();
      },
      [](auto& s, auto& r) {
        for (Mesh& mesh : s.meshes)
          if (!mesh.positions.empty()) mesh.positions[one_of(r, mesh.positions.size())].x += 0.125f;
      },
      [](auto& s, auto& r) {
        if (!s.fields.empty() && s.fields[0].root.kind == SdfNode::Kind::formula)
          s.fields[0].root.formula.iterations = 3 + int(one_of(r, 5));
      },
      [](auto& s, auto& r) {
        if (!s.fields.empty()) s.fields[0].upper.x = 0.5 + number(r);
      },
      [](auto& s, auto& r) {
        if (!s.fields.empty()) s.fields[0].coloring.palette = {dvec3(number(r)), dvec3(1)};
      },
  };
}

SceneDescription with_a_mesh() {
  SceneDescription scene = shipped("spheres");
  scene.meshes.push_back(bumpy_sphere(6));
  scenes::place(scene, MeshShape{static_cast<int>(scene.meshes.size() - 1)}, 0);
  return scene;
}

}  // namespace

TEST_CASE("after any edits the compiled scene has the bytes of one that is compiled by itself") {
  std::mt19937 random(17);
  const std::vector<Edit> all = edits();
  SceneCompiler compiler;
  for (const char* name : {"spheres", "hollow_ice_exact", "mandelbulb", "patterns", "with a mesh"}) {
    SceneDescription scene = name == std::string("with a mesh") ? with_a_mesh() : shipped(name);
    for (int step = 0; step < 60; ++step) {
      const std::size_t edit = one_of(random, all.size());
      if (step > 0) all[edit](scene, random);
      INFO(name << ", step " << step << ", edit " << edit);
      REQUIRE(difference(compiler.compile(scene), compile(scene)).empty());
    }
  }
}

TEST_CASE("an edit makes the parts that it concerns, and shares the tables of the others") {
  SceneCompiler compiler;
  SceneDescription scene = with_a_mesh();
  const CompiledScene first = compiler.compile(scene);
  const CompileWork begun = compiler.work();
  CHECK(begun.bvhs == 2);

  SECTION("a camera's edit makes none") {
    scene.camera.position += dvec3(0.1, 0.2, 0.3);
    const CompiledScene second = compiler.compile(scene);
    CHECK(compiler.work() == begun);
    CHECK(second.blocks.shares(first.blocks));
    CHECK(second.nodes.shares(first.nodes));
    CHECK(second.lights.shares(first.lights));
    CHECK(second.materials.shares(first.materials));
  }
  SECTION("a colour's edit makes the surfaces") {
    scene.materials[0].diffuse = dvec3(0.25);
    const CompiledScene second = compiler.compile(scene);
    CompileWork surfaces = begun;
    ++surfaces.surfaces;
    CHECK(compiler.work() == surfaces);
    CHECK(second.nodes.shares(first.nodes));
  }
  SECTION("a light's edit makes the lights") {
    scene.lights.back().intensity *= 2;
    compiler.compile(scene);
    CHECK(compiler.work().lights == begun.lights + 1);
    CHECK(compiler.work().bvhs == begun.bvhs);
    CHECK(compiler.work().surfaces == begun.surfaces);
  }
  SECTION("a moved object makes the tree over instances, and no mesh") {
    scene.objects.back().world_from_object[3].x += 1;
    const CompiledScene second = compiler.compile(scene);
    CHECK(compiler.work().meshes == begun.meshes);
    CHECK(compiler.work().instances == begun.instances + 1);
    CHECK(second.blocks.shares(first.blocks));
  }
}

TEST_CASE("a camera's edit of a scene with media and of a field builds no tree") {
  for (const char* name : {"hollow_ice", "mandelbulb", "fractal_in_ice"}) {
    INFO(name);
    SceneCompiler compiler;
    SceneDescription scene = shipped(name);
    compiler.compile(scene);
    const CompileWork begun = compiler.work();
    const dvec3 arm = scene.camera.position - scene.camera.target;
    scene.camera.position = scene.camera.target + dvec3(arm.x + 0.02 * arm.z, arm.y, arm.z - 0.02 * arm.x);
    const CompiledScene second = compiler.compile(scene);
    CHECK(compiler.work() == begun);
    CHECK(difference(second, compile(scene)).empty());
    scene.camera.position *= 4;
    CHECK(difference(compiler.compile(scene), compile(scene)).empty());
  }
}

TEST_CASE("a material's edit makes nothing but the surfaces, in scenes with media, meshes and fields too") {
  for (const char* name : {"hollow_ice", "mandelbulb", "fractal_in_ice"}) {
    INFO(name);
    SceneCompiler compiler;
    SceneDescription scene = shipped(name);
    compiler.compile(scene);
    CompileWork surfaces = compiler.work();
    ++surfaces.surfaces;
    scene.materials[0].diffuse = dvec3(0.123);
    const CompiledScene second = compiler.compile(scene);
    CHECK(compiler.work() == surfaces);
    CHECK(difference(second, compile(scene)).empty());
  }
}

TEST_CASE("instances notice each fact of a material that they read") {
  SceneCompiler compiler;
  SceneDescription scene = shipped("spheres");
  scene.media.emplace_back().ior = 1.5;
  MaterialDescription& material = scene.materials[static_cast<std::size_t>(scene.objects[0].material)];
  material.medium = static_cast<int>(scene.media.size()) - 1;
  material.transmission = dvec3(0.5);
  material.roughness = 0.5;
  const std::vector<std::function<void()>> edits = {[&] { material.type = MaterialType::dielectric; },
                                                    [&] { material.roughness = 0; },
                                                    [&] { material.roughness = 0.5, material.medium = -1; },
                                                    [&] { material.wall_ior = 1.5; },
                                                    [&] { material.emission = dvec3(1); },
                                                    [&] { scene.render.integrator = "path"; }};
  for (const auto& edit : edits) {
    compiler.compile(scene);
    edit();
    CHECK(difference(compiler.compile(scene), compile(scene)).empty());
  }
}

TEST_CASE("zero and minus zero are different content") {
  SceneCompiler compiler;
  SceneDescription scene = shipped("spheres");
  scene.materials[0].diffuse.x = 0.0;
  compiler.compile(scene);
  scene.materials[0].diffuse.x = -0.0;
  CHECK(difference(compiler.compile(scene), compile(scene)).empty());
}

TEST_CASE("a scene that does not compile leaves the parts of the one before") {
  SceneCompiler compiler;
  SceneDescription scene = with_a_mesh();
  const CompiledScene first = compiler.compile(scene);
  SceneDescription broken = scene;
  broken.objects.back().world_from_object = glm::dmat4(0);
  CHECK_THROWS(compiler.compile(broken));
  CHECK(difference(compiler.compile(scene), first).empty());
}
