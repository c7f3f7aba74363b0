// MTL's PBR statements, as Blender writes them, against the same materials as glTF.
#include <models/model.h>

#include "base/code_names.h"
#include "base/image_io.h"
#include "catch.h"
#include "gltf_text.h"
#include "model_files.h"

using namespace sundog;

namespace {

constexpr const char* triangle = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";

Model with_mtl(const std::string& statements, const std::string& head = "# Blender 4.2.0 MTL File: 'None'\n",
               bool for_paths = true) {
  const TemporaryFolder folder;
  Image image(1, 1, 3);
  for (const char* name : {"color.png", "rough.png", "metal.png", "light.png", "normal.png"})
    folder.write(name, encode_image(image, name));
  folder.write("m.mtl", head + "newmtl m\n" + statements);
  return load_model(folder.write("a.obj", triangle), {.for_paths = for_paths});
}

Model with_gltf(const std::string& material, const std::string& more = "", bool for_paths = true) {
  return load_text("a.gltf", quad(R"("materials":[)" + material + "]," + more + one_node, R"(,"material":0)"),
                   {.for_paths = for_paths});
}

const TextureDescription& texture_of(const Model& model, int index) {
  return model.textures.at(static_cast<std::size_t>(index));
}
std::string image_of(const Model& model, int index) {
  return model.images.at(static_cast<std::size_t>(texture_of(model, index).image)).name;
}

void check_layers(const OpenPbr& a, const OpenPbr& b) {
  boost::pfr::for_each_field(a, [&]<class M>(const M& member, std::size_t index) {
    INFO(member_names<OpenPbr>[index]);
    boost::pfr::for_each_field(b, [&]<class N>(const N& other, std::size_t at) {
      if constexpr (std::is_same_v<M, N>)
        if (at == index) CHECK(member == other);
    });
  });
}

/// All but textures.
void check_same(const MaterialDescription& a, const MaterialDescription& b) {
  CHECK(a.type == b.type);
  CHECK(a.ambient == b.ambient);
  CHECK(a.diffuse == b.diffuse);
  CHECK(a.specular == b.specular);
  CHECK(a.exponent == b.exponent);
  CHECK(a.blinn == b.blinn);
  CHECK(glm::distance(a.emission, b.emission) < 1e-12);
  CHECK(a.reflection == b.reflection);
  CHECK(a.transmission == b.transmission);
  CHECK(a.roughness == b.roughness);
  CHECK(a.wall_ior == b.wall_ior);
  CHECK(a.opacity == b.opacity);
  CHECK(a.coat == b.coat);
  CHECK(a.normal_scale == b.normal_scale);
  REQUIRE(a.layers.has_value() == b.layers.has_value());
  if (a.layers) check_layers(*a.layers, *b.layers);
  REQUIRE(a.metal_rough.has_value() == b.metal_rough.has_value());
  if (a.metal_rough) {
    CHECK(a.metal_rough->base == b.metal_rough->base);
    CHECK(a.metal_rough->metalness == b.metal_rough->metalness);
    CHECK(a.metal_rough->roughness == b.metal_rough->roughness);
    CHECK(a.metal_rough->reflectance == b.metal_rough->reflectance);
  }
}

}  // namespace

TEST_CASE("Blender's OBJ with PBR extensions has the materials of its glTF", "[models]") {
  const auto [statements, material] = GENERATE(table<std::string, std::string>(
      {{"Kd 0.8 0.1 0.2\nKs 0.5 0.5 0.5\nKe 0 0 0\nNi 1.45\nd 1\nillum 2\nPr 0.4\nPm 0\nPs 0\nPc 0\nPcr "
        "0.03\n"
        "aniso 0\nanisor 0\n",
        R"({"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.1,0.2,1],"metallicFactor":0,"roughnessFactor":0.4},
           "extensions":{"KHR_materials_ior":{"ior":1.45}}})"},
       {"Kd 0.9 0.7 0.3\nKe 3 1.5 0\nNi 1.5\nd 1\nillum 3\nPr 0.25\nPm 0.5\nPs 0\nPc 1\nPcr 0.125\naniso 0\n",
        R"({"pbrMetallicRoughness":{"baseColorFactor":[0.9,0.7,0.3,1],"metallicFactor":0.5,"roughnessFactor":0.25},
           "emissiveFactor":[1,0.5,0],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":3},
           "KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatRoughnessFactor":0.125}}})"},
       {"Kd 1 1 1\nNi 1.45\nd 1\nillum 2\nPr 0.125\nPm 0\nTf 1 1 1\n",
        R"({"pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.125},"extensions":
           {"KHR_materials_ior":{"ior":1.45},"KHR_materials_transmission":{"transmissionFactor":1}}})"},
       {"Kd 0.5 0.5 0.5\nNi 1.5\nd 0.25\nillum 9\nPr 0.5\nPm 0\n",
        R"({"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,0.25],"metallicFactor":0,
           "roughnessFactor":0.5}})"},
       {"Kd 0.2 0.2 0.4\nd 1\nPr 0.5\nPs 0.75\naniso 0.5\nanisor 0.25\n",
        R"({"pbrMetallicRoughness":{"baseColorFactor":[0.2,0.2,0.4,1],"metallicFactor":0,"roughnessFactor":0.5},
           "extensions":{"KHR_materials_sheen":{"sheenColorFactor":[0.75,0.75,0.75],"sheenRoughnessFactor":0.5},
           "KHR_materials_anisotropy":{"anisotropyStrength":0.5,"anisotropyRotation":1.5707963267948966}}})"}}));
  CAPTURE(statements);
  const char* const blender = "# Blender 4.2.0 MTL File: 'None'\n";
  for (const bool for_paths : {false, true}) {
    const Model obj = with_mtl(statements, blender, for_paths), gltf = with_gltf(material, "", for_paths);
    CHECK(obj.warnings.empty());
    REQUIRE(obj.materials.size() == 1);
    check_same(obj.materials[0], gltf.materials.at(0));
  }
}

// Blender writes no number beside a texture.
TEST_CASE("textures of PBR statements stand where glTF's do", "[models]") {
  const bool for_paths = GENERATE(false, true);
  const Model obj = with_mtl(
      "Ni 1.5\nd 1\nillum 3\nmap_Kd color.png\nmap_Pr rough.png\nmap_Pm metal.png\nmap_Ke -s 2 2 2 "
      "light.png\n"
      "map_Bump -bm 0.5 normal.png\n",
      "# Blender 4.2.0 MTL File: 'None'\n", for_paths);
  const std::string png = base64(encode_image(Image(1, 1, 3), "a.png"));
  const Model gltf = with_gltf(
      R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0}},
         "emissiveFactor":[1,1,1],"emissiveTexture":{"index":0},"normalTexture":{"index":0,"scale":0.5}})",
      R"("textures":[{"source":0}],"images":[{"mimeType":"image/png","uri":"data:image/png;base64,)" + png +
          R"("}],)",
      for_paths);
  CHECK(obj.warnings.empty());
  check_same(obj.materials.at(0), gltf.materials.at(0));
  const MaterialTextures& to = obj.materials[0].textures;
  if (for_paths) {
    CHECK(image_of(obj, to.roughness) == "rough.png");
    CHECK(image_of(obj, to.metalness) == "metal.png");
  } else {
    const TextureDescription& both = texture_of(obj, to.metal_rough);
    CHECK(both.kind == TEXTURE_PRODUCT);
    CHECK(image_of(obj, both.of[0]) == "rough.png");
    CHECK(texture_of(obj, both.of[0]).factor == glm::dvec4(0, 1, 0, 0));
    CHECK(texture_of(obj, both.of[0]).offset == glm::dvec4(1, 0, 1, 1));
    CHECK(image_of(obj, both.of[1]) == "metal.png");
    CHECK(texture_of(obj, both.of[1]).factor == glm::dvec4(0, 0, 1, 0));
  }
  CHECK(image_of(obj, to.diffuse) == "color.png");
  CHECK(image_of(obj, to.emission) == "light.png");
  CHECK(texture_of(obj, to.emission).uv[0][0] == 2);
  CHECK(image_of(obj, to.normal) == "normal.png");
  CHECK(to.opacity == -1);
  for (const ImageDescription& image : obj.images)
    CHECK(image.srgb == (image.name == "color.png" || image.name == "light.png"));
}

TEST_CASE("an opacity texture of a PBR material is its own", "[models]") {
  const Model obj =
      with_mtl("Pr 0.5\nmap_Kd color.png\nmap_d -imfchan g rough.png\nd 0.5\n", "", GENERATE(false, true));
  const MaterialDescription& m = obj.materials.at(0);
  CHECK(m.opacity == 0.5);
  CHECK(image_of(obj, m.textures.opacity) == "rough.png");
  CHECK(texture_of(obj, m.textures.opacity).channel == 1);
}

TEST_CASE("zeros alone are no PBR statements; without Pr, Ns gives the roughness", "[models]") {
  CHECK_FALSE(with_mtl("Kd 1 1 1\nPr 0\nPm 0\nPs 0\n", "").materials.at(0).blinn);
  CHECK(with_mtl("Pm 1\nNs 250\n", "").materials.at(0).layers->specular_roughness == 0.5);
}

TEST_CASE("map_Bump is a normal map in Blender's files and a height map in others", "[models]") {
  CHECK(with_mtl("map_Bump -bm 1 normal.png\n").materials.at(0).textures.height == -1);
  CHECK(with_mtl("map_Bump -bm 1 normal.png\n").materials.at(0).textures.normal >= 0);
  CHECK(with_mtl("map_Bump -bm 1 normal.png\n", "").materials.at(0).textures.normal == -1);
}

TEST_CASE("colours of an OBJ's vertices are those of PBR materials too", "[models]") {
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl m\nPr 0.5\n");
  const Model obj = load_model(folder.write(
      "a.obj", "mtllib m.mtl\nv 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nusemtl m\nf 1 2 3\n"));
  CHECK(obj.materials.at(0).vertex_color);
  CHECK(obj.materials[0].layers);
}

// A grey base between matte and metal has both reflectances exactly.
TEST_CASE("specular-glossiness becomes metallic-roughness", "[models]") {
  const auto converted = [](const std::string& members) {
    const Model model =
        with_gltf(R"({"extensions":{"KHR_materials_pbrSpecularGlossiness":{)" + members + "}}}");
    CHECK(model.warnings.empty());
    return *model.materials.at(0).layers;
  };
  const OpenPbr plastic = converted(
      R"("diffuseFactor":[0.5,0.25,0.125,1],"specularFactor":[0.04,0.04,0.04],"glossinessFactor":0.75)");
  CHECK(plastic.base_metalness < 1e-9);
  CHECK(glm::distance(plastic.base_color, dvec3(0.5, 0.25, 0.125)) < 1e-9);
  CHECK(plastic.specular_roughness == 0.25);
  const OpenPbr gold = converted(R"("diffuseFactor":[0,0,0,1],"specularFactor":[1,0.75,0.25])");
  CHECK(gold.base_metalness == Approx(1));
  CHECK(glm::distance(gold.base_color, dvec3(1, 0.75, 0.25)) < 1e-9);
  CHECK(gold.specular_roughness == 0);
  const OpenPbr between = converted(R"("diffuseFactor":[0.5,0.5,0.5,1],"specularFactor":[0.25,0.25,0.25])");
  const double metal = between.base_metalness, base = between.base_color.x;
  CHECK(base * (1 - metal) * (1 - 0.04) == Approx(0.5 * (1 - 0.25)));  // diffuse
  CHECK(0.04 * (1 - metal) + base * metal == Approx(0.25));            // specular
  CHECK_THAT(load_error("a.gltf", quad(R"("materials":[{"extensions":{"KHR_materials_pbrSpecularGlossiness":
      {"glossinessFactor":2}}}],)" + one_node)),
             ContainsSubstring(
                 "/materials/0/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor"));
}

TEST_CASE("a specular-glossiness texture is the reflectance, and its alpha the smoothness", "[models]") {
  const std::string png = base64(encode_image(Image(1, 1, 4), "a.png"));
  const bool for_paths = GENERATE(false, true);
  const Model model = with_gltf(
      R"({"extensions":{"KHR_materials_pbrSpecularGlossiness":{"glossinessFactor":0.5,"diffuseTexture":{"index":0},
         "specularFactor":[0.5,0.25,0.25],"specularGlossinessTexture":{"index":0}}}})",
      R"("textures":[{"source":0}],"images":[{"mimeType":"image/png","uri":"data:image/png;base64,)" + png +
          R"("}],)",
      for_paths);
  CHECK(model.unread == std::vector<std::string>{"specular-glossiness mirrors with whitted"});
  const MaterialDescription& m = model.materials.at(0);
  if (for_paths) {
    CHECK(m.layers->base_metalness == 0);
    CHECK(std::pow((m.layers->specular_ior - 1) / (m.layers->specular_ior + 1), 2) == Approx(0.5));
    CHECK(glm::distance(m.layers->specular_color, dvec3(1, 0.5, 0.5)) < 1e-9);
    CHECK(m.layers->specular_roughness == 1);
    CHECK(m.textures.specular >= 0);
    CHECK(m.textures.metalness == -1);
  } else {
    CHECK(m.metal_rough->reflectance == Approx(0.5));
  }
  const int rough = for_paths ? m.textures.roughness : m.textures.metal_rough;
  CHECK(texture_of(model, rough).channel == 3);
  CHECK(texture_of(model, rough).factor == glm::dvec4(-0.5));
  CHECK(texture_of(model, rough).offset == glm::dvec4(1));
}
