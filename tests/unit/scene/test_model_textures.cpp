// Textures that models of other formats bring: glTF's extensions and tangents, MTL's displacement.
#include <base/image_io.h>
#include <compile/bvh/tangents.h>
#include <compile/compiled_scene.h>
#include <models/model.h>
#include <scene/load.h>

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

/// Red, and blue that cannot be seen.
std::string clear_and_red() {
  Image two(2, 1, 4);
  two.data = {1, 0, 0, 1, 0, 0, 1, 0};
  return encode_image(two, "two.png");
}

/// The quad with a texture 0 and this material.
SceneDescription quad_with(const std::string& material, const std::string& png = two_pixels(),
                           const char* integrator = "whitted") {
  const TemporaryFolder folder;
  const std::string image = R"("images":[{"uri":"data:image/png;base64,)" + base64(png) + R"("}])";
  return load_scene(
      folder.write("a.gltf", quad(one_node + "," + image + R"(,"textures":[{"source":0}],"materials":[)" +
                                      material + "]",
                                  R"(,"material":0)")),
      {std::string("/render/integrator=") + integrator});
}

SceneDescription paths_with(const std::string& material) { return quad_with(material, two_pixels(), "path"); }

/// A quad with COLOR_0, a texture 0 and this material.
SceneDescription quad_with_colors(const std::vector<glm::vec4>& colors, const std::string& material,
                                  const char* integrator = "whitted") {
  const TemporaryFolder folder;
  std::string bytes;
  put<float>(bytes, {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0});
  for (const glm::vec4& color : colors) put<float>(bytes, {color.x, color.y, color.z, color.w});
  const auto file = folder.write(
      "a.gltf",
      document(one_node + R"(,"buffers":[{"byteLength":112,"uri":"data:application/octet-stream;base64,)" +
               base64(bytes) + R"("}],"bufferViews":[{"buffer":0,"byteLength":48},
      {"buffer":0,"byteOffset":48,"byteLength":64}],
      "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":4},
      {"bufferView":1,"componentType":5126,"type":"VEC4","count":4}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":1},"mode":6,"material":0}]}],
      "images":[{"uri":"data:image/png;base64,)" +
               base64(two_pixels()) + R"("}],"textures":[{"source":0}],"materials":[)" + material + "]"));
  return load_scene(file, {std::string("/render/integrator=") + integrator});
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
  const double left = 1 - 0.04 * 0.501;  // by a rough highlight
  CHECK(m.diffuse.x == Approx(0.5 * left * 0.96));
  CHECK(m.transmission.x == Approx(0.5 * 0.75 * 0.96 * left));
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
  const std::string material = R"({"pbrMetallicRoughness":{"roughnessFactor":0.5,
      "baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0}}})";
  const SceneDescription scene = paths_with(material);
  const MaterialTextures& to = scene.materials.at(0).textures;
  CHECK(texture_of(scene, to.roughness).channel == 1);
  CHECK(texture_of(scene, to.metalness).channel == 2);
  CHECK(texture_of(scene, to.roughness).image == texture_of(scene, to.metalness).image);
  CHECK(to.metal_rough == -1);
  const CompiledScene whitted = compile(quad_with(material));
  CHECK_FALSE(whitted.features.layers);
  CHECK(whitted.features.metal_rough);
  const CompiledScene path = compile(scene);
  CHECK(path.features.layer_maps);
  CHECK_FALSE(path.features.metal_rough);
  CHECK(path.layers[0].roughness == 0.5f);
  CHECK(path.layers[0].grid != NO_LAYER_GRID);
  CHECK(path.texel_levels.size() == whitted.texel_levels.size());
}

TEST_CASE("a glTF's transmission texture is that of OpenPBR's for integrators that follow paths") {
  const SceneDescription scene =
      paths_with(R"({"pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.2,
      "baseColorTexture":{"index":0}},"extensions":{"KHR_materials_volume":{"thicknessFactor":1},
      "KHR_materials_transmission":{"transmissionFactor":0.5,"transmissionTexture":{"index":0}}}})");
  const MaterialDescription& m = scene.materials.at(0);
  CHECK(texture_of(scene, m.textures.glass).channel == 0);
  CHECK(texture_of(scene, m.textures.diffuse).kind == TEXTURE_IMAGE);
  CHECK(m.textures.transmission == m.textures.diffuse);
  CHECK(m.layers->transmission_weight == 0.5);
  CHECK(m.transmission == dvec3(0.5));
  CHECK(compile(scene).features.layer_maps);
}

TEST_CASE("paths go through what a glTF's texture says is no metal, where its factor says metal") {
  const std::string metal = R"({"pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0}},"extensions":{
      "KHR_materials_transmission":{"transmissionFactor":0.5,"transmissionTexture":{"index":0}})",
                    volume =
                        R"(,"KHR_materials_ior":{"ior":1.7},"KHR_materials_volume":{"thicknessFactor":1})";
  const MaterialDescription plain = quad_with(metal + volume + "}}").materials.at(0);
  CHECK(plain.transmission == dvec3(0));
  CHECK(plain.medium == -1);
  const SceneDescription solid = paths_with(metal + volume + "}}");
  const MaterialDescription& m = solid.materials.at(0);
  CHECK(m.type == MaterialType::dielectric);
  CHECK(m.transmission == dvec3(0.5));
  CHECK(solid.media.at(std::size_t(m.medium)).ior == 1.7);
  CHECK(m.layers->base_metalness == 1);
  CHECK(m.layers->transmission_weight == 0.5);
  CHECK(texture_of(solid, m.textures.metalness).channel == 2);
  CHECK(texture_of(solid, m.textures.glass).channel == 0);
  const MaterialDescription pane = paths_with(metal + "}}").materials.at(0);
  CHECK(pane.medium == -1);
  CHECK(pane.wall_ior == 1.5);
}

TEST_CASE("a glTF's specular textures are those of what a layered dielectric reflects") {
  const std::string start = R"({"pbrMetallicRoughness":{"metallicFactor":0},"extensions":{)",
                    specular = R"("KHR_materials_specular":{"specularTexture":{"index":0}}}})";
  const SceneDescription whitted = quad_with(start + specular), scene = paths_with(start + specular);
  CHECK_FALSE(whitted.materials.at(0).layers);
  CHECK_FALSE(compile(whitted).features.specular_maps);
  CHECK(scene.materials.at(0).layers);
  CHECK(texture_of(scene, scene.materials[0].textures.specular).channel == 3);
  CHECK(compile(scene).features.specular_maps);
  const SceneDescription cloth =
      quad_with(start + R"("KHR_materials_sheen":{"sheenColorFactor":[1,1,1]},)" + specular);
  CHECK(cloth.materials.at(0).layers);
  CHECK(cloth.materials.at(0).textures.specular >= 0);
}

TEST_CASE("a glTF's clearcoat texture is that of the coat's weight for integrators that follow paths") {
  const std::string material = R"({"pbrMetallicRoughness":{"metallicFactor":0},
      "extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":0.5,"clearcoatTexture":{"index":0}}}})";
  const SceneDescription whitted = quad_with(material), scene = paths_with(material);
  CHECK_FALSE(whitted.materials.at(0).layers);
  CHECK_FALSE(compile(whitted).features.coat_maps);
  const MaterialDescription& m = scene.materials.at(0);
  CHECK(m.coat == 0);
  CHECK(m.layers.value().coat_weight == 0.5);
  CHECK(texture_of(scene, m.textures.coat).channel == 0);
  const CompiledScene path = compile(scene);
  CHECK(path.features.coat_maps);
  CHECK(path.layers[0].coat_grid == 0);
  CHECK(path.layers[0].coat.w == 0.5f);
}

TEST_CASE(
    "glass of a glTF keeps its clearcoat texture for integrators that follow paths, a coat of none has no "
    "use for it") {
  const auto glass = [](const std::string& factor) {
    const SceneDescription scene =
        paths_with(R"({"extensions":{"KHR_materials_transmission":{"transmissionFactor":1},
        "KHR_materials_volume":{"thicknessFactor":1},
        "KHR_materials_clearcoat":{"clearcoatTexture":{"index":0},"clearcoatFactor":)" +
                   factor +
                   "}},"
                   R"("pbrMetallicRoughness":{"metallicFactor":0}})");
    return scene.materials.at(0);
  };
  CHECK(glass("1").type == MaterialType::dielectric);
  CHECK(glass("1").textures.coat >= 0);
  CHECK(glass("0").textures.coat == -1);
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

TEST_CASE("the colour of vertices is a factor on what an unlit glTF material shows") {
  const SceneDescription scene = quad_with_colors(
      {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}},
      R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"extensions":{"KHR_materials_unlit":{}}})");
  const TextureDescription& shown = texture_of(scene, scene.materials.at(0).textures.emission);
  REQUIRE(shown.kind == TEXTURE_PRODUCT);
  CHECK(texture_of(scene, shown.of[0]).kind == TEXTURE_IMAGE);
  CHECK(texture_of(scene, shown.of[1]).kind == TEXTURE_VERTEX_COLOR);
  CHECK(scene.meshes.at(0).alphas.empty());
}

TEST_CASE("the alpha of vertices is a factor on the opacity of glTF's BLEND and MASK, and on no other") {
  const std::vector<glm::vec4> faded(4, {1, 1, 1, 0.25f});
  const char* const integrator = GENERATE("whitted", "path");
  const auto scene_of = [&](const std::string& mode) {
    return quad_with_colors(
        faded, R"({"pbrMetallicRoughness":{"metallicFactor":0,"baseColorFactor":[1,0,0,0.5]},)" + mode + "}",
        integrator);
  };
  for (const std::string mode : {"BLEND", "MASK"}) {
    const SceneDescription scene = scene_of(R"("alphaMode":")" + mode + "\"");
    const MaterialDescription& m = scene.materials.at(0);
    CHECK(m.opacity == 0.5);
    CHECK(m.cutoff == (mode == "MASK" ? 0.5 : 0));
    const TextureDescription& alpha = texture_of(scene, m.textures.opacity);
    CHECK(alpha.kind == TEXTURE_VERTEX_COLOR);
    CHECK(alpha.channel == 3);
    const CompiledScene flat = compile(scene);
    REQUIRE(flat.vertex_alphas.size() == flat.vertices.size());
    CHECK(flat.vertex_alphas[0] == 0.25f);
  }
  CHECK(scene_of(R"("alphaMode":"OPAQUE")").materials.at(0).textures.opacity == -1);
  CHECK(compile(scene_of(R"("alphaMode":"OPAQUE")")).vertex_alphas.empty());
}

TEST_CASE("the colour of vertices is a factor on what glTF's metals reflect and its panes let through") {
  const std::vector<glm::vec4> red(4, {1, 0, 0, 1});
  const MaterialTextures metal =
      quad_with_colors(red, R"({"pbrMetallicRoughness":{"roughnessFactor":0}})").materials.at(0).textures;
  CHECK(metal.reflection >= 0);
  CHECK(metal.specular >= 0);
  for (const char* const integrator : {"whitted", "path"}) {
    const SceneDescription panes = quad_with_colors(red, R"({"pbrMetallicRoughness":{"metallicFactor":0},
      "extensions":{"KHR_materials_transmission":{"transmissionFactor":1}}})",
                                                    integrator);
    const MaterialTextures& pane = panes.materials.at(0).textures;
    CHECK(texture_of(panes, pane.transmission).kind == TEXTURE_VERTEX_COLOR);
    CHECK(pane.reflection == -1);
  }
}

TEST_CASE("an image's colours count by its alpha in materials alone that take their opacity from it") {
  const std::string material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"alphaMode":)";
  const auto levels_of = [&](const std::string& materials) {
    const CompiledScene flat = compile(quad_with(materials, clear_and_red()));
    std::vector<u32> last;
    for (const TextureNode& node : flat.texture_nodes)
      if (!(node.flags & TEXTURE_ONE_CHANNEL))
        last.push_back(flat.texels0[flat.texel_levels[node.first + 1].first * TEXEL_UNIT / sizeof(u32)]);
    return last;
  };
  CHECK(levels_of(material + R"("OPAQUE"})") == std::vector<u32>{0x80BC00BC});
  CHECK(levels_of(material + R"("BLEND"})") == std::vector<u32>{0x800000FF});
}

TEST_CASE("a PNG's gamma counts in a scene's own textures, not in a glTF's") {
  Image grey(1, 1, 3);
  grey.data = {linear_from_srgb(128.f / 255), linear_from_srgb(128.f / 255), linear_from_srgb(128.f / 255)};
  std::string png = encode_image(grey, "grey.png");
  png.erase(8 + 25, png.find("IDAT") - 4 - 8 - 25);                                 // what says sRGB
  png.insert(8 + 25, std::string("\0\0\0\4gAMA\0\1\x86\xa0\x31\xe8\x96\x5f", 16));  // linear; behind IHDR
  const SceneDescription model =
      quad_with(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})", png);
  CHECK(model.images.at(0).pixels.data.at(0) == 128);
  const TemporaryFolder folder;
  folder.write("grey.png", png);
  const SceneDescription own = load_scene(folder.write("a.json", R"({"textures":{"t":{"type":"image",
      "file":"grey.png"}},"materials":{"m":{"color":"t"}},"objects":[{"type":"sphere","material":"m"}]})"));
  CHECK(own.images.at(0).pixels.data.at(0) == 188);
}

TEST_CASE("an image of a model that cannot be decoded is a warning, and its material goes without") {
  const std::string material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},
      "normalTexture":{"index":0},"emissiveFactor":[1,1,1],"emissiveTexture":{"index":0}})";
  for (const std::string& bytes : {std::string("DDS and so on"), two_pixels().substr(0, 40)}) {
    const SceneDescription scene = quad_with(material, bytes);
    REQUIRE(scene.warnings.size() == 1);
    CHECK_THAT(scene.warnings[0],
               ContainsSubstring("/images/0") && ContainsSubstring("materials go without it"));
    CHECK(scene.materials.at(0).textures.normal == -1);
    CHECK(scene.images.at(0).pixels.data == std::vector<std::uint8_t>(4, 255));
    compile(scene);
  }
  const TemporaryFolder folder;
  folder.write("x.tga", std::string(40, '\2'));
  folder.write("m.mtl", "newmtl m\nmap_Kd x.tga\nbump x.tga\ndisp -bm 1 x.tga\n");
  const SceneDescription obj =
      load_scene(folder.write("a.obj", "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  CHECK(obj.warnings.size() == 1);
  CHECK(obj.materials.at(0).displaced_by == -1);
  CHECK(obj.materials.at(0).textures.height == -1);
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
  folder.write("m.mtl", "newmtl a\ndisp -colorspace linear h.png\n");
  const SceneDescription bent = load_scene(folder / "a.obj");
  CHECK(bent.materials.at(0).displaced_by == -1);
  CHECK(bent.materials[0].textures.height >= 0);
  CHECK(bent.materials[0].bump_uv == 0.01);
}
