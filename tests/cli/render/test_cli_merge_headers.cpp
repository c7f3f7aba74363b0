// merge: parts whose header says what cannot be. Their checksum is right, as it is in a file made on purpose.
#include <base/file.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "catch.h"
#include "cli_scene.h"
#include "render/film/hash.h"

using namespace sundog;
using nlohmann::json;

namespace {

json good_header() {
  const json matrix = std::vector<double>(16, 0.5);
  const json shot = {{"camera", matrix}, {"ndc", matrix}, {"window", 1},   {"focus", nullptr},
                     {"frame", 1},       {"rate", 24},    {"exposure", 0}, {"next", nullptr}};
  return {{"format", "sundog part 3"},
          {"part", 1},
          {"parts", 1},
          {"key", 7},
          {"width", 4},
          {"height", 4},
          {"scene", "a.json"},
          {"aovs", json::array()},
          {"shot", shot},
          {"objects", json::array()},
          {"materials", json::array()},
          {"settings", json::object()}};
}

/// A part of 16 pixels, all of them done, with this header.
std::string part_file(const json& header, char done = 1) {
  const std::string bytes = header.dump() + "\n" + std::string(16, done) + std::string(16 * 20, '\0');
  return bytes + fmt::format("{:016x}", hash_bytes(bytes.data(), bytes.size()));
}

CommandResult merge(const CliFolder& folder, const std::string& part) {
  CommandOptions options;
  options.timeout = 20;
  return run_sundog({"merge", folder.write("bad.part", part).string(), "-o", folder.file("a.pfm")}, options);
}

json changed(const char* key, const json& value) {
  json header = good_header();
  header[key] = value;
  return header;
}

}  // namespace

TEST_CASE("a part of another version is refused with what to do") {
  const CliFolder folder;
  const CommandResult old = merge(folder, part_file(changed("format", "sundog part 2")));
  CHECK(old.status == 3);
  CHECK_THAT(old.err, ContainsSubstring("bad.part: is a part of another version of sundog: merge with that"));
}

TEST_CASE("a part whose header cannot be true is refused with status 3 and the file's name") {
  const CliFolder folder;
  REQUIRE(merge(folder, part_file(good_header())).status == 0);
  std::filesystem::remove(folder / "a.pfm");
  json many_pixels = changed("width", 65536);
  many_pixels["height"] = 65536;
  json many_aovs = changed("aovs", json::array());
  for (int i = 0; i < 7; ++i) many_aovs["aovs"].push_back("depth");
  for (const json& header : {changed("aovs", {"motion"}),
                             changed("parts", 536870912),
                             changed("parts", 100000000),
                             changed("parts", 0),
                             changed("part", 2),
                             changed("part", 0),
                             changed("parts", 4294967297),
                             changed("parts", 1.5),
                             changed("width", -1),
                             changed("width", 0),
                             changed("width", 2147483648),
                             changed("height", 1e300),
                             many_pixels,
                             changed("width", 16384),
                             changed("aovs", json::array({"dept"})),
                             many_aovs,
                             changed("aovs", 3),
                             changed("key", -1),
                             changed("scene", 3),
                             changed("settings", {{"samples", 4}}),
                             changed("shot", {{"camera", {1, 2}}}),
                             changed("shot", 3)}) {
    const CommandResult result = merge(folder, part_file(header));
    CAPTURE(header.dump().substr(0, 200), result.err);
    CHECK(result.status == 3);
    CHECK_FALSE(result.timed_out);
    CHECK(is_one_error_line(result.err));
    CHECK(result.err.size() < 500);
    CHECK(result.err.find(folder.file("bad.part")) != std::string::npos);
    CHECK(result.err.find("vector") == std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder / "a.pfm"));
  }
  CHECK(merge(folder, part_file(good_header(), 2)).status == 3);  // a pixel that is neither done nor not
}

TEST_CASE("a part whose header would take far more memory than its length is refused unread") {
  const CliFolder folder;
  const CommandResult result = merge(folder, part_file(changed("objects", json(3'000'000, json::array()))));
  CAPTURE(result.err.substr(0, 1000));
  CHECK(result.status == 3);
  CHECK(is_one_error_line(result.err));
  CHECK(result.err.find("MiB of memory") != std::string::npos);
}

TEST_CASE("a list of many missing parts is shortened") {
  const CliFolder folder;
  json header = changed("parts", 65536);
  header["part"] = 65536;  // beyond the bands that there are: its rows are none
  const CommandResult result = merge(folder, part_file(header));
  CAPTURE(result.err.substr(0, 1000));
  CHECK(result.status == 3);
  CHECK(result.err.size() < 500);
  CHECK(result.err.find("parts 1, 2, 3, 4, 5, 6, 7, 8 and 65527 more of 65536 are missing") !=
        std::string::npos);
}

TEST_CASE("parts that differ in long settings give a short message") {
  const CliFolder folder;
  json one = changed("parts", 2), other = changed("parts", 2);
  other["part"] = 2;
  other["key"] = 8;
  for (int i = 0; i < 1000; ++i) other["settings"][fmt::format("--set /{}", i)] = std::string(1000, 'x');
  folder.write("one.part", part_file(one));
  folder.write("other.part", part_file(other));
  const CommandResult result =
      run_sundog({"merge", folder.file("one.part"), folder.file("other.part"), "-o", folder.file("a.pfm")});
  CAPTURE(result.err.substr(0, 2000));
  CHECK(result.status == 3);
  CHECK(result.err.size() < 2000);
  CHECK(result.err.find("and 992 more") != std::string::npos);
}

TEST_CASE("what a part's header says stands in messages without control characters") {
  const CliFolder folder;
  folder.write("good.part", part_file(changed("parts", 2)));
  json other = changed("parts", 2);
  other["part"] = 2;
  other["key"] = 8;
  other["scene"] = "a\x1b[31m\nb";
  folder.write("other.part", part_file(other));
  const CommandResult result =
      run_sundog({"merge", folder.file("good.part"), folder.file("other.part"), "-o", folder.file("a.pfm")});
  CHECK(result.status == 3);
  CHECK(is_one_error_line(result.err));
  CHECK(result.err.find('\x1b') == std::string::npos);
}
