// Textures of scene files and models: what materials take from them, and the memory they are given.
#include <base/error.h>
#include <base/image_io.h>
#include <compile/compiled_scene.h>
#include <models/model.h>
#include <scene/load.h>

#include "catch.h"
#include "gltf_text.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

/// A folder with a picture of two pixels, red and blue, and a larger grey one.
struct Folder : TemporaryFolder {
  Folder() {
    Image two(2, 1, 3);
    two.data = {1, 0, 0, 0, 0, 1};
    write_image(two, *this / "two.png");
    Image grey(64, 32, 3);
    for (float& value : grey.data) value = 0.25f;
    write_image(grey, *this / "grey.png");
  }
  SceneDescription scene(const std::string& members, const std::vector<std::string>& overrides = {}) const {
    const auto file = *this / "scene.json";
    write("scene.json", "{" + members + R"(, "objects": [{"type": "sphere", "material": "m"}]})");
    return load_scene(file, overrides);
  }
  std::string error(const std::string& members) const {
    try {
      scene(members);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  }
};

const TextureDescription& texture_of(const SceneDescription& scene, int index) {
  return scene.textures.at(static_cast<std::size_t>(index));
}

}  // namespace

TEST_CASE("the most textures that a scene can have are named where it has more") {
  const auto scene_of = [](int count) {
    std::string textures, materials;
    for (int i = 0; i < count; ++i) {
      const std::string name = std::to_string(i), comma = i > 0 ? "," : "";
      textures += comma + "\"t" + name + "\":{\"type\":\"noise\"}";
      materials += comma + "\"m" + name + "\":{\"color\":\"t" + name + "\"}";
    }
    const TemporaryFolder folder;
    return load_scene(folder.write("scene.json", R"({"textures":{)" + textures + R"(},"materials":{)" +
                                                     materials +
                                                     R"(},"objects":[{"type":"sphere","material":"m0"}]})"));
  };
  CHECK(compile(scene_of(4096)).texture_nodes.size() == 4096);
  CHECK_THROWS_WITH(compile(scene_of(4097)), ContainsSubstring("/textures: the materials' textures take more "
                                                               "than 4096 images, patterns and colours"));
}

TEST_CASE("a material takes colours and numbers from textures by name") {
  const Folder folder;
  const SceneDescription scene = folder.scene(R"("textures": {"t": {"type": "image", "file": "two.png"}},
    "materials": {"m": {"color": "t", "ambient": 0.5, "specular": {"color": "t", "coefficient": 0.25, "exponent": "t"},
                        "reflection": "t", "emission": "t", "opacity": "t", "cutoff": 0.5}})");
  const MaterialDescription& m = scene.materials.at(0);
  CHECK(m.ambient == dvec3(0.5));
  CHECK(m.diffuse == dvec3(0.8));
  CHECK(m.specular == dvec3(0.25));
  CHECK(m.exponent == 1);
  CHECK(m.reflection == dvec3(1));
  CHECK(m.textures.diffuse == m.textures.ambient);
  CHECK(m.textures.diffuse == m.textures.emission);
  CHECK(m.textures.transmission == -1);
  // One file is two images here: as colours, sRGB, and as numbers.
  REQUIRE(scene.images.size() == 2);
  const TextureDescription& number = texture_of(scene, m.textures.opacity);
  CHECK(number.channel == 0);
  CHECK(!scene.images.at(static_cast<std::size_t>(number.image)).srgb);
  const TextureDescription& color = texture_of(scene, m.textures.diffuse);
  CHECK(color.channel == -1);
  CHECK(scene.images.at(static_cast<std::size_t>(color.image)).srgb);
  CHECK(scene.images.at(static_cast<std::size_t>(color.image)).pixels.data ==
        std::vector<std::uint8_t>{255, 0, 0, 255, 0, 0, 255, 255});
}

TEST_CASE("an image is stored once however many materials use it, and only where one does") {
  const Folder folder;
  const CompiledScene flat = compile(folder.scene(
      R"("textures": {"a": {"type": "image", "file": "grey.png"}, "b": {"type": "image", "file": "./grey.png", "wrap": "clamp"},
                      "unused": {"type": "image", "file": "two.png"}},
    "materials": {"m": {"color": "a"}, "n": {"color": "b"}, "o": {"color": "a"}})"));
  CHECK(flat.texture_nodes.size() == 2);
  CHECK(flat.texture_nodes[0].first == flat.texture_nodes[1].first);
  CHECK(flat.texel_levels.size() == 7);  // 64x32 to 1x1
  CHECK(flat.materials[0].maps != flat.materials[1].maps);
}

TEST_CASE("a scene without textures has none of their tables and features") {
  const Folder folder;
  const CompiledScene flat = compile(folder.scene(R"("materials": {"m": {}})"));
  CHECK(!flat.features.maps);
  CHECK(flat.features.texture_kinds == 0);
  CHECK(flat.texels0.empty());
  CHECK(flat.material_maps.empty());
}

TEST_CASE("a picture is scaled, turned and moved over u and v") {
  const Folder folder;
  const SceneDescription scene = folder.scene(
      R"("textures": {"t": {"type": "image", "file": "two.png", "scale": [2, 4], "rotate": 90, "offset": [0.5, 1]}},
    "materials": {"m": {"color": "t"}})");
  const glm::dmat3& uv = texture_of(scene, scene.materials[0].textures.diffuse).uv;
  // The picture's corners (0, 0) and (1, 0) lie at (0.5, 1) and, turned to the left, at (0.5, 1 + 2).
  const glm::dvec3 corner = uv * glm::dvec3(0.5, 1, 1), right = uv * glm::dvec3(0.5, 3, 1),
                   top = uv * glm::dvec3(0.5 - 4, 1, 1);
  CHECK(glm::distance(corner, glm::dvec3(0, 0, 1)) < 1e-12);
  CHECK(glm::distance(right, glm::dvec3(1, 0, 1)) < 1e-12);
  CHECK(glm::distance(top, glm::dvec3(0, 1, 1)) < 1e-12);
}

TEST_CASE("bad textures are errors with file and place") {
  const Folder folder;
  folder.write("bad.png", "\x89PNG\r\n\x1a\nno");
  const auto with = [&](const std::string& texture) {
    return folder.error(R"("textures": {"t": )" + texture + R"(}, "materials": {"m": {"color": "t"}})");
  };
  CHECK_THAT(with(R"({"type": "image", "file": "gone.png"})"),
             ContainsSubstring("/textures/t/file") && ContainsSubstring("gone.png"));
  CHECK_THAT(with(R"({"type": "image", "file": "../x.png"})"), ContainsSubstring("leads out of"));
  CHECK_THAT(with(R"({"type": "image", "file": "bad.png"})"),
             ContainsSubstring("bad.png") && ContainsSubstring("/textures/t/file"));
  CHECK_THAT(with(R"({"type": "image", "file": "two.png", "wrap": ["clamp"]})"),
             ContainsSubstring("/textures/t/wrap"));
  CHECK_THAT(with(R"({"type": "image", "file": "two.png", "scale": 0})"),
             ContainsSubstring("/textures/t/scale"));
  CHECK_THAT(folder.error(R"("materials": {"m": {"color": "t"}})"), ContainsSubstring("/materials/m/color"));
  CHECK_THAT(folder.error(R"("materials": {"m": {"type": "dielectric", "ior": 1.5, "opacity": 0.5}})"),
             ContainsSubstring("/materials/m/opacity"));
}

TEST_CASE("textures that are made of themselves are named, those inside too many others counted") {
  const auto product = [](const std::string& name, const std::string& a, const std::string& b) {
    return "\"" + name + R"(": {"type": "product", "of": [")" + a + R"(", ")" + b + "\"]}";
  };
  const Folder folder;
  const std::string end = R"(, "c": {"type": "checker"}}, "materials": {"m": {}})";
  CHECK_THAT(folder.error(R"("textures": {)" + product("a", "c", "b") + "," + product("b", "c", "a") + end),
             ContainsSubstring("/textures/a: the texture is made of itself: a of b of a"));
  std::string chain = product("t10", "c", "c");
  for (int i = 11; i < 30; ++i)
    chain += "," + product("t" + std::to_string(i), "c", "t" + std::to_string(i - 1));
  CHECK_THAT(folder.error(R"("textures": {)" + chain + end),
             ContainsSubstring("the texture is inside 15 others; wanted at most 14"));
}

TEST_CASE("a formula's pattern becomes kernel code, and what is wrong with it has its place") {
  const Folder folder;
  const auto with = [](const std::string& rest) {
    return R"("materials": {"m": {"color": "t"}}, "textures": {"t": {"type": "formula", )" + rest + "}}";
  };
  const std::string rings = R"j("formula": ["d = length(p)", "sin(turns * d)"], "parameters": {"turns": )j";
  const CompiledScene flat = compile(folder.scene(with(rings + "7}")));
  CHECK_THAT(flat.pattern_source, ContainsSubstring("static inline REAL4 pattern_0("));
  REQUIRE(flat.texture_nodes.size() == 1);
  CHECK(flat.texture_values[flat.texture_nodes[0].first] == 7);
  // Another parameter is another number in the table, for the same kernels.
  const CompiledScene other = compile(folder.scene(with(rings + "8}")));
  CHECK(other.pattern_source == flat.pattern_source);
  CHECK(other.texture_values[flat.texture_nodes[0].first] == 8);
  const auto check = [&](const std::string& rest, const std::string& place, const std::string& words) {
    const std::string found = folder.error(with(rest));
    INFO(found);
    CHECK_THAT(found, ContainsSubstring("/textures/t" + place));
    CHECK_THAT(found, ContainsSubstring(words));
  };
  check(R"("size": 1)", "", "missing key");
  check(R"j("formula": "sin(p.x")j", "/formula", "column");
  check(R"j("formula": "sin(z.x)")j", "/formula", "unknown name 'z'");
  check(R"j("formula": "quat(1, 2, 3, 4)")j", "/formula", "a number or a vec3");
  check(R"j("formula": "p.x < 1")j", "/formula", "a number or a vec3");
  check(R"j("formula": "p", "colors": [[0, 0, 0], [1, 1, 1]])j", "/colors", "only a number mixes two");
  check(R"j("formula": "1", "parameters": {"p": 1})j", "/parameters/p", "reserved");
}

TEST_CASE("images beyond the memory for textures are made smaller, with a warning each") {
  const Folder folder;
  Image large(1024, 512, 3);
  write_image(large, folder / "large.png");
  const std::string members =
      R"("textures": {"t": {"type": "image", "file": "large.png"}, "s": {"type": "image", "file": "two.png"}},
    "materials": {"m": {"color": "t", "specular": "s"}})";
  CHECK(folder.scene(members).warnings.empty());
  const SceneDescription scene = folder.scene(members, {"/render/texture_memory=1"});
  REQUIRE(scene.warnings.size() == 1);
  CHECK_THAT(scene.warnings[0], ContainsSubstring("large.png") && ContainsSubstring("1024x512 to 512x256"));
}

TEST_CASE("a glTF's base colour and emission come with their image, sampler and transform") {
  const TemporaryFolder folder;
  Image two(2, 1, 3);
  two.data = {1, 0, 0, 0, 0, 1};
  const std::string image = base64(encode_image(two, "two.png"));
  const std::string text = quad(one_node + R"(,"images":[{"uri":"data:image/png;base64,)" + image + R"("}],
      "samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728}],"textures":[{"source":0,"sampler":0}],
      "materials":[{"emissiveFactor":[1,0.5,0],"emissiveTexture":{"index":0,"texCoord":1},"alphaMode":"MASK",
      "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4}},
      "pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":
        {"KHR_texture_transform":{"offset":[0.25,0.5],"scale":[2,3]}}}}}])",
                                R"(,"material":0)");
  const SceneDescription scene = load_scene(folder.write("a.gltf", text));
  REQUIRE(scene.images.size() == 1);
  CHECK(scene.images[0].pixels.width == 2);
  const MaterialDescription& m = scene.materials.at(0);
  CHECK(m.emission == dvec3(4, 2, 0));
  CHECK(m.cutoff == 0.5);
  const TextureDescription& base = texture_of(scene, m.textures.diffuse);
  CHECK(base.wrap[0] == Wrap::clamp);
  CHECK(base.wrap[1] == Wrap::mirror);
  CHECK(base.filter == TextureFilter::nearest);
  // The file's v goes down: its point (0.1, 0.2) is (0.1, 0.8) here, and comes to (0.45, 1.1) of the image.
  const glm::dvec3 at = base.uv * glm::dvec3(0.1, 0.8, 1);
  CHECK(glm::distance(at, glm::dvec3(0.45, 1 - 1.1, 1)) < 1e-12);
  CHECK(texture_of(scene, m.textures.opacity).channel == 3);
  CHECK(texture_of(scene, m.textures.emission).uv_set == 1);
}

TEST_CASE("an MTL's maps come with their options, and a missing image is a warning") {
  const Folder folder;
  folder.write("m.mtl",
               "newmtl a\nmap_Kd -s 2 3 -o 0.5 -clamp on two.png\nmap_Ks gone.png\nKs 0 0 0\n"
               "map_d -imfchan m two.png\nKe 1 2 3\n");
  folder.write("a.obj",
               "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n");
  const SceneDescription scene = load_scene(folder / "a.obj");
  const MaterialDescription& m = scene.materials.at(0);
  CHECK(m.diffuse == dvec3(1));
  CHECK(m.emission == dvec3(1, 2, 3));
  CHECK(m.textures.specular == -1);
  const TextureDescription& color = texture_of(scene, m.textures.diffuse);
  CHECK(glm::distance(color.uv * glm::dvec3(1, 1, 1), glm::dvec3(2.5, 3, 1)) < 1e-12);
  CHECK(color.wrap[0] == Wrap::clamp);
  CHECK(texture_of(scene, m.textures.opacity).channel == 3);
  REQUIRE(scene.warnings.size() == 1);
  CHECK_THAT(scene.warnings[0], ContainsSubstring("line 3") && ContainsSubstring("gone.png is missing"));
}
