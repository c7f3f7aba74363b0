// The C interface: what it gives back, and that each function's errors are a status and a line.
#include <sundog/sundog.h>

#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "allocated_bytes.h"
#include "file_bytes.h"
#include "library_testing.h"
#include "temporary_folder.h"

namespace {

constexpr const char* text = R"({"image": {"width": 24, "height": 16, "background": [0.25, 0.5, 1]},
  "camera": {"position": [0, 0, 5], "target": [0, 0, 0]}, "lights": [{"type": "ambient"}],
  "materials": {"red": {"color": [1, 0, 0], "ambient": 1, "diffuse": 0}}, "objects": []})";

sundog_scene* scene_of(const char* json) {
  sundog_scene* scene = nullptr;
  REQUIRE(sundog_scene_from_json(json, nullptr, &scene, nullptr) == SUNDOG_OK);
  return scene;
}

sundog_devices* c_device() {
  sundog_devices* devices = nullptr;
  REQUIRE(sundog_devices_choose(test_spec().empty() ? nullptr : test_spec().c_str(), &devices, nullptr) ==
          SUNDOG_OK);
  return devices;
}

struct Failure {
  sundog_error* error = sundog_error_new();

  Failure() = default;
  Failure(const Failure&) = delete;
  Failure& operator=(const Failure&) = delete;
  ~Failure() { sundog_error_free(error); }
  std::string line() const { return sundog_error_line(error); }
};

}  // namespace

TEST_CASE("C renders a mesh of its own and reads the pixels") {
  sundog_scene* scene = scene_of(text);
  sundog_devices* devices = c_device();
  const float positions[] = {-9, -9, 0, 9, -9, 0, 0, 9, 0};
  const std::uint32_t triangles[] = {0, 1, 2};
  CHECK(sundog_scene_add_mesh(scene, "wall", positions, 3, triangles, 1, nullptr, nullptr, nullptr) ==
        SUNDOG_OK);
  CHECK(sundog_scene_set(scene, "/objects/-", R"({"type": "mesh", "mesh": "wall", "material": "red"})",
                         nullptr) == SUNDOG_OK);
  CHECK(sundog_scene_check(scene, nullptr) == SUNDOG_OK);
  sundog_options options{};
  options.devices = devices;
  options.aovs = "depth,normal";
  options.work_group_x = 8;
  sundog_film* film = nullptr;
  REQUIRE(sundog_render(scene, &options, &film, nullptr) == SUNDOG_OK);
  CHECK(sundog_film_complete(film) == 1);
  const float* pixels = nullptr;
  int width = 0, height = 0, channels = 0;
  REQUIRE(sundog_film_pixels(film, nullptr, &pixels, &width, &height, &channels, nullptr) == SUNDOG_OK);
  CHECK((width == 24 && height == 16 && channels == 4));
  const float* middle = pixels + 4 * (8 * 24 + 12);
  CHECK(middle[0] == Approx(1));
  CHECK(middle[1] == Approx(0).margin(1e-6));
  REQUIRE(sundog_film_pixels(film, "depth", &pixels, nullptr, nullptr, &channels, nullptr) == SUNDOG_OK);
  CHECK(channels == 1);
  CHECK(pixels[8 * 24 + 12] == Approx(5));
  const TemporaryFolder folder;
  CHECK(sundog_film_save(film, (folder / "a.png").c_str(), nullptr) == SUNDOG_OK);
  CHECK(file_bytes(folder / "a.png").starts_with("\x89PNG"));
  CHECK(sundog_film_save(film, (folder / "a.gif").c_str(), nullptr) == SUNDOG_USAGE);
  CHECK(sundog_film_save(film, (folder / "none/a.png").c_str(), nullptr) == SUNDOG_IO);
  const Failure failure;
  CHECK(sundog_film_pixels(film, "albedo", &pixels, nullptr, nullptr, nullptr, failure.error) ==
        SUNDOG_USAGE);
  CHECK(failure.line().find("albedo") != std::string::npos);
  sundog_film_free(film);
  sundog_devices_free(devices);
  sundog_scene_free(scene);
}

TEST_CASE("a C callback ends a render, and gets its user pointer") {
  sundog_scene* scene = scene_of(text);
  CHECK(sundog_scene_set(scene, "/render/samples", "65536", nullptr) == SUNDOG_OK);
  CHECK(sundog_scene_set(scene, "/objects/-", R"({"type": "sphere", "material": "red"})", nullptr) ==
        SUNDOG_OK);
  sundog_devices* devices = c_device();
  sundog_options options{};
  int calls = 0;
  options.devices = devices;
  options.user = &calls;
  options.progress = [](std::uint64_t, std::uint64_t total, double, void* user) {
    ++*static_cast<int*>(user);
    return total == 24u * 16 ? 1 : 0;
  };
  sundog_film* film = nullptr;
  CHECK(sundog_render(scene, &options, &film, nullptr) == SUNDOG_STOPPED);
  REQUIRE(film != nullptr);
  CHECK(calls > 0);
  sundog_film_free(film);
  sundog_devices_free(devices);
  sundog_scene_free(scene);
}

TEST_CASE("no exception crosses the C interface, a callback's neither") {
  sundog_scene* scene = scene_of(text);
  sundog_devices* devices = c_device();
  sundog_options options{};
  options.devices = devices;
  options.progress = [](std::uint64_t, std::uint64_t, double, void*) -> int {
    throw std::logic_error("from C++");
  };
  sundog_film* film = nullptr;
  const Failure failure;
  CHECK(sundog_render(scene, &options, &film, failure.error) == SUNDOG_INTERNAL);
  CHECK(failure.line() == "from C++");
  CHECK(film == nullptr);
  sundog_devices_free(devices);
  sundog_scene_free(scene);
}

namespace {

/// call() while one allocation after the other fails, until none of them does.
template <class F>
void without_memory(const char* name, const F& call) {
  CAPTURE(name);
  bool failed = true;
  for (int allowed = 0; failed; ++allowed) {
    CAPTURE(allowed);
    sundog_status status = SUNDOG_OK;
    {
      const LargeAllocationsFail fail(1u << 16, allowed);
      status = call();
      failed = LargeAllocationsFail::failed();
    }
    CHECK(status == (failed ? SUNDOG_INTERNAL : SUNDOG_OK));
    CHECK((failed || allowed > 0));
  }
}

}  // namespace

TEST_CASE("a want of memory is a status of C, whatever takes the memory") {
  const std::string comment(200'000, 'x'), quoted = '"' + comment + '"',
                                           document = R"({"comment": )" + quoted + "}";
  std::vector<float> positions(90'000);
  std::vector<std::uint32_t> triangles(90'000);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions[i] = static_cast<float>(i % 100);
    triangles[i] = static_cast<std::uint32_t>(i / 3);
  }
  without_memory("sundog_scene_from_json", [&] {
    sundog_scene* made = nullptr;
    const sundog_status status = sundog_scene_from_json(document.c_str(), nullptr, &made, nullptr);
    sundog_scene_free(made);
    return status;
  });
  sundog_scene* scene = scene_of(text);
  without_memory("sundog_scene_set",
                 [&] { return sundog_scene_set(scene, "/comment", quoted.c_str(), nullptr); });
  without_memory("sundog_scene_add_mesh", [&] {
    return sundog_scene_add_mesh(scene, "m", positions.data(), 30'000, triangles.data(), 30'000, nullptr,
                                 nullptr, nullptr);
  });
  sundog_scene_free(scene);
  scene = scene_of(text);
  CHECK(sundog_scene_set(scene, "/image/width", "600", nullptr) == SUNDOG_OK);
  sundog_devices* devices = c_device();
  sundog_options options{};
  options.devices = devices;
  without_memory("sundog_render", [&] {
    sundog_film* film = nullptr;
    const sundog_status status = sundog_render(scene, &options, &film, nullptr);
    CHECK((film != nullptr) == (status == SUNDOG_OK));
    sundog_film_free(film);
    return status;
  });
  sundog_devices_free(devices);
  sundog_scene_free(scene);
}

TEST_CASE("a mesh that C keeps is let go of once, when nobody reads it any more") {
  const std::vector<float> positions{-9, -9, 0, 9, -9, 0, 0, 9, 0};
  const std::vector<std::uint32_t> triangles{0, 1, 2}, wrong{0, 1, 3};
  int released = 0;
  const auto hold = [&](sundog_scene* scene, const std::uint32_t* corners) {
    return sundog_scene_hold_mesh(
        scene, "wall", positions.data(), 3, corners, 1, nullptr, nullptr,
        [](void* user) {
          ++*static_cast<int*>(user);
          throw std::logic_error("from C++");
        },
        &released, nullptr);
  };
  sundog_scene* scene = scene_of(text);
  CHECK(hold(scene, wrong.data()) == SUNDOG_USAGE);
  CHECK(hold(nullptr, triangles.data()) == SUNDOG_USAGE);
  CHECK(sundog_scene_hold_mesh(scene, "wall", nullptr, 3, triangles.data(), 1, nullptr, nullptr, nullptr,
                               nullptr, nullptr) == SUNDOG_USAGE);
  CHECK(released == 0);
  REQUIRE(hold(scene, triangles.data()) == SUNDOG_OK);
  CHECK(sundog_scene_set(scene, "/objects/-", R"({"type": "mesh", "mesh": "wall", "material": "red"})",
                         nullptr) == SUNDOG_OK);
  sundog_devices* devices = c_device();
  sundog_session* session = nullptr;
  REQUIRE(sundog_session_open(devices, &session, nullptr) == SUNDOG_OK);
  CHECK(sundog_session_start(session, scene, nullptr) == SUNDOG_OK);
  sundog_scene_free(scene);
  CHECK(released == 0);  // the session draws it
  sundog_state state = SUNDOG_IDLE;
  CHECK(sundog_session_wait(session, -1, &state, nullptr) == SUNDOG_OK);
  std::vector<float> pixels(24 * 16 * 4);
  int width = 0, height = 0;
  CHECK(sundog_session_picture(session, pixels.data(), pixels.size(), &width, &height, nullptr) == SUNDOG_OK);
  CHECK(pixels[4 * (8 * 24 + 12)] == Approx(1));
  sundog_session_free(session);
  CHECK(released == 1);
  scene = scene_of(text);
  REQUIRE(hold(scene, triangles.data()) == SUNDOG_OK);
  REQUIRE(hold(scene, triangles.data()) == SUNDOG_OK);  // takes the place of the one before
  CHECK(released == 2);
  sundog_scene_free(scene);
  CHECK(released == 3);
  sundog_devices_free(devices);
}

TEST_CASE("every function of C reports its errors") {
  sundog_scene* scene = nullptr;
  sundog_devices* devices = nullptr;
  sundog_film* film = nullptr;
  sundog_session* session = nullptr;
  int size = 0;
  const Failure failure;
  CHECK(sundog_scene_load("/none/such.json", &scene, failure.error) == SUNDOG_SCENE);
  CHECK(std::string(sundog_error_file(failure.error)) == "/none/such.json");
  CHECK(sundog_scene_load(nullptr, &scene, nullptr) == SUNDOG_USAGE);
  CHECK(sundog_scene_load("x.json", nullptr, nullptr) == SUNDOG_USAGE);
  CHECK(sundog_scene_from_json("{", nullptr, &scene, nullptr) == SUNDOG_SCENE);
  CHECK(sundog_scene_from_json(nullptr, nullptr, &scene, nullptr) == SUNDOG_USAGE);
  CHECK(scene == nullptr);
  CHECK(sundog_devices_choose("no such device", &devices, nullptr) == SUNDOG_DEVICE);
  CHECK(sundog_devices_list(nullptr, nullptr) == SUNDOG_USAGE);
  CHECK(sundog_devices_choose(nullptr, nullptr, nullptr) == SUNDOG_USAGE);
  CHECK(sundog_devices_count(nullptr) == 0);
  CHECK(sundog_devices_label(nullptr, 0) == nullptr);
  CHECK(sundog_devices_problem(nullptr, 0) == nullptr);
  CHECK(sundog_scene_check(nullptr, nullptr) == SUNDOG_USAGE);
  CHECK(sundog_scene_set(nullptr, "/camera", "1", nullptr) == SUNDOG_USAGE);
  CHECK(devices == nullptr);
  CHECK(sundog_render(nullptr, nullptr, &film, nullptr) == SUNDOG_USAGE);
  CHECK(sundog_film_pixels(nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr) == SUNDOG_USAGE);
  CHECK(sundog_film_save(nullptr, "a.png", nullptr) == SUNDOG_USAGE);
  CHECK(sundog_film_complete(nullptr) == 0);
  CHECK(sundog_film_warning(nullptr, 0) == nullptr);
  sundog_wait_for_threads();
  CHECK(sundog_scene_load_frame("/none/such.json", 3, &scene, failure.error) == SUNDOG_SCENE);
  CHECK(sundog_session_open(nullptr, nullptr, nullptr) == SUNDOG_USAGE);
  CHECK(sundog_session_start(nullptr, nullptr, nullptr) == SUNDOG_USAGE);
  CHECK(sundog_session_cancel(nullptr, nullptr) == SUNDOG_USAGE);
  CHECK(sundog_session_wait(nullptr, 0, nullptr, nullptr) == SUNDOG_USAGE);
  CHECK(sundog_session_picture(session, nullptr, 0, &size, &size, nullptr) == SUNDOG_USAGE);
  scene = scene_of(text);
  CHECK(sundog_scene_set(scene, "/objects/4000000000", "1", nullptr) == SUNDOG_USAGE);
  CHECK(sundog_scene_set(scene, "camera", "1", nullptr) == SUNDOG_USAGE);
  CHECK(sundog_scene_set(scene, nullptr, "1", nullptr) == SUNDOG_USAGE);
  CHECK(sundog_scene_add_mesh(scene, "m", nullptr, 0, nullptr, 0, nullptr, nullptr, nullptr) == SUNDOG_USAGE);
  CHECK(sundog_scene_set(scene, "/camera/fov", "0", nullptr) == SUNDOG_OK);
  CHECK(sundog_scene_check(scene, failure.error) == SUNDOG_SCENE);
  CHECK(std::string(sundog_error_place(failure.error)) == "/camera/fov");
  sundog_scene_free(scene);
  sundog_scene_free(nullptr);
  sundog_devices_free(nullptr);
  sundog_film_free(nullptr);
  sundog_session_free(nullptr);
}

TEST_CASE("a count of vertices or triangles that no array has is refused before the array is read") {
  sundog_scene* scene = scene_of(text);
  const Failure failure;
  const float positions[9] = {};
  const std::uint32_t corners[3] = {0, 1, 2};
  for (const std::size_t count : {SIZE_MAX, SIZE_MAX / 12, std::size_t{1} << 32}) {
    CHECK(sundog_scene_add_mesh(scene, "m", positions, count, corners, 1, nullptr, nullptr, failure.error) ==
          SUNDOG_USAGE);
    CHECK(failure.line().find(std::to_string(count)) != std::string::npos);
    CHECK(sundog_scene_add_mesh(scene, "m", positions, 3, corners, count, nullptr, nullptr, nullptr) ==
          SUNDOG_USAGE);
  }
  sundog_scene_free(scene);
}

TEST_CASE("an error handle keeps the last failure, and none is needed") {
  Failure mine, other;
  CHECK(std::strlen(sundog_error_line(mine.error)) == 0);
  std::thread([&] {
    CHECK(sundog_scene_load("/none/other.json", nullptr, other.error) == SUNDOG_USAGE);
  }).join();
  CHECK(mine.line().empty());
  CHECK(other.line() == "scene: wanted a value, found NULL");
  sundog_scene* scene = nullptr;
  CHECK(sundog_scene_from_json(text, nullptr, &scene, other.error) == SUNDOG_OK);
  CHECK(other.line() == "scene: wanted a value, found NULL");
  sundog_scene_free(scene);
  CHECK(sundog_scene_load("/none/other.json", &scene, nullptr) == SUNDOG_SCENE);
  CHECK(std::strlen(sundog_error_line(nullptr)) + std::strlen(sundog_error_file(nullptr)) +
            std::strlen(sundog_error_place(nullptr)) ==
        0);
  sundog_error_free(nullptr);
}

TEST_CASE("C lists devices and draws in a session") {
  sundog_devices* all = nullptr;
  REQUIRE(sundog_devices_list(&all, nullptr) == SUNDOG_OK);
  REQUIRE(sundog_devices_count(all) > 0);
  CHECK(sundog_devices_label(all, 0) != nullptr);
  CHECK(sundog_devices_problem(all, 0) != nullptr);
  CHECK(sundog_devices_label(all, 1000) == nullptr);
  sundog_devices_free(all);
  sundog_devices* devices = c_device();
  sundog_session* session = nullptr;
  REQUIRE(sundog_session_open(devices, &session, nullptr) == SUNDOG_OK);
  sundog_scene* scene = scene_of(text);
  std::vector<float> pixels(24 * 16 * 4);
  int width = -1, height = -1;
  CHECK(sundog_session_picture(session, pixels.data(), pixels.size(), &width, &height, nullptr) == SUNDOG_OK);
  CHECK(width == 0);
  CHECK(sundog_session_start(session, scene, nullptr) == SUNDOG_OK);
  sundog_state state = SUNDOG_IDLE;
  CHECK(sundog_session_wait(session, -1, &state, nullptr) == SUNDOG_OK);
  CHECK(state == SUNDOG_SETTLED);
  CHECK(sundog_session_picture(session, pixels.data(), 3, &width, &height, nullptr) == SUNDOG_USAGE);
  CHECK(sundog_session_picture(session, pixels.data(), pixels.size(), &width, &height, nullptr) == SUNDOG_OK);
  CHECK((width == 24 && height == 16));
  CHECK(pixels[2] == 1);
  CHECK(sundog_session_cancel(session, nullptr) == SUNDOG_OK);
  sundog_session_free(session);
  sundog_scene_free(scene);
  sundog_devices_free(devices);
}
