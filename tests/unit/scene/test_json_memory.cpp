// A short text that would take much memory as values is refused by its length, before they are built.
#include "base/json_memory.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "catch.h"
#include "scene/json/parse.h"
#include "scene/json/value.h"

using namespace sundog;

namespace {

/// An array of so many of these.
std::string array_of(const std::string& item, std::size_t bytes) {
  std::string text = "{\"objects\":[" + item;
  while (text.size() < bytes) text += "," + item;
  return text + "]}";
}

}  // namespace

TEST_CASE("a text of millions of nearly empty values is refused, with the figures") {
  constexpr std::size_t bytes = std::size_t{12} << 20;
  for (const char* item : {"[]", "{}", "[[]]", "[0]", R"({"a":0})", R"({"":0})", R"("")"}) {
    CAPTURE(item);
    CHECK_THROWS_WITH(parse_json(array_of(item, bytes), "hostile.json"),
                      ContainsSubstring("hostile.json") && ContainsSubstring("MiB of memory") &&
                          ContainsSubstring("times the length of the file"));
  }
}

TEST_CASE("long texts of what scenes and models consist of are read") {
  constexpr std::size_t bytes = std::size_t{8} << 20;
  for (const char* item : {"[0,0,0]", "0", "[0.5,0.25]", R"({"mesh":12,"name":"a"})",
                           R"({"type":"sphere","center":[0,0,0],"radius":1,"material":"a"})"})
    CHECK_NOTHROW(check_json_memory(array_of(item, bytes), "scene.json"));
  CHECK_NOTHROW(parse_json(array_of("[]", std::size_t{1} << 20), "scene.json"));
}

TEST_CASE("brackets in strings and comments of a JSON text are no arrays") {
  const JsonCounts counts =
      count_json("{\"a[{\": [1, 2], // [ \" {\n \"b\\\"[\": {\"c\": \"/*\"}} /* [[[ \" */");
  CHECK(counts.containers == 3);
  CHECK(counts.keys == 3);
  CHECK(counts.strings == 4);
  CHECK(count_json("\"never ends\\").strings == 1);
  CHECK(count_json("1 / 2 /").values == 1);
}

TEST_CASE("the items of an array are made one by one") {
  const nlohmann::json list = {1, 2, "three", 4};
  const JsonContext context{.file = "list.json"};
  double sum = 0;
  const auto add_up = [&] {
    for (const JsonValue& item : JsonValue(list, context, "/list").items("numbers")) sum += item.number();
  };
  CHECK_THROWS_WITH(add_up(), ContainsSubstring("/list/2"));
  CHECK(sum == 3);
}
