// One warning reports the parts of a model file that are not read.
#include <models/model.h>

#include "catch.h"
#include "gltf_text.h"
#include "model_files.h"

using namespace sundog;
using Features = std::vector<std::string>;

TEST_CASE("a glTF's unread features are one warning, each named once", "[models]") {
  const std::string material = R"({"alphaMode":"BLEND","emissiveFactor":[0,0.5,0],
    "pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0}},
    "normalTexture":{"index":0},"extensions":{"KHR_materials_sheen":{"sheenColorTexture":{"index":0}},
    "KHR_materials_ior":{"ior":1.4},"VENDOR_glow":{}}})";
  const Model model =
      load_text("a.gltf", quad(R"("materials":[)" + material + "," + material +
                               R"(],"textures":[{}],"skins":[{"joints":[0]}],"animations":[{}],
                     "nodes":[{"mesh":0,"skin":0},{"mesh":0,"skin":0}])"));
  CHECK(model.unread == Features{"sheen with whitted", "VENDOR_glow"});
  REQUIRE(model.warnings.size() == 1);
  CHECK(model.warnings[0].starts_with("read without its "));
}

TEST_CASE("a glTF that uses what is read alone is without a warning", "[models]") {
  const Model model = load_text("a.gltf", quad(R"("materials":[{"alphaMode":"BLEND","emissiveFactor":[0,0,0],
    "pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]},"extensions":{"KHR_materials_ior":{"ior":1.4}}}],)" +
                                               one_node));
  CHECK(model.warnings == Features{});
}

TEST_CASE("malformed parts that the picture does not use are passed by", "[models]") {
  const Model model = load_text("a.gltf", quad(R"("materials":[{"extras":{"xTexture":{}},"xTexture":3}],
      "animations":7,)" + one_node));
  CHECK(model.unread == Features{});
}

TEST_CASE("what an OBJ and its materials have and is not read is one warning", "[models]") {
  const TemporaryFolder folder;
  folder.write("m.mtl",
               "newmtl a\nKd 1 1 1\nmap_Kd a.png\nmap_Bump -bm 1 b.png\nKe 0 0 0\nPs 0\n"
               "newmtl b\nmap_Kd c.png\nKe 1 0 0\nrefl r.png\nKs xyz 0.4 0.2 0.1\n");
  const Model model = load_model(folder.write(
      "a.obj",
      "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nl 1 2\np 1\n"));
  CHECK(model.unread == Features{"spectral and CIE XYZ colours", "reflection maps", "lines", "points"});
  REQUIRE(model.warnings.size() == 4);
  CHECK_THAT(model.warnings[0], ContainsSubstring("a.png is missing"));
  CHECK(model.warnings[3] ==
        "read without its spectral and CIE XYZ colours, reflection maps, lines and points");
}

TEST_CASE("attributes of vertices that are not used are named once", "[models]") {
  CHECK(load_text("a.gltf",
                  document(quad_buffer() + "," + quad_views +
                           R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":1,"COLOR_1":2,"JOINTS_1":2,
                  "TEXCOORD_4":2,"_OWN":2},"indices":0}]}],)" +
                           one_node))
            .unread == Features{"joints of vertices beyond four", "second colours of vertices"});
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar alpha\nelement face 1\n"
      "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n";
  CHECK(load_text("a.ply", head + "0 0 0 255\n1 0 0 128\n0 1 0 255\n3 0 1 2 6 0 0 1 0 0 1\n").unread ==
        Features{"alpha of vertices"});
}

TEST_CASE("a glTF may require extensions that do not change its picture", "[models]") {
  for (const std::string name :
       {"KHR_xmp_json_ld", "EXT_structural_metadata", "MSFT_lod", "KHR_node_selectability"}) {
    const std::string list = R"(["KHR_xmp_json_ld",")" + name + R"("],)";
    const Model model = load_text(
        "a.gltf", quad(R"("extensionsUsed":)" + list + R"("extensionsRequired":)" + list + one_node));
    CHECK(model.unread == Features{});
  }
}

TEST_CASE("a glTF's textures with a fifth set of coordinates are left out, and the rest is drawn",
          "[models]") {
  const Model model = load_text(
      "a.gltf",
      quad(R"("images":[{"uri":"data:image/png;base64,AAAA"}],"textures":[{"source":0}],"materials":[
      {"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":4}},
       "normalTexture":{"index":0,"extensions":{"KHR_texture_transform":{"texCoord":3}}}}],)" +
               one_node,
           R"(,"material":0)"));
  CHECK(model.unread == Features{"textures with coordinates beyond four sets"});
  CHECK(model.materials.at(0).textures.diffuse == -1);
  CHECK(model.textures.at(static_cast<std::size_t>(model.materials[0].textures.normal)).uv_set == 3);
}

TEST_CASE("materials that are not defined are one warning", "[models]") {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 1; i <= 7; ++i) text += "usemtl m" + std::to_string(i) + "\nf 1 2 3\n";
  CHECK(
      load_text("a.obj", text).warnings ==
      Features{"not defined, and drawn with the default material: 'm1', 'm2', 'm3', 'm4', 'm5' and 2 more"});
}
