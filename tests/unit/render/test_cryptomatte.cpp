// Cryptomatte's ids, layers and header.
#include <bit>
#include <cmath>

#include "catch.h"
#include "render/film/cryptomatte.h"

using namespace sundog;

TEST_CASE("names hash as MurmurHash3 has them, whatever their length") {
  CHECK(hash_name("") == 0);
  CHECK(hash_name("test") == 0xba6bd213u);
  CHECK(hash_name("hello") == 0x248bfa47u);
  CHECK(hash_name("hello, world") == 0x149bbb7fu);
  CHECK(hash_name("The quick brown fox jumps over the lazy dog") == 0x2e4ff723u);
}

TEST_CASE("ids are floats that compositing programs can keep") {
  for (int i = 0; i < 20000; ++i)
    REQUIRE(std::isnormal(std::bit_cast<float>(id_bits("object " + std::to_string(i)))));
  CHECK(std::isnormal(std::bit_cast<float>(id_bits(""))));
}

TEST_CASE("four pairs of index and share become two layers of ids, and a header that names them") {
  AovImages aovs;
  aovs["depth"] = Image(1, 1, 1);
  Image pairs(2, 1, 8);
  pairs.data = {1, 0.5f, 0, 0.25f, 2, 0.125f, -1, 0, -1, 0, -1, 0, -1, 0, -1, 0};
  aovs["crypto_object"] = pairs;
  const ImageTexts texts = name_cryptomattes(aovs, {{"red", "blue \"one\"", ""}, {}});
  REQUIRE(aovs.size() == 3);
  const Image &first = aovs.at("crypto_object00"), &second = aovs.at("crypto_object01");
  const auto id = [](const char* name) { return std::bit_cast<float>(id_bits(name)); };
  CHECK(first.data == std::vector<float>{id("blue \"one\""), 0.5f, id("red"), 0.25f, 0, 0, 0, 0});
  CHECK(second.data == std::vector<float>{id("object 2"), 0.125f, 0, 0, 0, 0, 0, 0});
  REQUIRE(texts.size() == 4);
  CHECK(texts[0].first.starts_with("cryptomatte/"));
  CHECK(texts[0].first.ends_with("/name"));
  CHECK(texts[0].first.size() == 12 + 7 + 5);
  CHECK(texts[0].second == "crypto_object");
  CHECK(texts[3].second.find("\"blue \\\"one\\\"\":\"") != std::string::npos);
  CHECK(name_cryptomattes(aovs, {}).empty());
}
