// glTF's animations over the frames of a scene.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "catch.h"
#include "gltf_text.h"
#include "model_files.h"
#include "scene/load.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

struct Channel {
  int node;
  std::string path, between;
  std::vector<float> times, values;
};

/// A glTF of the quad, with nodes and animations, each a list of channels.
std::string animated(const std::string& nodes, const std::vector<std::vector<Channel>>& animations) {
  std::string bytes, views, accessors, list;
  const auto accessor = [&](const std::vector<float>& numbers, const char* type, std::size_t components) {
    if (!views.empty()) views += ",", accessors += ",";
    views +=
        fmt::format(R"({{"buffer":1,"byteOffset":{},"byteLength":{}}})", bytes.size(), 4 * numbers.size());
    const auto index = static_cast<int>(std::ranges::count(accessors, '{'));
    accessors += fmt::format(R"({{"bufferView":{},"componentType":5126,"type":"{}","count":{}}})", 3 + index,
                             type, numbers.size() / components);
    for (const float number : numbers) put<float>(bytes, {number});
    return 3 + index;
  };
  for (const auto& channels : animations) {
    std::string samplers, targets;
    int at = 0;
    for (const Channel& channel : channels) {
      const bool turns = channel.path == "rotation";
      const int input = accessor(channel.times, "SCALAR", 1);
      const int output = accessor(channel.values, turns ? "VEC4" : "VEC3", turns ? 4 : 3);
      samplers += fmt::format(R"({}{{"input":{},"output":{},"interpolation":"{}"}})", at ? "," : "", input,
                              output, channel.between);
      targets += fmt::format(R"({}{{"sampler":{},"target":{{"node":{},"path":"{}"}}}})", at ? "," : "", at,
                             channel.node, channel.path);
      ++at;
    }
    list += fmt::format(R"({}{{"name":"clip {}","samplers":[{}],"channels":[{}]}})", list.empty() ? "" : ",",
                        list.empty() ? 'a' : 'b', samplers, targets);
  }
  std::string text = quad(nodes + R"(,"animations":[)" + list + "]");
  const auto add = [&](const std::string& before, const std::string& more) {
    const std::size_t at = text.find(before);
    REQUIRE(at != std::string::npos);
    text.insert(at + before.size(), more);
  };
  add(R"("byteOffset":56,"byteLength":16,"byteStride":4})", "," + views);
  add(R"("normalized":true,"type":"VEC3","count":4})", "," + accessors);
  add(R"("buffers":[)", fmt::format(R"({{"byteLength":{},"uri":"data:application/octet-stream;base64,{}"}},)",
                                    bytes.size(), base64(bytes)));
  for (std::size_t at = 0; (at = text.find(R"("buffer":)", at)) != std::string::npos; ++at)
    text[at + 9] = text[at + 9] == '0' ? '1' : '0';  // the quad's buffer is the second now
  return text;
}

const std::string node = R"("nodes":[{"mesh":0}])";

struct Played {
  explicit Played(const std::string& text) : file(folder.write("a.gltf", text)) {}
  SceneDescription at(std::optional<double> frame, const std::vector<std::string>& settings = {}) const {
    return load_scene(file, settings, {.frame = frame});
  }
  dmat4 place(double frame, const std::vector<std::string>& settings = {}) const {
    return at(frame, settings).objects[0].world_from_object;
  }
  TemporaryFolder folder;
  std::filesystem::path file;
};

bool near(const dvec3& a, const dvec3& b) { return glm::distance(a, b) < 1e-6; }

Channel slide(float to = 4, int node_index = 0) {
  return {node_index, "translation", "LINEAR", {0, 1}, {0, 0, 0, to, 0, 0}};
}

}  // namespace

TEST_CASE("a glTF's nodes move with the frames, 24 a second or as many as the scene says", "[models]") {
  const Played linear(animated(node, {{slide()}}));
  CHECK(near(linear.place(6)[3], {1, 0, 0}));
  CHECK(near(linear.place(24)[3], {4, 0, 0}));
  CHECK(near(linear.place(99)[3], {4, 0, 0}));
  CHECK(near(linear.place(6, {"/frames_per_second=12"})[3], {2, 0, 0}));
  CHECK(near(linear.at(std::nullopt).objects[0].world_from_object[3], {0, 0, 0}));
  const Played steps(animated(node, {{{0, "scale", "STEP", {0, 1}, {1, 1, 1, 2, 2, 2}}}}));
  CHECK(steps.place(23)[0].x == 1);
  CHECK(steps.place(24)[0].x == 2);
  // Hermite: at half the way the mean of the values and an eighth of the slopes' difference times the length.
  const Played curve(animated(
      node,
      {{{0, "translation", "CUBICSPLINE", {0, 2}, {9, 9, 9, 0, 0, 0, 8, 0, 0, 0, 4, 0, 6, 0, 0, 9, 9, 9}}}}));
  CHECK(near(curve.place(24)[3], {3 + 2.0 / 8 * 8, -2.0 / 8 * 4, 0}));
}

TEST_CASE("a glTF's rotations take the short way", "[models]") {
  // From 0 to 270 degrees about y: half the way is -45 degrees.
  const float h = std::sqrt(0.5f);
  const Played turn(animated(node, {{{0, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, h, 0, -h}}}}));
  CHECK(near(dvec3(turn.place(12)[0]), dvec3(std::sqrt(0.5), 0, std::sqrt(0.5))));
  CHECK(near(dvec3(turn.place(24)[0]), dvec3(0, 0, 1)));
}

TEST_CASE("a glTF's camera, lights and children follow their nodes", "[models]") {
  const Played scene(animated(R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],
    "extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}},
    "nodes":[{"children":[1,2,3]},{"mesh":0,"translation":[0,0,-9]},{"camera":0},
             {"extensions":{"KHR_lights_punctual":{"light":0}},"translation":[0,5,0]}])",
                              {{slide()}}));
  const SceneDescription half = scene.at(12);
  CHECK(near(half.camera.position, {2, 0, 0}));
  CHECK(near(half.camera.target, {2, 0, -1}));
  CHECK(near(half.lights[0].position, {2, 5, 0}));
  CHECK(near(half.objects[0].world_from_object[3], {2, 0, -9}));
  CHECK(scene.at(12, {"/camera/fov=20"}).camera.fov == 20);
}

TEST_CASE("animations of a glTF play together or one by its name, once or as a cycle", "[models]") {
  const Played two(animated(R"("nodes":[{"mesh":0},{"mesh":0}])", {{slide(4)}, {slide(8, 1), slide(8, 0)}}));
  const auto x = [&](double frame, const std::vector<std::string>& settings, std::size_t object) {
    return two.at(frame, settings).objects[object].world_from_object[3].x;
  };
  CHECK(x(12, {}, 0) == Approx(2));  // the first animation of the file counts
  CHECK(x(12, {}, 1) == Approx(4));
  CHECK(two.at(12).warnings.size() == 1);
  CHECK(x(12, {R"(/objects/0/animation="clip b")"}, 0) == Approx(4));
  CHECK(x(12, {R"(/objects/0/animation="clip a")"}, 1) == Approx(0));
  CHECK(x(30, {}, 0) == Approx(4));
  CHECK(x(30, {"/objects/0/cycle=true"}, 0) == Approx(1));
  try {
    two.at(0, {R"(/objects/0/animation="clip c")"});
    FAIL("no error");
  } catch (const SceneError& error) {
    CHECK(error.place == "/objects/0/animation");
    CHECK_THAT(error.reason, ContainsSubstring("clip a, clip b"));
  }
}

TEST_CASE("a skin follows its joints from frame to frame", "[models]") {
  std::string bytes;
  put<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0});                  // positions
  put<float>(bytes, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});         // weights
  put<float>(bytes, {0, 1, 0, 0, 0, 4, 0, 0});                     // times, translations
  put<std::uint8_t>(bytes, {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0});  // joints: the second corner's moves
  const Played scene(document(R"("buffers":[{"byteLength":128,"uri":"data:application/octet-stream;base64,)" +
                              base64(bytes) + R"("}],
    "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":48},
    {"buffer":0,"byteOffset":84,"byteLength":32},{"buffer":0,"byteOffset":116,"byteLength":12}],
    "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3},
    {"bufferView":1,"componentType":5126,"type":"VEC4","count":3},
    {"bufferView":3,"componentType":5121,"type":"VEC4","count":3},
    {"bufferView":2,"componentType":5126,"type":"SCALAR","count":2},
    {"bufferView":2,"byteOffset":8,"componentType":5126,"type":"VEC3","count":2}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0,"WEIGHTS_0":1,"JOINTS_0":2}}]}],
    "skins":[{"joints":[1,2]}],"nodes":[{"mesh":0,"skin":0},{},{}],
    "animations":[{"samplers":[{"input":3,"output":4}],
    "channels":[{"sampler":0,"target":{"node":2,"path":"translation"}}]}])"));
  SceneFrames frames(scene.file, {}, {});
  for (const double frame : {24.0, 0.0, 12.0}) {
    const Mesh& mesh = frames.read(frame)->meshes.at(0);
    CHECK(mesh.positions.at(0) == glm::vec3(0, 0, 0));
    CHECK(mesh.positions.at(1) == glm::vec3(1 + frame / 6, 0, 0));
  }
}

/// A triangle in z = 0 with two morph targets, which lift its second corner by 1 and move its third by (2, 0,
/// 0) and turn that one's normal; three keys of weights at 0, 1 and 2 seconds in accessor 5. `mesh` follows
/// the mesh's primitives, `rest` the meshes.
std::string morphing(const std::string& mesh, const std::string& rest) {
  std::string bytes;
  put<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0});  // positions
  put<float>(bytes, {0, 0, 1, 0, 0, 1, 0, 0, 1});  // normals
  put<float>(bytes, {0, 0, 0, 0, 0, 1, 0, 0, 0});  // the first target
  put<float>(bytes, {0, 0, 0, 0, 0, 0, 2, 0, 0});  // the second, and its normals
  put<float>(bytes, {0, 0, 0, 0, 0, 0, 1, 0, -1});
  put<float>(bytes, {0, 1, 2, 0, 0, 1, 0.5f, 0, 1});  // times, weights
  std::string views, accessors;
  for (int i = 0; i < 5; ++i) {
    views += fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":36}},)", 36 * i);
    accessors += fmt::format(R"({{"bufferView":{},"componentType":5126,"type":"VEC3","count":3}},)", i);
  }
  return document(
      R"("buffers":[{"byteLength":216,"uri":"data:application/octet-stream;base64,)" + base64(bytes) +
      R"("}],"bufferViews":[)" + views +
      R"({"buffer":0,"byteOffset":180,"byteLength":12},{"buffer":0,"byteOffset":192,"byteLength":24}],
    "accessors":[)" +
      accessors +
      R"({"bufferView":6,"componentType":5126,"type":"SCALAR","count":6},
    {"bufferView":5,"componentType":5126,"type":"SCALAR","count":3}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},
    "targets":[{"POSITION":2},{"POSITION":3,"NORMAL":4}]}])" +
      mesh + "}]," + rest);
}

TEST_CASE("morph targets shape a mesh by its node's weights, or by its own", "[models]") {
  const Model model = load_text("a.gltf", morphing(R"(,"weights":[0.5,0])", R"("nodes":[{"mesh":0},{"mesh":0},
    {"mesh":0,"weights":[0,1]}])"));
  CHECK(model.warnings == std::vector<std::string>{});
  REQUIRE(model.meshes.size() == 2);  // the first two nodes share one
  CHECK(model.meshes[0].positions.at(1) == glm::vec3(1, 0, 0.5f));
  CHECK(model.meshes[0].positions.at(2) == glm::vec3(0, 1, 0));
  CHECK(model.meshes[1].positions.at(1) == glm::vec3(1, 0, 0));
  CHECK(model.meshes[1].positions.at(2) == glm::vec3(2, 1, 0));
  CHECK(glm::distance(model.meshes[1].normals.at(2), glm::vec3(1, 0, 0)) < 1e-6f);
  CHECK_THAT(load_error("a.gltf", morphing(R"(,"weights":[0.5])", one_node)),
             ContainsSubstring("/meshes/0/weights: 2 numbers wanted"));
  CHECK_THAT(load_error("a.gltf", morphing("", R"("nodes":[{"mesh":0,"weights":[1,2,3]}])")),
             ContainsSubstring("/nodes/0/weights: 2 numbers wanted"));
  CHECK(load_text("a.gltf", quad(one_node, R"(,"targets":[{"COLOR_0":2}])")).unread ==
        std::vector<std::string>{"morph targets' colours and texture coordinates"});
  CHECK_THAT(load_error("a.gltf", quad(one_node, R"(,"targets":[{"POSITION":2}])")),
             ContainsSubstring("/targets/0/POSITION"));
}

TEST_CASE("weights of morph targets play, and leave other nodes of the mesh alone", "[models]") {
  const Played scene(morphing("", R"("nodes":[{"mesh":0},{"mesh":0}],
    "animations":[{"samplers":[{"input":6,"output":5}],
    "channels":[{"sampler":0,"target":{"node":0,"path":"weights"}}]}])"));
  SceneFrames frames(scene.file, {}, {});
  const auto mesh = [](const SceneDescription& read, std::size_t object) {
    return read.meshes.at(static_cast<std::size_t>(std::get<MeshShape>(read.objects.at(object).shape).mesh));
  };
  for (const double frame : {24.0, 0.0, 12.0, 36.0}) {
    const auto read = frames.read(frame);
    const double second = frame / 24, first = second < 1 ? second : 1 - (second - 1),
                 other = second < 1 ? second / 2 : 0.5 + (second - 1) / 2;
    CHECK(mesh(*read, 0).positions.at(1).z == Approx(first));
    CHECK(mesh(*read, 0).positions.at(2).x == Approx(2 * other));
    CHECK(mesh(*read, 1).positions.at(1) == glm::vec3(1, 0, 0));
  }
}

TEST_CASE("frames of an animated model are read one after the other as alone", "[models]") {
  const Played moving(animated(node, {{slide()}}));
  SceneFrames frames(moving.file, {}, {});
  frames.check({0, 12});
  for (const double frame : {0.0, 12.0, 24.0, 12.0}) {
    const auto scene = frames.read(frame);
    CHECK(scene->objects[0].world_from_object == moving.place(frame));
    CHECK(scene->camera.position == moving.at(24).camera.position);  // it sees the whole way
  }
  CHECK(frames.read(std::nullopt)->objects[0].world_from_object == dmat4(1));
}

TEST_CASE("a glTF's animations are checked when frames are asked for", "[models]") {
  const auto error_of = [](const Channel& channel) {
    const Played bad(animated(node, {{channel}}));
    bad.at(std::nullopt);
    try {
      bad.at(3);
    } catch (const SceneError& error) {
      return error.place + ": " + error.reason;
    }
    return std::string("no error");
  };
  CHECK_THAT(error_of({0, "translation", "LINEAR", {0, 1}, {0, 0, 0}}),
             ContainsSubstring("1 values for 2 keys"));
  CHECK_THAT(error_of({0, "translation", "LINEAR", {1, 0}, {0, 0, 0, 1, 1, 1}}),
             ContainsSubstring("times that rise"));
  CHECK_THAT(error_of({7, "translation", "LINEAR", {0}, {0, 0, 0}}), ContainsSubstring("node"));
  CHECK_THAT(error_of({0, "translation", "SOON", {0}, {0, 0, 0}}), ContainsSubstring("CUBICSPLINE"));
  const TemporaryFolder folder;
  CHECK_THROWS_AS(load_scene(folder.write("a.gltf", quad(node)), {}, {.frame = 1}), SceneError);
}

TEST_CASE("lights made up around an animated model suit its materials for paths, whatever integrator renders",
          "[models]") {
  const Played moving(animated(node, {{slide()}}));
  for (const std::optional<double> frame : {std::optional<double>(), std::optional(12.0)}) {
    const SceneDescription whitted = moving.at(frame, {"/render/integrator=whitted"}),
                           path = moving.at(frame, {"/render/integrator=path"});
    CHECK(whitted.lights.at(0).intensity == path.lights.at(0).intensity);
    CHECK(whitted.environment.intensity == path.environment.intensity);
  }
}
