// Files that are no scenes: broken JSON, absurd nesting, missing files, folders.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/image_io.h"
#include "catch.h"
#include "render/film/frame_memory.h"
#include "scene/json/parse.h"
#include "scene/load.h"
#include "scene_text.h"

using namespace sundog;

TEST_CASE("bad JSON is refused with its place") {
  struct Broken {
    std::string text, place, words;
  };
  const std::string nul("{\"objects\": []}\0{}", 18);
  const std::vector<Broken> table = {
      {"", "", "found an empty file"},
      {" \n\t ", "", "found an empty file"},
      {"// only a comment", "line 1, column 17", "unexpected end of input"},
      {"{\n  \"objects\": [\n    {]\n  ]\n}", "line 3, column 6", "unexpected ']'"},
      {"{\"objects\": [1, 2,]}", "line 1, column 19", "take the last comma away"},
      {"{\"objects\": [],\n}", "line 2, column 1", "take the last comma away"},
      {"{\"objects\": []", "line 1, column 14", "unexpected end of input"},
      {"{\"objects\": []} []", "line 1, column 17", "expected end of input"},
      {"{\"objects\": [NaN]}", "line 1, column 14", "invalid literal"},
      {"{\"objects\": [] /* open", "line 1, column 16", "comment"},
      {"{ /* an \"/*\" */ \"a\": 1, /* open\n\n}", "line 1, column 25", "missing closing '*/'"},
      {"{} /*/", "line 1, column 4", "missing closing '*/'"},
      {"{\"a\": \"\\\"/*\", // /*\n /* open", "line 2, column 2", "missing closing '*/'"},
      {"{\"objects\": [\"tab\there\"]}", "line 1, column 18", "control character"},
      {"{\"objects\": [[0, 1], 1e999]}", "/objects/1", "wanted a finite number, found 1e999"},
      {"{\"camera\": {\"fov\": -1e999}}", "/camera/fov", "wanted a finite number, found -1e999"},
      {"{\"camera\": {\"fov\": 30, \"fov\": 40}}", "/camera/fov", "duplicate key"},
      {"{\"objects\": [{}, {\"a\": {}, \"b\": 1, \"a\": 2}]}", "/objects/1/a", "duplicate key"},
      {"\xFF\xFE{\0}\0", "", "UTF-16"},
      {"{\"objects\": [\"\xE9\"]}", "line 1, column 15", "wanted UTF-8 text, found the byte 0xE9"},
      {"// caf\xE9\n{\"objects\": []}", "line 1, column 7", "found the byte 0xE9"},
      {"{\"objects\": [\"\xED\xA0\x80\"]}", "line 1, column 15", "found the byte 0xED"},
      {nul, "line 1, column 16", "found the byte 0x00: save it as UTF-8"},
      {"{\"unit\": 1\n\"objects\": []}", "line 2, column 9", "expected ',' or '}'"},
      {"{\"objects\": [1 2]}", "line 1, column 16", "expected ',' or ']'"},
      {"{objects: []}", "line 1, column 2", "invalid literal \"objects\"; expected a key in double quotes"},
      {"{\"a\": True}", "line 1, column 7",
       "invalid literal \"True\"; expected '{', '[', a number such as 0.5"},
      {"{\"a\": 'b'}", "line 1, column 7", "invalid literal \"'\"; expected '{', '[', a number such as 0.5"},
      {"{\"a\": \u201cb\u201d}", "line 1, column 7", "invalid literal \"\\u201c\"; expected"},
      {"{\"a\": 1,5}", "line 1, column 9", "(1.5 is written with a point)"},
      {"# a scene\n{}", "line 1, column 1", "a comment begins with //"},
      {"{\"a\": \"b,\n}", "line 1, column 9", "wanted a closing quote in this line"},
      {"{\"a\": \"b,\r\n}", "line 1, column 10", "wanted a closing quote in this line"},
      {"{\"a\": \"C:\\models\"}", "line 1, column 11", "wanted \\\\ for a backslash, or / between folders"},
      {"{\"a\": \"C:\\users\"}", "line 1, column 12", "wanted \\\\ for a backslash, or / between folders"},
      {"{} x" + std::string(1000, 'x'), "line 1, column 4", "invalid literal \"xxxxxxxxxxxxxxxxxxxx\";"},
  };
  for (const auto& [text, place, words] : table) {
    const SceneError error = error_of(text);
    INFO(error.what());
    CHECK(error.place == place);
    CHECK(error.reason.find(words) != std::string::npos);
    CHECK(error.reason.find('\n') == std::string::npos);
    CHECK(error.reason.find("last read") == std::string::npos);
    CHECK_NOTHROW(nlohmann::json(error.reason).dump());  // of whole letters
  }
}

TEST_CASE("nesting is bounded, however deep the file") {
  const auto nested = [](std::size_t depth) {
    return "{\"objects\": " + std::string(depth, '[') + std::string(depth, ']') + "}";
  };
  CHECK(error_of(nested(max_json_depth - 1)).place == "/objects/0");
  CHECK(error_of(nested(max_json_depth)).reason.find("at most 100 nested") != std::string::npos);
  CHECK(error_of(std::string(1000000, '[')).reason.find("at most 100 nested") != std::string::npos);
}

TEST_CASE("files that are no scene are refused") {
  const TemporaryFolder folder;
  const auto reason = [](const std::filesystem::path& path) {
    try {
      load_scene(path);
    } catch (const SceneError& error) {
      CHECK(error.file == path.string());
      return error.reason;
    }
    return std::string("no error");
  };
  CHECK(reason(folder.path() / "none.json") == "does not exist");
  CHECK(reason(folder.path()) == "is a folder, wanted a file");
  std::filesystem::create_directory(folder.path() / "folder.json");
  CHECK(reason(folder.path() / "folder.json") == "is a folder, wanted a file");
  CHECK(reason(folder.write("scene.txt", "{}")).find("wanted a scene (.json)") == 0);
  CHECK(reason(folder.write("scene", "{}")).find("wanted a scene (.json)") == 0);
  CHECK(reason(folder.path() / "scene.txt" / "below.json").find("Not a directory") != std::string::npos);
  const auto loop = folder.path() / "loop.json";
  std::filesystem::create_symlink(loop, loop);
  CHECK(reason(loop).find("symbolic links") != std::string::npos);
}

TEST_CASE("a missing file is said to come from the script beside it that names it") {
  const TemporaryFolder folder;
  const auto scene = folder.write("scene.json", scene_of(R"({"type": "model", "file": "made.ply"})"));
  const auto reason = [&] {
    try {
      load_scene(scene);
    } catch (const SceneError& error) {
      return error.reason;
    }
    return std::string("no error");
  };
  const std::string missing = fmt::format("\"{}\" does not exist", (folder / "made.ply").string());
  folder.write("make_others.py", "write('other.ply', 'remade.ply', 'made.ply2')");
  CHECK(reason() == missing);
  folder.write("make_meshes.py", "write('made.ply')");
  folder.write("make_more.sh", "made.ply");  // the first by name is enough
  CHECK(reason() == missing + fmt::format(": run {}, which names it", (folder / "make_meshes.py").string()));
}

TEST_CASE("a bad mesh file is named by itself") {
  const TemporaryFolder folder;
  folder.write("bad.ply", "ply\nformat ascii 1.0\nelement vertex x\n");
  const auto scene = folder.write("scene.json", scene_of(R"({"type": "model", "file": "bad.ply"})"));
  try {
    load_scene(scene);
    FAIL("no error");
  } catch (const SceneError& error) {
    CHECK(error.file == (folder.path() / "bad.ply").string());
    CHECK(error.place == "line 3");
  }
}

TEST_CASE("a format is known by its extension, whatever its case") {
  const TemporaryFolder folder;
  for (const char* name : {"A.JSON", "b.Json"})
    CHECK_NOTHROW(load_scene(folder.write(name, R"({"objects": []})")));
  CHECK_FALSE(drops_alpha("picture.Exr"));
  const auto bytes = [](const char* name) {
    FrameOutput output;
    output.file = name;
    return bytes_a_pixel(output);
  };
  for (const auto& [name, other] : {std::pair("a.PFM", "a.pfm"), {"a.Hdr", "a.hdr"}, {"a.Part", "a.part"}})
    CHECK(bytes(name) == bytes(other));
}
