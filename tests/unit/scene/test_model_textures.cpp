// Textures that models of other formats bring: glTF's extensions and tangents, MTL's displacement.
#include <base/image_io.h>
#include <compile/compiled_scene.h>
#include <compile/textures.h>
#include <scene/load.h>
#include <scene/model.h>

#include "catch.h"
#include "gltf_text.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

std::string two_pixels() {
  Image two(2, 1, 3);
  two.data = {1, 0, 0, 0, 0, 1};
  return encode_image(two, "two.png");
}

/// The quad with a texture 0 and this material.
SceneDescription quad_with(const std::string& material) {
  const TemporaryFolder folder;
  const std::string image = R"("images":[{"uri":"data:image/png;base64,)" + base64(two_pixels()) + R"("}])";
  return load_scene(folder.write(
      "a.gltf", quad(one_node + "," + image + R"(,"textures":[{"source":0}],"materials":[)" + material + "]",
                     R"(,"material":0)")));
}

const TextureDescription& texture_of(const SceneDescription& scene, int index) {
  return scene.textures.at(static_cast<std::size_t>(index));
}

}  // namespace

TEST_CASE("a glTF's transmission texture divides the light between what passes and what is returned") {
  const SceneDescription scene = quad_with(R"({"pbrMetallicRoughness":{"metallicFactor":0,
      "baseColorFactor":[0.5,1,1,1],"baseColorTexture":{"index":0}},
      "extensions":{"KHR_materials_transmission":{"transmissionFactor":0.75,"transmissionTexture":{"index":0}}}})");
  const MaterialDescription& m = scene.materials.at(0);
  CHECK(m.diffuse.x == Approx(0.5));
  CHECK(m.transmission.x == Approx(0.5 * 0.75 * 0.96));
  const TextureDescription& passing = texture_of(scene, m.textures.transmission);
  REQUIRE(passing.kind == TEXTURE_PRODUCT);
  CHECK(texture_of(scene, passing.of[0]).channel == 0);
  const TextureDescription& returned = texture_of(scene, m.textures.diffuse);
  REQUIRE(returned.kind == TEXTURE_PRODUCT);
  const TextureDescription& rest = texture_of(scene, returned.of[0]);
  CHECK(rest.factor.x == Approx(-0.75));
  CHECK(rest.offset.x == 1);
  CHECK(texture_of(scene, returned.of[1]).kind == TEXTURE_IMAGE);
  CHECK(compile(scene).features.texture_stack == 2);
  CHECK(scene.warnings.empty());
}

TEST_CASE("a glTF's specular textures are factors on the highlight of what is no metal") {
  const std::string specular =
      R"("extensions":{"KHR_materials_specular":{"specularTexture":{"index":0},"specularColorTexture":{"index":0}}}})";
  const SceneDescription scene = quad_with(R"({"pbrMetallicRoughness":{"metallicFactor":0},)" + specular);
  const TextureDescription& shine = texture_of(scene, scene.materials.at(0).textures.specular);
  REQUIRE(shine.kind == TEXTURE_PRODUCT);
  CHECK(texture_of(scene, shine.of[0]).channel == 3);
  CHECK(texture_of(scene, shine.of[1]).channel == -1);
  CHECK(scene.warnings.empty());
  CHECK(quad_with(R"({"pbrMetallicRoughness":{"metallicFactor":1},)" + specular)
            .materials.at(0)
            .textures.specular == -1);
}

TEST_CASE("a glTF's packed texture is roughness and metalness for integrators that follow paths") {
  SceneDescription scene = quad_with(R"({"pbrMetallicRoughness":{"roughnessFactor":0.5,
      "baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0}}})");
  const MaterialDescription& m = scene.materials.at(0);
  REQUIRE(m.by_paths);
  const MaterialTextures& to = m.by_paths->textures;
  CHECK(texture_of(scene, to.roughness).channel == 1);
  CHECK(texture_of(scene, to.metalness).channel == 2);
  CHECK(texture_of(scene, to.roughness).image == texture_of(scene, m.textures.metal_rough).image);
  CHECK(to.diffuse == m.textures.diffuse);
  CHECK(to.metal_rough == -1);
  const CompiledScene whitted = compile(scene);
  CHECK_FALSE(whitted.features.layers);
  CHECK(whitted.features.metal_rough);
  scene.render.integrator = "path";
  const CompiledScene path = compile(scene);
  CHECK(path.features.layer_maps);
  CHECK_FALSE(path.features.metal_rough);
  CHECK(path.layers[0].roughness == 0.5f);
  CHECK(path.layers[0].grid != NO_LAYER_GRID);
  CHECK(path.texel_levels.size() == whitted.texel_levels.size());
}

TEST_CASE("a glTF's transmission texture is that of OpenPBR's for integrators that follow paths") {
  SceneDescription scene = quad_with(R"({"pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.2,
      "baseColorTexture":{"index":0}},"extensions":{"KHR_materials_volume":{"thicknessFactor":1},
      "KHR_materials_transmission":{"transmissionFactor":0.5,"transmissionTexture":{"index":0}}}})");
  REQUIRE(scene.materials.at(0).by_paths);
  const MaterialDescription& m = *scene.materials[0].by_paths;
  CHECK(texture_of(scene, m.textures.glass).channel == 0);
  CHECK(texture_of(scene, m.textures.diffuse).kind == TEXTURE_IMAGE);
  CHECK(m.textures.transmission == m.textures.diffuse);
  CHECK(m.layers->transmission_weight == 0.5);
  CHECK(m.transmission == dvec3(0.5));
  scene.render.integrator = "path";
  CHECK(compile(scene).features.layer_maps);
}

TEST_CASE("paths go through what a glTF's texture says is no metal, where its factor says metal") {
  const std::string metal = R"({"pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0}},"extensions":{
      "KHR_materials_transmission":{"transmissionFactor":0.5,"transmissionTexture":{"index":0}})",
                    volume =
                        R"(,"KHR_materials_ior":{"ior":1.7},"KHR_materials_volume":{"thicknessFactor":1})";
  const SceneDescription solid = quad_with(metal + volume + "}}");
  CHECK(solid.materials.at(0).transmission == dvec3(0));
  CHECK(solid.materials[0].medium == -1);
  REQUIRE(solid.materials[0].by_paths);
  const MaterialDescription& m = *solid.materials[0].by_paths;
  CHECK(m.type == MaterialType::dielectric);
  CHECK(m.transmission == dvec3(0.5));
  CHECK(solid.media.at(std::size_t(m.medium)).ior == 1.7);
  CHECK(m.layers->base_metalness == 1);
  CHECK(m.layers->transmission_weight == 0.5);
  CHECK(texture_of(solid, m.textures.metalness).channel == 2);
  CHECK(texture_of(solid, m.textures.glass).channel == 0);
  const SceneDescription pane = quad_with(metal + "}}");
  REQUIRE(pane.materials.at(0).by_paths);
  CHECK(pane.materials[0].by_paths->medium == -1);
  CHECK(pane.materials[0].by_paths->wall_ior == 1.5);
}

TEST_CASE("a glTF's specular textures are those of what a layered dielectric reflects") {
  const std::string start = R"({"pbrMetallicRoughness":{"metallicFactor":0},"extensions":{)",
                    specular = R"("KHR_materials_specular":{"specularTexture":{"index":0}}}})";
  SceneDescription scene = quad_with(start + specular);
  const MaterialDescription& plain = scene.materials.at(0);
  CHECK_FALSE(plain.layers);
  REQUIRE(plain.by_paths);
  CHECK(plain.by_paths->layers);
  CHECK(texture_of(scene, plain.by_paths->textures.specular).channel == 3);
  CHECK_FALSE(compile(scene).features.specular_maps);
  scene.render.integrator = "path";
  CHECK(compile(scene).features.specular_maps);
  const SceneDescription cloth =
      quad_with(start + R"("KHR_materials_sheen":{"sheenColorFactor":[1,1,1]},)" + specular);
  CHECK(cloth.materials.at(0).layers);
  CHECK(cloth.materials.at(0).textures.specular >= 0);
}

TEST_CASE("a glTF's clearcoat texture is that of the coat's weight for integrators that follow paths") {
  SceneDescription scene = quad_with(R"({"pbrMetallicRoughness":{"metallicFactor":0},
      "extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":0.5,"clearcoatTexture":{"index":0}}}})");
  const MaterialDescription& m = scene.materials.at(0);
  CHECK_FALSE(m.layers);
  REQUIRE(m.by_paths);
  CHECK(m.by_paths->coat == 0);
  CHECK(m.by_paths->layers.value().coat_weight == 0.5);
  CHECK(texture_of(scene, m.by_paths->textures.coat).channel == 0);
  CHECK_FALSE(compile(scene).features.coat_maps);
  scene.render.integrator = "path";
  const CompiledScene path = compile(scene);
  CHECK(path.features.coat_maps);
  CHECK(path.layers[0].coat_grid == 0);
  CHECK(path.layers[0].coat.w == 0.5f);
}

TEST_CASE(
    "glass of a glTF keeps its clearcoat texture for integrators that follow paths, a coat of none has no "
    "use for it") {
  const auto by_paths = [](const std::string& factor) {
    const SceneDescription scene =
        quad_with(R"({"extensions":{"KHR_materials_transmission":{"transmissionFactor":1},
        "KHR_materials_volume":{"thicknessFactor":1},
        "KHR_materials_clearcoat":{"clearcoatTexture":{"index":0},"clearcoatFactor":)" +
                  factor +
                  "}},"
                  R"("pbrMetallicRoughness":{"metallicFactor":0}})");
    return *scene.materials.at(0).by_paths;
  };
  CHECK(by_paths("1").type == MaterialType::dielectric);
  CHECK(by_paths("1").textures.coat >= 0);
  CHECK(by_paths("0").textures.coat == -1);
}

TEST_CASE("a glTF's clearcoat texture is a factor on the mirror of its clear layer") {
  const SceneDescription scene = quad_with(R"({"pbrMetallicRoughness":{"metallicFactor":0},
      "extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":0.5,"clearcoatTexture":{"index":0}}}})");
  const MaterialDescription& m = scene.materials.at(0);
  CHECK(m.coat == Approx(0.02));
  CHECK(m.reflection == dvec3(0));
  CHECK(texture_of(scene, m.textures.coat).channel == 0);
  CHECK((compile(scene).materials[0].flags & MATERIAL_REFLECTS) != 0);
  CHECK(scene.warnings.empty());
}

TEST_CASE("a clear layer without a texture stays a number, except where textures make the terms") {
  const std::string coat = R"("extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1}}})";
  const SceneDescription plain = quad_with(R"({"pbrMetallicRoughness":{"metallicFactor":0},)" + coat);
  CHECK(plain.materials.at(0).layers.value().coat_weight == 1);
  CHECK(plain.materials.at(0).coat == 0);
  const SceneDescription scene =
      quad_with(R"({"pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0}},)" + coat);
  CHECK(scene.materials.at(0).coat == Approx(0.04));
}

TEST_CASE("a model's own tangents take the place of made ones, where there are any") {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {{0, 1, 2}};
  const std::vector<CornerTangent> made = corner_tangents(mesh);
  mesh.tangents = {{0, 3, 0, -1}, {0, 0, 0, 1}, {1, 0, 0, 1}};
  const std::vector<CornerTangent> given = corner_tangents(mesh);
  REQUIRE(given.size() == 3);
  CHECK(given[0].tangent == dvec3(0, 1, 0));
  CHECK(given[0].mirrored);
  CHECK(given[1].tangent == made[1].tangent);  // of no length
  CHECK(given[1].mirrored == made[1].mirrored);
  CHECK(given[2].tangent == dvec3(1, 0, 0));
}

TEST_CASE("a glTF's TANGENT is read with its normals, and left aside without them") {
  std::string bytes;
  put<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  put<float>(bytes, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  put<float>(bytes, {0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1});
  const auto model = [&](const std::string& attributes) {
    const TemporaryFolder folder;
    return load_model(folder.write(
        "a.gltf",
        document(
            R"("buffers":[{"byteLength":120,"uri":"data:application/octet-stream;base64,)" + base64(bytes) +
            R"("}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36},
      {"buffer":0,"byteOffset":72,"byteLength":48}],"accessors":[
      {"bufferView":0,"componentType":5126,"type":"VEC3","count":3},
      {"bufferView":1,"componentType":5126,"type":"VEC3","count":3},
      {"bufferView":2,"componentType":5126,"type":"VEC4","count":3}],
      "meshes":[{"primitives":[{"attributes":{)" +
            attributes + R"(}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0)")));
  };
  const Model with = model(R"("POSITION":0,"NORMAL":1,"TANGENT":2)");
  REQUIRE(with.meshes.at(0).tangents.size() == 3);
  CHECK(with.meshes[0].tangents[1] == glm::vec4(0, 1, 0, -1));
  CHECK(model(R"("POSITION":0,"TANGENT":2)").meshes.at(0).tangents.empty());
  CHECK_THROWS_WITH(model(R"("POSITION":0,"NORMAL":1,"TANGENT":1)"), ContainsSubstring("VEC4"));
}

TEST_CASE("an MTL's disp displaces by what -bm says, and bends normals without it") {
  const TemporaryFolder folder;
  folder.write("h.png", two_pixels());
  folder.write("a.obj",
               "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n");
  folder.write("m.mtl", "newmtl a\ndisp -bm 0.25 h.png\nmap_Ns h.png\n");
  const SceneDescription moved = load_scene(folder / "a.obj");
  CHECK(moved.materials.at(0).displacement == 0.25);
  CHECK(moved.materials[0].displaced_by >= 0);
  CHECK(moved.materials[0].textures.exponent >= 0);
  float highest = 0;
  for (const Mesh& mesh : moved.meshes)
    for (const glm::vec3& p : mesh.positions) highest = std::max(highest, std::abs(p.z));
  CHECK(highest > 0.1f);
  folder.write("m.mtl", "newmtl a\ndisp h.png\n");
  const SceneDescription bent = load_scene(folder / "a.obj");
  CHECK(bent.materials.at(0).displaced_by == -1);
  CHECK(bent.materials[0].textures.height >= 0);
  CHECK(bent.materials[0].bump_uv == 0.01);
}
