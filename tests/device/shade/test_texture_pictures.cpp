// Pictures of surfaces with textures whose values are known.
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "catch.h"
#include "compile/surfaces/textures.h"
#include "devices.h"
#include "scenes.h"
#include "surface_testing.h"

using namespace sundog;
using glm::dvec4;

namespace {

int add_image(SceneDescription& scene, int width, std::vector<std::uint8_t> data, int channels = 1) {
  ImageDescription image;
  image.srgb = false;
  image.pixels.width = width;
  image.pixels.channels = channels;
  image.pixels.height = static_cast<int>(data.size()) / width / channels;
  image.pixels.data = std::move(data);
  TextureDescription texture;
  texture.kind = TEXTURE_IMAGE;
  texture.image = static_cast<int>(scene.images.size());
  scene.images.push_back(image);
  scene.textures.push_back(texture);
  return static_cast<int>(scene.textures.size()) - 1;
}

/// A clamped image without filter.
int add_halves(SceneDescription& scene, std::uint8_t left, std::uint8_t right) {
  const int texture = add_image(scene, 2, {left, right});
  scene.textures.back().wrap[0] = scene.textures.back().wrap[1] = Wrap::clamp;
  scene.textures.back().filter = TextureFilter::nearest;
  return texture;
}

constexpr float leaf_at = 10, bent_at = 20, front_at = 30, wall_at = 40, back_at = 50, cut_at = 60,
                quad_at = 80, further_at = 90;

void place_disk(SceneDescription& scene, const MaterialDescription& material, dvec3 at, double radius) {
  scene.materials.push_back(material);
  scenes::place(scene, DiskShape{radius, 0}, static_cast<int>(scene.materials.size()) - 1,
                glm::translate(glm::dmat4(1), at));
}

/// Nothing yet; the sun stands at 0.8 over a floor, towards +x.
SceneDescription under_the_sun() {
  SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = {-0.6, -0.8, 0};
  scene.lights.push_back(sun);
  return scene;
}

/// Two quads at y = 1 with the same heights, of which one has them on its further set of coordinates.
void place_quads(SceneDescription& scene) {
  Mesh quad;
  quad.normals.assign(4, {0, 1, 0});
  for (const glm::vec2 corner : {glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1), glm::vec2(-1, -1)}) {
    quad.positions.push_back({corner.x, 0, corner.y});
    quad.uvs.push_back({0.5f + 0.5f * corner.x, 0.5f - 0.5f * corner.y});
  }
  quad.triangles = {{0, 1, 2}, {0, 2, 3}};
  quad.further_uvs = {quad.uvs};
  // The second set is that of the first; the first of the other quad is turned by a quarter.
  Mesh other = quad;
  for (glm::vec2& uv : other.uvs) uv = {1 - uv.y, uv.x};
  scene.meshes = {quad, other};
  MaterialDescription material;
  material.ambient = dvec3(0), material.diffuse = dvec3(1);
  material.textures.height = add_image(scene, 8, {0, 10, 40, 90, 160, 200, 230, 255});
  material.bump = 0.2;
  material.parallax = 0.1;
  const auto place = [&](int mesh, double x) {
    scene.materials.push_back(material);
    scenes::place(scene, MeshShape{mesh}, static_cast<int>(scene.materials.size()) - 1,
                  glm::translate(glm::dmat4(1), dvec3(x, 1, 0)));
  };
  place(0, quad_at);
  const TextureDescription heights = scene.textures.back();
  scene.textures.push_back(heights);
  scene.textures.back().uv_set = 1;
  material.textures.height = static_cast<int>(scene.textures.size()) - 1;
  place(1, further_at);
}

/// Many things in one scene, whose kernels drivers compile once: a floor that glows in a checker of texels
/// and above it disks and quads, along x.
SceneDescription many_things() {
  SceneDescription scene = under_the_sun();
  scene.image.background_bottom = scene.image.background_top = dvec3(0.25);
  std::vector<std::uint8_t> cells;
  for (int i = 0; i < 64 * 64; ++i) cells.push_back((i / 64 + i) % 2 ? 255 : 0);
  MaterialDescription glow, white;
  white.ambient = dvec3(0), white.diffuse = dvec3(1);
  glow.ambient = glow.diffuse = dvec3(0);
  glow.emission = dvec3(1, 0.5, 0.25);
  glow.textures.emission = add_image(scene, 64, std::move(cells));
  scene.materials.push_back(glow);
  scenes::place(scene, PlaneShape{}, 0);
  MaterialDescription leaf = glow;
  leaf.emission = {0, 1, 0};
  leaf.textures = {};
  leaf.textures.opacity = add_halves(scene, 255, 0);
  leaf.cutoff = 0.5;
  place_disk(scene, white, {leaf_at, 1, 0}, 3);
  place_disk(scene, leaf, {leaf_at, 2, 0}, 1);
  MaterialDescription bent = white;
  bent.textures.normal = add_image(scene, 1, {179, 128, 230, 255}, 4);
  place_disk(scene, bent, {bent_at, 1, 0}, 1);
  MaterialDescription front = white;
  front.ambient = dvec3(1), front.diffuse = dvec3(0);
  front.one_sided = true;
  place_disk(scene, front, {front_at, 1, 0}, 1);
  // From above and from the sun only their backs would be seen, which are not there.
  place_disk(scene, white, {back_at, 0.5, 0}, 3);
  place_disk(scene, front, {back_at, 1, 0}, 1);
  scene.objects.back().world_from_object =
      glm::rotate(scene.objects.back().world_from_object, std::numbers::pi, dvec3(1, 0, 0));
  MaterialDescription wall = white;
  wall.textures.height = add_halves(scene, 0, 255);
  wall.bump = 0;
  wall.parallax = 0.2;
  place_disk(scene, wall, {wall_at, 1, 0}, 1);
  place_quads(scene);
  return scene;
}

/// Whether drivers compile so many features for minutes.
bool compiles_for_long(const DeviceInfo& info) { return info.native_vector_width == 1; }

dvec3 seen(const DeviceInfo& info, const SceneDescription& scene, dvec3 from, dvec3 to, double fov = 1e-3) {
  SceneDescription view = scene;
  view.camera.position = from;
  view.camera.target = to;
  view.camera.fov = fov;
  return scenes::pixel_on(info, view);
}

}  // namespace

TEST_CASE("pictures have what textures make of surfaces") {
  const SceneDescription scene = many_things();
  on_every_device([&](const DeviceInfo& info) {
    if (compiles_for_long(info)) return;
    const auto below = [&](double x, double height) { return seen(info, scene, {x, height, 0}, {x, 0, 0}); };
    // 70 repeats of the checker in a pixel are its mean; near by a texel is what it is.
    const dvec3 far = seen(info, scene, {-300, 2000, 0.1}, {-300, 0, 0.1}, 2);
    CHECK(far.x == Approx(0.5).epsilon(1e-2));
    CHECK(far.y == Approx(0.25).epsilon(1e-2));
    const dvec3 texel{-5 + 20.5 / 64, 0, 11.5 / 64 - 1};
    CHECK(seen(info, scene, texel + dvec3(0, 1e-3, 0), texel).x == Approx((11 + 20) % 2).margin(2e-3));
    // The leaf's left half is there, with its shadow 0.75 to the left; the right half lets all through.
    CHECK(below(leaf_at - 0.7, 5).y == Approx(1));
    CHECK(below(leaf_at - 0.7, 5).x == Approx(0).margin(1e-6));
    CHECK(below(leaf_at + 0.5, 5).x == Approx(0.8));
    CHECK(below(leaf_at - 1.2, 1.5).x == Approx(0).margin(1e-6));
    CHECK(below(leaf_at - 0.1, 1.5).x == Approx(0.8));
    const dvec3 n = glm::normalize(dvec3(179 / 127.5 - 1, 230 / 127.5 - 1, 1 - 128 / 127.5));
    // Less what the terminator takes (Conty Estevez and others 2019).
    const double lit = glm::dot(n, dvec3(0.6, 0.8, 0)), alpha2 = 0.125 * (1 - n.y * n.y) / (n.y * n.y);
    CHECK(below(bent_at, 3).x == Approx(lit * 2 / (1 + std::sqrt(1 + alpha2 * 0.36 / 0.64))).margin(2e-3));
    CHECK(below(front_at, 3).x == Approx(1));
    CHECK(seen(info, scene, {front_at, 0.5, 0}, {front_at, 3, 0}).x == Approx(0.25));
    CHECK(below(back_at, 3).x == Approx(0.8));
    // Left of the wall, which is 0.2 high, its shadow is 0.15 wide.
    CHECK(below(wall_at - 0.07, 3).x == Approx(0).margin(1e-6));
    CHECK(below(wall_at - 0.3, 3).x == Approx(0.8));
    CHECK(below(wall_at + 0.3, 3).x == Approx(0.8));
  });
}

TEST_CASE("heights on a further set of coordinates bend normals and sink in as on the first") {
  on_picture_devices([&](const DeviceInfo& info) {
    SceneDescription scene = compiles_for_long(info) ? under_the_sun() : many_things();
    if (scene.meshes.empty()) place_quads(scene);
    for (const double x : {-0.6, -0.1, 0.35}) {
      INFO(x);
      const double first = seen(info, scene, {quad_at + x + 1, 4, 0.2}, {quad_at + x, 1, 0.2}).x,
                   further = seen(info, scene, {further_at + x + 1, 4, 0.2}, {further_at + x, 1, 0.2}).x;
      CHECK(std::abs(first - 0.8) > 0.01);  // of a flat surface
      CHECK(further == Approx(first).margin(2e-3));
    }
  });
}

TEST_CASE("a texture of the colour of vertices lies between them, with its alpha for rays and for light") {
  on_picture_devices([&](const DeviceInfo& info) {
    SceneDescription scene = under_the_sun();
    scene.lights.back().direction = {0, -1, 0};
    Mesh mesh;
    mesh.positions = {{-1, 2, 1}, {1, 2, 1}, {-1, 2, -1}};
    mesh.triangles = {{0, 1, 2}};
    mesh.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.alphas = {0.2f, 0.6f, 1.0f};
    scene.meshes = {mesh};
    TextureDescription color;
    color.kind = TEXTURE_VERTEX_COLOR;
    TextureDescription alpha = color;
    alpha.channel = 3;
    scene.textures = {color, alpha};
    MaterialDescription faded, white;
    white.ambient = dvec3(0), white.diffuse = dvec3(1);
    faded.ambient = faded.diffuse = dvec3(0);
    faded.emission = dvec3(1);
    faded.textures.emission = 0;
    faded.textures.opacity = 1;
    scene.materials = {faded, white};
    scenes::place(scene, MeshShape{0}, 0);
    scenes::place(scene, PlaneShape{}, 1);
    // Shares of the corners: 0.5, 0.2, 0.3.
    const dvec3 at{-1 + 2 * 0.2, 0, 1 - 2 * 0.3};
    const double there = 0.5 * 0.2 + 0.2 * 0.6 + 0.3 * 1, floor = 1 - there;
    const dvec3 shadow = seen(info, scene, at + dvec3(0, 1, 0), at),
                shown = seen(info, scene, at + dvec3(0, 5, 0), at);
    CHECK(shadow.x == Approx(floor).epsilon(1e-4));
    CHECK(shown.x == Approx(there * 0.5 + (1 - there) * floor).epsilon(1e-4));
    CHECK(shown.y == Approx(there * 0.2 + (1 - there) * floor).epsilon(1e-4));
    CHECK(shown.z == Approx(there * 0.3 + (1 - there) * floor).epsilon(1e-4));
  });
}

TEST_CASE("an opacity cut off lets rays and light through where the texture says") {
  on_every_device([&](const DeviceInfo& info) {
    // The left half of a disk is there, the right half is not; above it stands the sun, below is a floor.
    SceneDescription scene = compiles_for_long(info) ? under_the_sun() : many_things();
    MaterialDescription leaf, white;
    white.ambient = dvec3(0), white.diffuse = dvec3(1);
    leaf.ambient = leaf.diffuse = dvec3(0);
    leaf.emission = {0, 1, 0};
    leaf.textures.opacity = add_image(scene, 2, {255, 0});
    scene.textures.back().wrap[0] = scene.textures.back().wrap[1] = Wrap::clamp;
    leaf.cutoff = 0.5;
    place_disk(scene, leaf, {cut_at, 2, 0}, 1);
    place_disk(scene, white, {cut_at, 1, 0}, 3);
    scene.lights.back().direction = {0, -1, 0};
    const auto at = [&](double x, double height) {
      return seen(info, scene, {cut_at + x, height, 0}, {cut_at + x, 0, 0});
    };
    CHECK(at(-0.7, 6).y == Approx(1));  // the leaf
    CHECK(at(-0.7, 6).x == Approx(0));
    CHECK(at(0.7, 6).x == Approx(1));     // the lit floor through it
    CHECK(at(-0.7, 1.5).x == Approx(0));  // its shadow
    CHECK(at(0.7, 1.5).x == Approx(1));   // no shadow
  });
}
