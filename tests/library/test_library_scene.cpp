// Scenes, images and errors of the public interface, without a device.
#include <cmath>
#include <limits>

#include "library_testing.h"
#include "temporary_folder.h"

using sundog::ErrorKind;

TEST_CASE("the version is that of the headers") {
  CHECK(sundog::version() == std::to_string(SUNDOG_VERSION_MAJOR) + "." +
                                 std::to_string(SUNDOG_VERSION_MINOR) + "." +
                                 std::to_string(SUNDOG_VERSION_PATCH));
}

TEST_CASE("a scene of values is the scene of the same document") {
  const sundog::Scene made = small_scene();
  CHECK(made.check().empty());
  CHECK(made.get("/materials/red/reflection") == "0.3");
  const sundog::Scene read = sundog::Scene::from_json(made.to_json());
  CHECK(read.to_json() == made.to_json());
}

TEST_CASE("a scene's values can be set, asked for and taken out") {
  sundog::Scene scene = small_scene();
  scene.set("/camera/fov", 30).set("/objects/-", R"({"type": "sphere", "material": "red"})");
  CHECK(scene.get("/camera/fov") == "30.0");
  CHECK(scene.contains("/objects/2/type"));
  scene.remove("/objects/2").remove("/camera/fov");
  CHECK_FALSE(scene.contains("/objects/2"));
  CHECK_FALSE(scene.contains("/camera/fov"));
  CHECK(scene.check().empty());
}

TEST_CASE("a copy of a scene is a scene of its own") {
  sundog::Scene first = small_scene(), second = first;
  second.set("/camera/fov", 20);
  CHECK(first.get("/camera/fov") == "40.0");
  first = second;
  CHECK(first.get("/camera/fov") == "20.0");
}

TEST_CASE("pointers that lead nowhere are usage errors that name them") {
  sundog::Scene scene = small_scene();
  for (const char* pointer : {"camera/fov", "/objects/7", "/camera/~2"}) {
    CAPTURE(pointer);
    const sundog::Error error = error_of([&] { (void)scene.get(pointer); });
    CHECK(error.kind() == ErrorKind::usage);
    CHECK(error.place() == pointer);
    CHECK(error_of([&] { scene.remove(pointer); }).kind() == ErrorKind::usage);
  }
  CHECK(error_of([&] { scene.set("/camera/fov/x", 1); }).kind() == ErrorKind::usage);
  for (const char* pointer : {"/objects/3", "/objects/4000000000", "/objects/-/children/1", "/new/1"}) {
    CAPTURE(pointer);
    CHECK(error_of([&] { scene.set(pointer, 1); }).place() == pointer);
  }
  CHECK(small_scene().set("/objects/2", "{}").contains("/objects/2"));
  CHECK(error_of([&] { scene.set("/camera/fov", "thirty"); }).kind() == ErrorKind::usage);
  CHECK(error_of([&] { scene.remove(""); }).kind() == ErrorKind::usage);
  CHECK(scene.get("/camera/fov") == "40.0");
  scene.set("/lights", "[]").add_light({.type = "spot", .angle = 20, .more = {{"inner_angle", 5}}});
  CHECK(scene.get("/lights/0/inner_angle") == "5.0");
  scene.set("/lights", "3");
  CHECK(error_of([&] { scene.add_light({}); }).place() == "/lights");
}

TEST_CASE("what adds to a document refuses one of another shape") {
  const auto kind_of = [](const char* text, const auto& add) {
    sundog::Scene scene = sundog::Scene::from_json(text);
    const sundog::Error error = error_of([&] { add(scene); });
    CHECK(sundog::Scene::from_json(text).to_json() == scene.to_json());
    return error.kind();
  };
  const auto add_material = [](sundog::Scene& scene) { scene.add_material("red", {}); };
  CHECK(kind_of(R"({"materials": 3})", add_material) == ErrorKind::usage);
  CHECK(kind_of("[]", add_material) == ErrorKind::usage);
  CHECK(kind_of("[]", [](sundog::Scene& scene) { scene.add_light({}); }) == ErrorKind::usage);
  CHECK(kind_of("[]", [](sundog::Scene& scene) { scene.set_size(2, 2); }) == ErrorKind::usage);
  CHECK(kind_of("3", [](sundog::Scene& scene) { scene.set_camera({}); }) == ErrorKind::usage);
  const char* objects = R"({"objects": {}})";
  CHECK(kind_of(objects, [](sundog::Scene& scene) { scene.add_sphere({}, 1, {}); }) == ErrorKind::usage);
  CHECK(kind_of(objects, [](sundog::Scene& scene) { scene.add_box({}, {1, 1, 1}, {}); }) == ErrorKind::usage);
  const auto add_plane = [](sundog::Scene& scene) { scene.add_plane({}, {0, 1, 0}, {}); };
  CHECK(kind_of(objects, add_plane) == ErrorKind::usage);
  CHECK(kind_of(objects, [](sundog::Scene& scene) { scene.add_instance("m", {}); }) == ErrorKind::usage);
  CHECK(kind_of(objects, [](sundog::Scene& scene) { scene.add_formula({}, {}); }) == ErrorKind::usage);
  CHECK(kind_of("3", [](sundog::Scene& scene) { scene.set_background({}, {}); }) == ErrorKind::usage);
  CHECK(kind_of("3", [](sundog::Scene& scene) { scene.set_samples(1); }) == ErrorKind::usage);
  CHECK(kind_of("{}", [](sundog::Scene& scene) { (void)scene.contains("no pointer"); }) == ErrorKind::usage);
  sundog::Scene scene = small_scene();
  scene.set_size(0, 10);
  CHECK(error_of([&] { (void)scene.check(); }).place() == "/image/width");
  CHECK(error_of([&] { (void)scene.set_size(10, 10).set_samples(0).check(); }).place() == "/render/samples");
}

TEST_CASE("what a scene's values do not fit is an error with file and place") {
  sundog::Scene scene = small_scene();
  scene.set("/camera/fov", 200);
  const sundog::Error error = error_of([&] { (void)scene.check(); });
  CHECK(error.kind() == ErrorKind::scene);
  CHECK(error.place() == "/camera/fov");
  CHECK(error.reason().find("180") != std::string::npos);
  CHECK(std::string(error.what()).find(error.reason()) != std::string::npos);
  scene.set("/camera/fov", 40);
  CHECK(scene.check().empty());
}

TEST_CASE("scenes that cannot be read are errors that name the file") {
  const TemporaryFolder folder;
  const auto missing = folder / "missing.json";
  CHECK(error_of([&] { (void)sundog::Scene::load(missing); }).file() == missing.string());
  const auto broken = folder.write("broken.json", "{\n\"objects\": [");
  const sundog::Error error = error_of([&] { (void)sundog::Scene::load(broken); });
  CHECK(error.kind() == ErrorKind::scene);
  CHECK(error.place().starts_with("line"));
  CHECK(error_of([&] { (void)sundog::Scene::from_json("{]"); }).kind() == ErrorKind::scene);
  CHECK(error_of([&] { (void)sundog::Scene::from_json("{}").check(); }).kind() == ErrorKind::scene);
}

TEST_CASE("the camera that is made up around a model fits the picture that is asked for") {
  const TemporaryFolder folder;
  const auto ball = folder.write("wide.obj", "v -4 0 0\nv 4 0 0\nv 4 1 0\nv -4 1 0\nf 1 2 3 4\n");
  const sundog::Scene usual = sundog::Scene::load(ball),
                      wide = sundog::Scene::load(ball, {.size = {400, 100}});
  CHECK(usual.get("/image/width") == "640");
  CHECK(wide.get("/image/width") == "400");
  CHECK(wide.get("/image/height") == "100");
  CHECK(std::stod(wide.get("/camera/position/2")) < 0.6 * std::stod(usual.get("/camera/position/2")));
  CHECK(wide.check() == usual.check());
  const auto json = folder.write("scene.json", R"({"objects": []})");
  CHECK(sundog::Scene::load(json, {.size = {30, 20}}).get("/image/height") == "20");
  CHECK_THROWS_WITH(sundog::Scene::load(json, {.size = {-1, 5}}),
                    "size: wanted pixels, or 0 for the file's, found -1");
  CHECK_THROWS_WITH(sundog::Scene::load(json, {.frame = NAN}), "frame: wanted a frame's number, found nan");
}

TEST_CASE("names of files in a scene's text count from its folder") {
  const TemporaryFolder folder;
  folder.write("ball.nff", "s 0 0 0 1\n");
  const std::string text = R"({"objects": [{"type": "model", "file": "ball.nff"}]})";
  CHECK_NOTHROW(sundog::Scene::from_json(text, folder.path()).check());
  CHECK(error_of([&] { (void)sundog::Scene::from_json(text, folder / "else").check(); }).kind() ==
        ErrorKind::scene);
}

TEST_CASE("a file outside the scene's folder wants leave") {
  const TemporaryFolder folder;
  folder.write("ball.nff", "s 0 0 0 1\n");
  const auto scene =
      folder.write("in/scene.json", R"({"objects": [{"type": "model", "file": "../ball.nff"}]})");
  CHECK(error_of([&] { (void)sundog::Scene::load(scene).check(); }).kind() == ErrorKind::scene);
  CHECK_NOTHROW(sundog::Scene::load(scene, {.outside_files = true}).check());
}

namespace {

struct Tetrahedron {
  std::vector<std::array<float, 3>> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<std::array<std::uint32_t, 3>> triangles{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  sundog::MeshView view() const { return {.positions = positions, .triangles = triangles}; }
};

}  // namespace

TEST_CASE("a mesh of spans that do not fit each other is refused, and nothing is added") {
  sundog::Scene scene = small_scene();
  const Tetrahedron solid;
  const auto reason_of = [&](const sundog::MeshView& view) {
    const sundog::Error error = error_of([&] { scene.add_mesh("solid", view); });
    CHECK(error.kind() == ErrorKind::usage);
    return std::string(error.what());
  };
  sundog::MeshView view = solid.view();
  view.triangles = {};
  CHECK(reason_of(view).find("a triangle or more") != std::string::npos);
  Tetrahedron wrong;
  wrong.triangles[2][1] = 4;
  CHECK(reason_of(wrong.view()).find("corner 4") != std::string::npos);
  wrong = {};
  wrong.positions[3][0] = std::numeric_limits<float>::quiet_NaN();
  CHECK(reason_of(wrong.view()).find("positions 3 is not finite") != std::string::npos);
  view = solid.view();
  const std::vector<std::array<float, 3>> three(3);
  view.normals = three;
  CHECK(reason_of(view).find("wanted 4 normals") != std::string::npos);
  scene.add_instance("solid", {.material = "red"});
  CHECK(error_of([&] { (void)scene.check(); }).kind() == ErrorKind::scene);
  scene.add_mesh("solid", solid.view());
  CHECK(scene.check().empty());
}

TEST_CASE("a mesh in memory and one of the document want two names") {
  sundog::Scene scene = small_scene();
  scene.add_mesh("solid", Tetrahedron().view());
  scene.set("/meshes", R"({"solid": {"generate": {"type": "ice_block", "subdivision": 4}}})");
  const sundog::Error error = error_of([&] { (void)scene.check(); });
  CHECK(error.place() == "/meshes/solid");
}

TEST_CASE("an image keeps its pixels, and refuses others than it says") {
  const std::vector<float> pixels{0, 0.5f, 1, 0.25f, 2, 0};
  const sundog::Image image(2, 1, 3, pixels);
  CHECK(std::ranges::equal(image.pixels(), pixels));
  CHECK(image.tone_mapped({.exposure = 1}).pixels()[4] == 4);
  for (const auto& [width, height, channels] :
       {std::array{2, 2, 3}, {2, 1, 4}, {0, 1, 3}, {-2, -1, 3}, {3, 1, 2}}) {
    CAPTURE(width, height, channels);
    CHECK(error_of([&] { (void)sundog::Image(width, height, channels, pixels); }).kind() == ErrorKind::usage);
  }
  CHECK(sundog::Image().pixels().empty());
}

TEST_CASE("an image comes back from a file as it was saved") {
  const TemporaryFolder folder;
  const std::vector<float> pixels{0, 0.5f, 1, 0.25f, 2, 0};
  const sundog::Image image(2, 1, 3, pixels);
  image.save(folder / "a.pfm");
  const sundog::Image back = sundog::Image::load(folder / "a.pfm");
  REQUIRE(back.channels() == 4);
  CHECK(back.pixels()[5] == 2);
  CHECK(image.encode("png").starts_with("\x89PNG"));
}

TEST_CASE("errors of images have their kind") {
  const TemporaryFolder folder;
  const sundog::Image image(1, 1, 3, std::vector<float>(3)), grey(1, 1, 1, std::vector<float>(1));
  CHECK(error_of([&] { image.save(folder / "a.bmp"); }).kind() == ErrorKind::usage);
  CHECK(error_of([&] { grey.save(folder / "a.png"); }).kind() == ErrorKind::usage);
  CHECK(error_of([&] { sundog::Image().save(folder / "a.png"); }).kind() == ErrorKind::usage);
  const sundog::Error error = error_of([&] { image.save(folder / "none" / "a.png"); });
  CHECK(error.kind() == ErrorKind::io);
  CHECK(error.file() == (folder / "none" / "a.png").string());
  CHECK(error.what() == error.file() + ": " + error.reason());
  CHECK(error_of([&] { (void)image.encode("bmp"); }).kind() == ErrorKind::usage);
  CHECK(error_of([&] { (void)sundog::Image::load(folder.write("a.png", "no picture")); }).kind() ==
        ErrorKind::scene);
  CHECK(error_of([&] { (void)image.tone_mapped({.curve = "film"}); }).kind() == ErrorKind::usage);
  CHECK(error_of([&] { (void)image.tone_mapped({.exposure = 40}); }).kind() == ErrorKind::usage);
  CHECK(error_of([&] { (void)image.tone_mapped({.white_balance = 5}); }).kind() == ErrorKind::usage);
}
