// Wavefront OBJ and MTL, from small files written here.
#include "catch.h"
#include "gltf_text.h"
#include "model_files.h"

using namespace sundog;

namespace {

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

MaterialDescription material_of(const std::string& mtl, Model* model = nullptr) {
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl m\n" + mtl);
  const Model loaded = load_model(folder.write("m.obj", "mtllib m.mtl\nusemtl m\n" + triangle));
  if (model) *model = loaded;
  REQUIRE(loaded.materials.size() == 1);
  CHECK(loaded.materials[0].name == "m");
  return loaded.materials[0];
}

}  // namespace

TEST_CASE("an OBJ's faces may count from either end and carry any mix of indices", "[models]") {
  const Model model = load_text("a.obj",
                                "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0.5 9\nvn 0 0 2\n"
                                "f 1/1/1 2/2/1 3//1\nf -4//-1 -2/2 -1\n");
  const Mesh& mesh = model.meshes.at(0);
  CHECK(mesh.source_vertex_count == 4);
  CHECK(mesh.triangles.size() == 2);
  CHECK(mesh.positions[mesh.triangles[1].z] == glm::vec3(0, 1, 0));
  CHECK(mesh.uvs[mesh.triangles[0].y] == glm::vec2(1, 0.5f));
  for (const glm::vec3& n : mesh.normals) CHECK(n == glm::vec3(0, 0, 1));
  CHECK(mesh.materials.empty());
  CHECK(model.objects.at(0).material == -1);
}

TEST_CASE("vertices shared in an OBJ stay shared where their indices agree", "[models]") {
  const Model model = load_text("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
  CHECK(model.meshes.at(0).positions.size() == 4);
}

TEST_CASE("normals smooth across an OBJ's texture seams", "[models]") {
  const Model model = load_text("a.obj",
                                "v 0 0 0\nv 1 0 .2\nv 1 1 0\nv 0 1 .2\nvt 0 0\nvt 1 1\n"
                                "f 1/1 2/1 3/1\nf 1/2 3/2 4/2\n");
  const Mesh& mesh = model.meshes.at(0);
  REQUIRE(mesh.positions.size() == 6);
  CHECK(glm::length(mesh.normals[mesh.triangles[0].x] - mesh.normals[mesh.triangles[1].x]) < 1e-6f);
}

TEST_CASE("OBJ normals of length 0 are made anew, longer ones made unit", "[models]") {
  const Mesh mesh =
      load_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nvn 0 3 4\nf 1//1 2//2 3//1\n").meshes.at(0);
  CHECK(mesh.normals[0] == glm::vec3(0, 0, 1));
  CHECK(glm::length(mesh.normals[1] - glm::vec3(0, 0.6f, 0.8f)) < 1e-6f);
}

TEST_CASE("OBJ lines may be continued, commented, end in CR or CRLF and hold tabs", "[models]") {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text = "# head\nv 0 0 0 # here\n\tv\t1 0 \\\n0\nv +0 1e0 0\n\ns off\ng x\nf 1 \\\n 2 \\\n 3";
    for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += end.size())
      text.replace(at, 1, end);
    const Model model = load_text("a.obj", text);
    CHECK(area_of(model.meshes.at(0)) == 0.5);
  }
}

TEST_CASE("OBJ vertex colours reach the mesh and its material", "[models]") {
  const Model model = load_text("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 .5 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
  CHECK(model.meshes.at(0).colors.at(1) == glm::vec3(0, 0.5f, 0));
  REQUIRE(model.materials.size() == 1);
  CHECK(model.materials[0].vertex_color);
  CHECK(model.meshes[0].materials == std::vector<int>{0});
  const Model bytes = load_text("a.obj", "v 0 0 0 255 0 0\nv 1 0 0 0 51 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
  CHECK(bytes.meshes.at(0).colors.at(0) == glm::vec3(1, 0, 0));
  CHECK(bytes.meshes.at(0).colors.at(1).y == Approx(0.033105));  // sRGB 0.2 as a linear value
}

TEST_CASE("OBJ faces of one or two corners are dropped and counted", "[models]") {
  const Model model = load_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1\nf 1 2\nf 1 2 3\nl 1 2\np 3\n");
  CHECK(model.dropped_polygons == 2);
  CHECK(model.meshes.at(0).triangles.size() == 1);
}

TEST_CASE("a model whose triangles have no area warns that it cannot be seen", "[models]") {
  CHECK(load_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 1\nf 1 2 1\n").warnings ==
        std::vector<std::string>{"1 of its 1 mesh cannot be seen: no triangle there has an area"});
  CHECK(load_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 1\nf 1 2 3\n").warnings.empty());
}

TEST_CASE("an OBJ without faces has no mesh", "[models]") {
  CHECK(load_text("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n").meshes.empty());
}

TEST_CASE("a bad OBJ is refused with its line", "[models]") {
  const auto error = [](const std::string& line) {
    return load_error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + line);
  };
  CHECK_THAT(error("f 1 2 4"), ContainsSubstring("line 4: vertex 4 does not exist: 3 are defined"));
  CHECK_THAT(error("f 0 1 2"), ContainsSubstring("line 4: vertex 0"));
  CHECK_THAT(error("f -4 1 2"), ContainsSubstring("line 4"));
  CHECK_THAT(error("vt 0 0\nf 1/2 2/1 3/1"), ContainsSubstring("line 5: texture coordinate 2"));
  CHECK_THAT(error("f 1//0 2//1 3//1"), ContainsSubstring("line 4: normal 0"));
  CHECK_THAT(error("vn 0 0 1\nf 1//2 2//1 3//1"), ContainsSubstring("line 5: normal 2"));
  CHECK_THAT(error("f 1//1 2//1 3//1\nvn 0 0 1"), ContainsSubstring("line 4: normal 1 does not exist: 0"));
  CHECK_THAT(error("f 1 2 99999999999999999999"), ContainsSubstring("line 4"));
  CHECK_THAT(error("f 1 2 x"), ContainsSubstring("line 4"));
  CHECK_THAT(error("f"), ContainsSubstring("line 4: a face without corners"));
  CHECK_THAT(error("\n\nv 1 2"), ContainsSubstring("line 6: z: a finite number wanted, found ''"));
  CHECK_THAT(error("v 1 abc 2"), ContainsSubstring("found 'abc'"));
  CHECK_THAT(error("v 1 nan 2\nf 1 2 4"), ContainsSubstring("line 5: vertex 4, of line 4, is no number"));
  CHECK_THAT(error("v 1 1e39 2"), ContainsSubstring("single precision"));
  CHECK_THAT(error("v 1 1e999 2"), ContainsSubstring("line 4"));
  CHECK_THAT(error("vn 1 2"), ContainsSubstring("line 4"));
  CHECK_THAT(load_error("a.obj", "hello\n"), ContainsSubstring("no vertices"));
  CHECK_THAT(load_error("a.obj", ""), ContainsSubstring("the file is empty"));
}

TEST_CASE("missing material libraries and materials leave a warning and the default material", "[models]") {
  const Model none = load_text("a.obj", "mtllib gone.mtl\nusemtl red\n" + triangle);
  CHECK(none.warnings.size() == 2);
  CHECK(none.meshes.at(0).materials.empty());
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl red\nKd 1 0 0\n");
  const Model some =
      load_model(folder.write("a.obj", "mtllib m.mtl\nusemtl red\n" + triangle + "usemtl blue\nf 1 2 3"));
  REQUIRE(some.materials.size() == 2);
  CHECK(some.meshes.at(0).materials == std::vector<int>{0, 1});
  CHECK(some.materials[1].name == "default");
}

TEST_CASE("material library names may hold blanks, lie in folders, and come several at once", "[models]") {
  const TemporaryFolder folder;
  folder.write("a b.mtl", "newmtl one\n");
  folder.write("sub/c.mtl", "newmtl two\n");
  folder.write("d.mtl", "newmtl three of them\n");
  const Model model = load_model(folder.write(
      "a.obj", "mtllib a b.mtl\nmtllib sub\\c.mtl d.mtl\nusemtl three of them # note\n" + triangle));
  CHECK(model.warnings.empty());
  REQUIRE(model.materials.size() == 1);
  CHECK(model.materials[0].name == "three of them");
}

TEST_CASE("files that differ in case from their names in OBJ, MTL and glTF are found, with a warning",
          "[models]") {
  const TemporaryFolder folder;
  folder.write("Sub/C.mtl", "newmtl one\nmap_Kd Textures\\RED.PNG\nmap_Ke Textures\\RED.PNG\n");
  folder.write("Sub/textures/Red.png", "x");
  folder.write("Sub/red.png", "x");
  folder.write("d.mtl", "newmtl two\n");
  const Model model = load_model(
      folder.write("a.obj", "mtllib sub/c.MTL D.MTL\nusemtl one\n" + triangle + "usemtl two\nf 1 2 3"));
  REQUIRE(model.warnings.size() == 3);
  CHECK_THAT(model.warnings[0], ContainsSubstring("'sub/c.MTL'") && ContainsSubstring("Sub/C.mtl: rename"));
  CHECK_THAT(model.warnings[1], ContainsSubstring("'D.MTL'"));
  CHECK_THAT(model.warnings[2], ContainsSubstring("Sub/textures/Red.png: rename"));
  CHECK(model.images.size() == 1);
  const Model other =
      load_model(folder.write("Sub/a.gltf", quad(R"("images":[{"uri":"RED.png"}],"textures":[{"source":0}],
        "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)" +
                                                     one_node,
                                                 R"(,"material":0)")));
  REQUIRE(other.warnings.size() == 1);
  CHECK_THAT(other.warnings[0], ContainsSubstring("RED.png"));
}

TEST_CASE("MTL colours above 1 are a warning, with the mend", "[models]") {
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl a\nKd 255 128 0\nnewmtl b\nKd 1 1 1\nKs 2 2 2\nKe 50 50 50\n");
  const Model model =
      load_model(folder.write("a.obj", "mtllib m.mtl\nusemtl a\n" + triangle + "usemtl b\nf 1 2 3"));
  REQUIRE(model.warnings.size() == 1);
  CHECK_THAT(model.warnings[0], ContainsSubstring("m.mtl: the material 'a' has Kd 255 128 0") &&
                                    ContainsSubstring("divide by 255"));
}

TEST_CASE("names of OBJ and MTL may hold '#' and quotes, and their keywords be of any case", "[models]") {
  const TemporaryFolder folder;
  folder.write("a#b c.mtl",
               "NewMtl Material #25\nKD 1 0 0\nmap_KD Map #1.png\nnewmtl Material #26\nkd 0 1 0\n");
  folder.write("Map #1.png", "x");
  for (const std::string name : {"a#b c.mtl", "\"a#b c.mtl\"", "a#b c.mtl # of the house"}) {
    CAPTURE(name);
    const Model model = load_model(
        folder.write("a.obj", "MTLLIB " + name + "\nusemtl Material #25\nV 0 0 0\nv 1 0 0 # x\nv 0 1 0#y\n" +
                                  "f 1 2 3 # a\nUseMtl Material #26\nF 1 2 3\n"));
    CHECK(model.warnings.empty());
    REQUIRE(model.materials.size() == 2);
    CHECK(model.materials[0].name == "Material #25");
    CHECK(model.materials[0].diffuse == dvec3(1, 0, 0));
    CHECK(model.materials[0].textures.diffuse >= 0);
    CHECK(model.materials[1].diffuse == dvec3(0, 1, 0));
  }
}

TEST_CASE("an MTL's images are looked for by their name in the folder, whatever stands before it",
          "[models]") {
  const TemporaryFolder folder;
  folder.write("sub/Tex.png", "x");
  folder.write("my tex.png", "x");
  for (const std::string name : {"C:\\Users\\me\\my tex.png", "/home/me/my tex.png", "\"my tex.png\"",
                                 "'D:/my tex.png'", "sub\\Tex.png", "..\\my tex.png", "my tex.png # note"}) {
    CAPTURE(name);
    folder.write("m.mtl", "newmtl m\nmap_Kd " + name + "\n");
    const Model model = load_model(folder.write("m.obj", "mtllib m.mtl\nusemtl m\n" + triangle));
    CHECK(model.warnings.empty());
    CHECK(model.images.size() == 1);
  }
}

TEST_CASE("a byte order mark before an OBJ and its MTL is skipped", "[models]") {
  const std::string mark = "\xEF\xBB\xBF";
  const TemporaryFolder folder;
  folder.write("m.mtl", mark + "newmtl m\nKd 1 0 0\n");
  const Model model = load_model(folder.write("m.obj", mark + "mtllib m.mtl\nusemtl m\n" + triangle));
  CHECK(model.materials.at(0).diffuse == dvec3(1, 0, 0));
  CHECK(load_text("a.obj", mark + triangle).meshes.at(0).positions.size() == 3);
}

TEST_CASE("what an OBJ does not use may be no number, and its normals that are none are made anew",
          "[models]") {
  for (const std::string none : {"nan", "-nan(ind)", "inf", "1.#QNAN", "-1.#IND0"}) {
    CAPTURE(none);
    const std::string three = none + " " + none + " " + none;
    const Model unused =
        load_text("a.obj", "vn " + three + "\nvt " + none + " 0\n" + triangle + "v " + three);
    CHECK(unused.warnings.empty());
    const Model used = load_text("a.obj", "vn " + three + "\nvn 0 0 1\nvt " + none +
                                              " 1\nv 0 0 0\nv 1 0 0\n" + "v 0 1 0\nf 1/1/1 2//2 3//1\n");
    const Mesh& mesh = used.meshes.at(0);
    for (const glm::vec3& n : mesh.normals) CHECK(n == glm::vec3(0, 0, 1));
    CHECK(mesh.uvs.at(0) == glm::vec2(0));
    REQUIRE(used.warnings.size() == 2);
    CHECK_THAT(used.warnings[0],
               ContainsSubstring("line 7: normals that are no numbers are made up (2 in all)"));
  }
}

TEST_CASE("an OBJ's smoothing groups say which edges are smooth, unless an angle is given", "[models]") {
  // Two quads that meet at 90 degrees.
  const auto shared_normals = [](const std::string& first, const std::string& second,
                                 std::optional<double> angle = {}) {
    const Mesh mesh = load_text("a.obj",
                                "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 -1\nv 1 1 -1\n" + first +
                                    "f 1 2 3 4\n" + second + "f 2 5 6 3\n",
                                {.crease_angle = angle})
                          .meshes.at(0);
    if (mesh.normals.empty()) return false;
    return mesh.normals[mesh.triangles[0].y] == mesh.normals[mesh.triangles[2].x];
  };
  CHECK(shared_normals("s 1\n", ""));
  CHECK(shared_normals("s 3\n", "s 3\n"));
  CHECK_FALSE(shared_normals("s 1\n", "s 2\n"));
  CHECK_FALSE(shared_normals("s off\n", ""));
  CHECK_FALSE(shared_normals("s 0\n", "s 0\n"));
  CHECK_FALSE(shared_normals("", ""));  // of 45 degrees
  CHECK_FALSE(shared_normals("s 1\n", "", 30));
  CHECK(shared_normals("s off\n", "", 100));
  CHECK(load_text("a.obj", "s off\n" + triangle).meshes.at(0).normals.empty());
}

TEST_CASE("MTL's opaque materials become phong", "[models]") {
  const MaterialDescription m =
      material_of("Ka .1 .2 .3\nKd .4 .5 .6\nKs .7\nNs 96\nillum 2\nmap_Kd none.png\n");
  CHECK(m.type == MaterialType::phong);
  CHECK(m.ambient == dvec3(.1, .2, .3));
  CHECK(m.diffuse == dvec3(.4, .5, .6));
  CHECK(m.specular == dvec3(.7));
  CHECK(m.exponent == 96);
  CHECK(m.reflection == dvec3(0));
  CHECK(m.transmission == dvec3(0));
}

TEST_CASE("MTL's illumination 0 and 1 have no highlight, nor has Ns 0, as exporters write", "[models]") {
  for (const char* dull : {"illum 0", "illum 1", "Ns 0", "Ns 0.0\nillum 2"}) {
    const MaterialDescription m = material_of(std::string("Kd .2 .2 .2\nKs .9 .9 .9\n") + dull);
    CAPTURE(dull);
    CHECK(m.diffuse == dvec3(.2));
    CHECK(m.specular == dvec3(0));
  }
  CHECK(material_of("Ks .9\nNs 0\nillum 3").reflection == dvec3(.9));
}

TEST_CASE("a material without Ka reflects ambient light in the colour of Kd", "[models]") {
  CHECK(material_of("Kd .8 0 .4").ambient == dvec3(.1, 0, .05));
  CHECK(material_of("Ks .5").ambient == MaterialDescription().ambient);
}

TEST_CASE("MTL's illumination 3 mirrors with Ks", "[models]") {
  CHECK(material_of("Ks .5 .6 2\nillum 3").reflection == dvec3(.5, .6, 1));
}

TEST_CASE("MTL's dissolve lets light straight through", "[models]") {
  for (const char* statement : {"d .25", "Tr .75", "d -halo .25"}) {
    const MaterialDescription m = material_of(std::string("Kd .8 .8 .8\n") + statement);
    CHECK(m.transmission == dvec3(.75));
    CHECK(m.diffuse == dvec3(.8) * .25);
    CHECK(m.medium == -1);
    CHECK(m.type == MaterialType::phong);
  }
}

TEST_CASE("MTL's d counts where Tr says something else, with a warning", "[models]") {
  Model model;
  CHECK(material_of("d 1\nTr 1", &model).transmission == dvec3(0));
  REQUIRE(model.warnings.size() == 1);
  CHECK_THAT(model.warnings[0], ContainsSubstring("material 'm' has d 1 and Tr 1, which differ: d counts"));
  CHECK(material_of("Tr 0.75\nd 0.25", &model).transmission == dvec3(0.75));
  CHECK(model.warnings.empty());
  CHECK(material_of("Tr 1.000000", &model).transmission == dvec3(0));  // as MeshLab writes
  REQUIRE(model.warnings.size() == 1);
  CHECK_THAT(model.warnings[0], ContainsSubstring("'m' has Tr 1 and no d: it is taken as opaque"));
}

TEST_CASE("a map without a name is left out, and images of materials that no face has are not read",
          "[models]") {
  Model model;
  CHECK(material_of("map_Kd\nmap_Bump -bm 2\n", &model).textures.diffuse == -1);
  CHECK(model.warnings.empty());
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl m\nnewmtl other\nmap_Kd gone.png\nPm 1\n");
  CHECK(load_model(folder.write("m.obj", "mtllib m.mtl\nusemtl m\n" + triangle)).warnings.empty());
}

TEST_CASE("MTL's glass with Fresnel is a dielectric with a medium, without Fresnel it is phong", "[models]") {
  Model model;
  const MaterialDescription fresnel = material_of("Kd 0 0 0\nKs 1 1 1\nTf 1 .9 .8\nNi 1.5\nillum 7", &model);
  CHECK(fresnel.type == MaterialType::dielectric);
  CHECK(fresnel.transmission == dvec3(1, .9, .8));
  CHECK(fresnel.reflection == dvec3(1));
  REQUIRE(fresnel.medium == 0);
  CHECK(model.media.at(0).ior == 1.5);
  const MaterialDescription plain = material_of("Ks .2 .2 .2\nd .1\nNi 1.3\nillum 6", &model);
  CHECK(plain.type == MaterialType::phong);
  CHECK(plain.transmission == dvec3(.9));
  CHECK(plain.reflection == dvec3(.2));
  CHECK(model.media.at(0).ior == 1.3);
}

TEST_CASE("MTL's Tf does not make a plain material transparent", "[models]") {
  CHECK(material_of("Kd 1 1 1\nTf 1 1 1\nillum 2").transmission == dvec3(0));
}

TEST_CASE("a bad MTL is refused with its own name and line", "[models]") {
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl m\nKd 1 x 1\n");
  try {
    load_model(folder.write("a.obj", "mtllib m.mtl\n" + triangle));
    FAIL("it loaded");
  } catch (const std::exception& error) {
    CHECK_THAT(error.what(), ContainsSubstring("m.mtl: line 2: green: a finite number wanted, found 'x'"));
  }
}
