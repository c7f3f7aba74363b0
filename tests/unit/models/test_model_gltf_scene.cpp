// The parts of a glTF that are no mesh: materials, lights, cameras.
#include <numbers>

#include "base/error.h"
#include "catch.h"
#include "gltf_text.h"
#include "model_files.h"
#include "scene/load.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

MaterialDescription material_of(const std::string& material, Model* model = nullptr, bool for_paths = false) {
  const Model loaded =
      load_text("a.gltf", quad(one_node + R"(,"materials":[)" + material + "]", R"(,"material":0)"),
                {.for_paths = for_paths});
  if (model) *model = loaded;
  REQUIRE(loaded.materials.size() == 1);
  return loaded.materials[0];
}

MaterialDescription for_paths(const std::string& material) { return material_of(material, nullptr, true); }

bool near(dvec3 a, dvec3 b) { return glm::length(a - b) < 1e-6; }

}  // namespace

TEST_CASE("metallic-roughness factors become phong coefficients", "[models]") {
  const MaterialDescription plastic = material_of(R"({"name":"p","pbrMetallicRoughness":{
    "baseColorFactor":[0.8,0.4,0.2,1],"metallicFactor":0,"roughnessFactor":0.5}})");
  CHECK(plastic.name == "p");
  // The light that (n.h)^30 returns of a white surrounding, over pi: the rest is for the diffuse term.
  const double lobe = 8.0 / 32 * (1 - std::pow(2, -16));
  CHECK(near(plastic.diffuse, (1 - 0.04 * lobe) * dvec3(0.8, 0.4, 0.2)));
  CHECK(near(plastic.specular, dvec3(0.04)));
  CHECK(plastic.exponent == Approx(30));
  CHECK(plastic.reflection == dvec3(0));
  const MaterialDescription mirror =
      material_of(R"({"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.4,0.2,1],"roughnessFactor":0}})");
  CHECK(near(mirror.reflection, {0.8, 0.4, 0.2}));
  CHECK(near(mirror.diffuse, {0, 0, 0}));
  CHECK(std::isfinite(mirror.exponent));
  const MaterialDescription rough =
      material_of(R"({"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.4,0.2,1]}})");
  CHECK(near(rough.diffuse, 0.499 * dvec3(0.8, 0.4, 0.2)));  // the highlight has the other half
  CHECK(near(rough.specular, 0.501 / (8.0 / 3 * (1 - std::pow(2, -1.5))) * dvec3(0.8, 0.4, 0.2)));
  CHECK(rough.reflection == dvec3(0));
}

TEST_CASE("sheen, iridescence, anisotropy and clearcoat become layers by OpenPBR's values", "[models]") {
  const MaterialDescription cloth = material_of(R"({"pbrMetallicRoughness":{"metallicFactor":0,
    "baseColorFactor":[0.2,0.1,0.1,1]},"extensions":{"KHR_materials_sheen":{"sheenColorFactor":[0.5,0.25,0],
    "sheenRoughnessFactor":0.4},"KHR_materials_iridescence":{"iridescenceFactor":0.5,"iridescenceThicknessMaximum":300}}})");
  const OpenPbr& fuzzy = cloth.layers.value();
  CHECK(fuzzy.fuzz_weight == 0.5);
  CHECK(near(fuzzy.fuzz_color, {1, 0.5, 0}));
  CHECK(fuzzy.fuzz_roughness == 0.4);
  CHECK(fuzzy.thin_film_weight == 0.5);
  CHECK(fuzzy.thin_film_thickness == Approx(0.3));
  CHECK(fuzzy.thin_film_ior == 1.3);
  CHECK(near(cloth.diffuse, {0.2, 0.1, 0.1}));
  CHECK(cloth.reflection == dvec3(0));
  const MaterialDescription steel =
      material_of(R"({"pbrMetallicRoughness":{"roughnessFactor":0.4},"extensions":{
    "KHR_materials_anisotropy":{"anisotropyStrength":0.6,"anisotropyRotation":1.57079632679},
    "KHR_materials_clearcoat":{"clearcoatFactor":0.7,"clearcoatRoughnessFactor":0.2}}})");
  const OpenPbr& brushed = steel.layers.value();
  const FacetWidths widths = facet_widths(brushed.specular_roughness, brushed.specular_roughness_anisotropy);
  CHECK(widths.y == Approx(0.16));
  CHECK(widths.x == Approx(0.16 + 0.84 * 0.36));
  CHECK(brushed.geometry_tangent == Approx(90));
  CHECK(brushed.coat_weight == 0.7);
  CHECK(brushed.coat_roughness == 0.2);
  CHECK(brushed.coat_ior == 1.5);
  CHECK_FALSE(material_of(R"({"extensions":{"KHR_materials_unlit":{},"KHR_materials_sheen":{}}})").layers);
}

TEST_CASE("integrators that follow paths have metallic-roughness materials as OpenPBR's", "[models]") {
  const std::string grey = R"({"pbrMetallicRoughness":{"metallicFactor":0.5,
    "roughnessFactor":0.4,"baseColorFactor":[0.2,0.4,0.6,1]},"emissiveFactor":[0,1,0],
    "extensions":{"KHR_materials_ior":{"ior":1.7}}})";
  CHECK_FALSE(material_of(grey).layers);
  const MaterialDescription m = for_paths(grey);
  const OpenPbr& values = m.layers.value();
  CHECK(near(values.base_color, {0.2, 0.4, 0.6}));
  CHECK(values.base_metalness == 0.5);
  CHECK(values.specular_roughness == 0.4);
  CHECK(values.specular_ior == 1.7);
  CHECK(near(m.diffuse, {0.2, 0.4, 0.6}));
  CHECK(near(m.specular, dvec3(0)));
  CHECK(near(m.emission, {0, 1, 0}));
  CHECK_FALSE(for_paths(R"({"extensions":{"KHR_materials_unlit":{}}})").layers);
}

TEST_CASE("KHR_materials_specular leaves metals alone", "[models]") {
  const auto values_of = [](const std::string& metalness) {
    return *for_paths(R"({"pbrMetallicRoughness":{"metallicFactor":)" + metalness +
                      R"(},"extensions":{"KHR_materials_specular":{"specularFactor":0.25,
      "specularColorFactor":[2,1,0]}}})")
                .layers;
  };
  CHECK(values_of("0").specular_weight == 0.5);
  CHECK(near(values_of("0").specular_color, {1, 0.5, 0}));
  CHECK(values_of("1").specular_weight == 1);
  CHECK(values_of("1").specular_color == dvec3(1));
  const OpenPbr half = values_of("0.5");
  CHECK(half.specular_weight == 1);
  const double root = (half.specular_ior - 1) / (half.specular_ior + 1);
  CHECK(root * root == Approx(0.5 * 0.04));
}

TEST_CASE("glass of a glTF is as rough as it says for integrators that follow paths", "[models]") {
  const MaterialDescription frosted = for_paths(R"({"pbrMetallicRoughness":{"metallicFactor":0,
    "roughnessFactor":0.5,"baseColorFactor":[0.5,1,1,1]},"extensions":{
    "KHR_materials_transmission":{"transmissionFactor":0.8},"KHR_materials_volume":{"thicknessFactor":1}}})");
  CHECK(frosted.type == MaterialType::dielectric);
  CHECK(frosted.medium == 0);
  CHECK(frosted.roughness == 0.5);
  CHECK(frosted.reflection == dvec3(0.8));
  CHECK(near(frosted.transmission, {0.4, 0.8, 0.8}));
}

TEST_CASE("a pane of a glTF is a thin wall for integrators that follow paths, others have fixed shares",
          "[models]") {
  const auto pane = [](const std::string& roughness, const std::string& more = "",
                       const std::string& alpha = "") {
    return R"({"pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":)" + roughness +
           R"(,"baseColorFactor":[0.5,1,1,1]})" + alpha + R"(,"extensions":{"KHR_materials_ior":{"ior":1.4},
           "KHR_materials_transmission":{"transmissionFactor":0.8})" +
           more + "}}";
  };
  const char* const sheen = R"(,"KHR_materials_sheen":{"sheenColorFactor":[0.2,0.2,0.2]})";
  for (const auto& [roughness, more] : {std::pair{"0", ""}, {"0.5", ""}, {"0", sheen}, {"0.5", sheen}}) {
    const std::string text = pane(roughness, more);
    const MaterialDescription made = material_of(text), wall = for_paths(text);
    CHECK(wall.type == MaterialType::dielectric);
    CHECK(wall.medium == -1);
    CHECK(wall.wall_ior == 1.4);
    CHECK(wall.roughness == std::stod(roughness));
    CHECK(wall.reflection == dvec3(0.8));
    CHECK(near(wall.transmission, {0.4, 0.8, 0.8}));
    CHECK(wall.layers->geometry_thin_walled);
    CHECK(made.type == MaterialType::phong);
    CHECK(made.wall_ior == 0);
    CHECK(made.transmission.y == Approx(0.8 * (1 - 0.4 * 0.4 / (2.4 * 2.4))).epsilon(0.01));
  }
  for (const std::string& other :
       {pane("0", "", R"(,"alphaMode":"BLEND")"), pane("0.5", "", R"(,"alphaMode":"MASK")"),
        pane("0.5", R"(,"KHR_materials_volume":{"thicknessFactor":1})")}) {
    CHECK(for_paths(other).wall_ior == 0);
  }
  const MaterialDescription blended = for_paths(pane("0", "", R"(,"alphaMode":"BLEND")"));
  CHECK(blended.type == MaterialType::phong);
  CHECK(blended.reflection.x == Approx(0.8 * 0.4 * 0.4 / (2.4 * 2.4)));
}

TEST_CASE("opacity of a glTF is the same for integrators that follow paths", "[models]") {
  const std::string pbr = R"({"pbrMetallicRoughness":{"metallicFactor":0,"baseColorFactor":[1,1,1,0.25]})";
  const MaterialDescription blended = for_paths(pbr + R"(,"alphaMode":"BLEND"})");
  CHECK(blended.opacity == 0.25);
  CHECK(blended.transmission == dvec3(0));
  CHECK(blended.diffuse == dvec3(1));
}

TEST_CASE("transmission with a volume is a dielectric with an absorbing medium, without one a thin pane",
          "[models]") {
  Model model;
  const std::string glass = R"({"pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0},"extensions":{
    "KHR_materials_transmission":{"transmissionFactor":1},"KHR_materials_ior":{"ior":1.33})";
  const MaterialDescription solid = material_of(
      glass +
          R"(,"KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":2,"attenuationColor":[0.5,1,0]}}})",
      &model);
  CHECK(solid.type == MaterialType::dielectric);
  CHECK(solid.transmission == dvec3(1));
  CHECK(solid.diffuse == dvec3(0));
  REQUIRE(solid.medium == 0);
  CHECK(model.media.at(0).ior == 1.33);
  CHECK(model.media[0].absorption.x == Approx(std::log(2.0) / 2));
  CHECK(model.media[0].absorption.y == 0);
  CHECK(std::isfinite(model.media[0].absorption.z));
  for (const char* volume : {"}}", R"(,"KHR_materials_volume":{"thicknessFactor":0}}})"}) {
    const MaterialDescription thin = material_of(glass + volume, &model);
    CHECK(thin.medium == -1);
    CHECK(model.media.empty());
    CHECK(thin.transmission.x == Approx(1 - 0.020059));
    CHECK(thin.reflection.x == Approx(0.020059).epsilon(1e-4));
  }
}

TEST_CASE("Dispersion: KHR_materials_dispersion is 20 over Abbe's number", "[models]") {
  const auto medium_of = [](const std::string& dispersion) {
    Model model;
    material_of(R"({"pbrMetallicRoughness":{"metallicFactor":0},"extensions":{
      "KHR_materials_transmission":{"transmissionFactor":1},"KHR_materials_ior":{"ior":1.6},
      "KHR_materials_volume":{"thicknessFactor":1},"KHR_materials_dispersion":)" +
                    dispersion + "}}",
                &model);
    CHECK(model.warnings.empty());
    return model.media.at(0);
  };
  const MediumDescription medium = medium_of(R"({"dispersion":0.5})");
  const auto index = [&](double wavelength) { return index_at(medium.dispersion, medium.ior, wavelength); };
  CHECK(index(line_d) == Approx(1.6));
  CHECK((index(line_d) - 1) / (index(line_F) - index(line_C)) == Approx(40));
  CHECK(medium_of("{}").dispersion.kind == DispersionKind::none);
  CHECK(medium_of(R"({"dispersion":0})").dispersion.kind == DispersionKind::none);
  // Beyond what any substance does, the index stays above 1.
  const MediumDescription wild = medium_of(R"({"dispersion":1e9})");
  CHECK(index_at(wild.dispersion, wild.ior, 780) > 1);
}

TEST_CASE("emission that no float has is refused", "[models]") {
  const auto shining = [](const std::string& strength) {
    return material_of(
        R"({"emissiveFactor":[1,1,1],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":)" +
        strength + "}}}");
  };
  CHECK(shining("1e6").emission.x == Approx(1e6));
  CHECK_THROWS_AS(shining("1e39"), SceneError);
}

TEST_CASE("a metal transmits nothing, whatever its transmission factor", "[models]") {
  const MaterialDescription metal =
      material_of(R"({"extensions":{"KHR_materials_transmission":{"transmissionFactor":1}}})");
  CHECK(metal.transmission == dvec3(0));
  CHECK(near(metal.diffuse, dvec3(0.499)));
}

TEST_CASE("alpha lets light straight through when blended or masked, and is left aside when opaque",
          "[models]") {
  const std::string pbr = R"({"pbrMetallicRoughness":{"metallicFactor":0,"baseColorFactor":[1,1,1,0.25]})";
  CHECK(material_of(pbr + R"(,"alphaMode":"BLEND"})").transmission == dvec3(0.75));
  CHECK(near(material_of(pbr + R"(,"alphaMode":"BLEND"})").diffuse, dvec3(0.25 * (1 - 0.04 * 0.501))));
  CHECK(material_of(pbr + R"(,"alphaMode":"MASK"})").transmission == dvec3(1));
  CHECK(material_of(pbr + R"(,"alphaMode":"MASK","alphaCutoff":0.2})").transmission == dvec3(0));
  CHECK(material_of(pbr + "}").transmission == dvec3(0));
}

TEST_CASE("glTF's lights come with their node's place and direction, in sundog's units", "[models]") {
  const Model model = load_text("a.gltf", document(R"("extensions":{"KHR_lights_punctual":{"lights":[
    {"type":"directional","intensity":3,"color":[1,0.5,0]},{"type":"point","intensity":40,"range":7},
    {"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.2}}]}},"nodes":[
    {"rotation":[-0.70710678,0,0,0.70710678],"extensions":{"KHR_lights_punctual":{"light":0}}},
    {"translation":[1,2,3],"extensions":{"KHR_lights_punctual":{"light":1}}},
    {"scale":[3,3,3],"extensions":{"KHR_lights_punctual":{"light":2}}}])"));
  REQUIRE(model.lights.size() == 3);
  CHECK(model.lights[0].type == LightType::directional);
  CHECK(near(model.lights[0].direction, {0, -1, 0}));
  CHECK(model.lights[0].color == dvec3(1, 0.5, 0));
  CHECK(model.lights[0].intensity == Approx(3 / std::numbers::pi));
  CHECK(model.lights[0].falloff == dvec3(1, 0, 0));
  CHECK(model.lights[1].type == LightType::point);
  CHECK(model.lights[1].position == dvec3(1, 2, 3));
  CHECK(model.lights[1].falloff == dvec3(0, 0, 1));
  CHECK(model.lights[1].range == 7);
  CHECK(model.lights[2].range == 0);
  CHECK(model.lights[2].square_edge);
  CHECK(model.lights[2].type == LightType::spot);
  CHECK(near(model.lights[2].direction, {0, 0, -1}));
  CHECK(model.lights[2].inner_angle == Approx(glm::degrees(0.1)));
  CHECK(model.lights[2].outer_angle == Approx(glm::degrees(0.2)));
}

TEST_CASE("the first camera of a glTF's scene that can be one is the model's", "[models]") {
  const Model model = load_text("a.gltf", document(R"("cameras":[
    {"type":"orthographic","orthographic":{"xmag":1e-30,"ymag":1e-30,"znear":0,"zfar":9}},
    {"type":"perspective","perspective":{"yfov":1,"znear":0.5}},{"type":"perspective","perspective":{"yfov":2,"znear":1}}],
    "nodes":[{"camera":0},{"camera":1,"translation":[1,2,3],"rotation":[0,0.70710678,0,0.70710678]},{"camera":2}])"));
  REQUIRE(model.camera);
  CHECK(model.camera->fov == Approx(glm::degrees(1.0)));
  CHECK(model.camera->near == 0.5);
  CHECK(std::isinf(model.camera->far));
  CHECK(model.camera->position == dvec3(1, 2, 3));
  CHECK(near(model.camera->target, {0, 2, 3}));
  CHECK(near(model.camera->up, {0, 1, 0}));
  CHECK(model.warnings.size() == 1);
}

TEST_CASE("an orthographic camera of a glTF shows twice its ymag", "[models]") {
  const TemporaryFolder folder;
  const auto file = folder.write("a.gltf", quad(R"("cameras":[
    {"type":"orthographic","orthographic":{"xmag":3,"ymag":-2,"znear":0,"zfar":9}}],
    "nodes":[{"mesh":0},{"camera":0,"translation":[1,2,3]}])"));
  CHECK(load_model(file).warnings == std::vector<std::string>{});
  const Camera camera = load_scene(file).camera;
  CHECK(camera.orthographic == 4);
  CHECK(camera.position == dvec3(1, 2, 3));
  CHECK(camera.far == 9);
}

TEST_CASE("the picture of a glTF has its camera's proportions, unless a size is given") {
  const TemporaryFolder folder;
  const auto size = [&](const std::string& camera, const std::vector<std::string>& settings = {}) {
    const auto file = folder.write("a.gltf", quad(R"("cameras":[{)" + camera + R"(}],"nodes":[{"mesh":0},
      {"camera":0,"translation":[0,0,9]}])"));
    const ImageSettings image = load_scene(file, settings).image;
    return std::pair(image.width, image.height);
  };
  const auto perspective = [](const std::string& aspect) {
    return R"("type":"perspective","perspective":{"yfov":1,"znear":0.5)" + aspect + "}";
  };
  const std::string wide = perspective(R"(,"aspectRatio":1.7777777)");
  CHECK(size(perspective("")) == std::pair(640, 480));
  CHECK(size(wide) == std::pair(640, 360));
  CHECK(size(perspective(R"(,"aspectRatio":0.5)")) == std::pair(320, 640));
  CHECK(size(perspective(R"(,"aspectRatio":1e9)")) == std::pair(640, 1));
  CHECK(size(R"("type":"orthographic","orthographic":{"xmag":-2,"ymag":1,"znear":0,"zfar":9})") ==
        std::pair(640, 320));
  CHECK(size(wide, {"/image/width=100", "/image/height=90"}) == std::pair(100, 90));
}
