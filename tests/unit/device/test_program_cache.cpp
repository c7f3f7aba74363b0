// The binary cache's files: only what was stored for a key comes back, and the folder stays small.
#include <random>

#include "base/error.h"
#include "base/file.h"
#include "catch.h"
#include "device/program_cache.h"
#include "temporary_folder.h"

using namespace sundog;

TEST_CASE("hash128 is FNV-1a") {
  CHECK(hash128("") == "6c62272e07bb014262b821756295c58d");
  CHECK(hash128("a") == "d228cb696f1a8caf78912b704e4a8964");
  CHECK(hash128("foobar") == "343e1662793c64bf6f0d3597ba446f18");
}

TEST_CASE("a stored program comes back for its own key alone") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "sub" / "one.bin";
  const CachedProgram program{std::string("\0\1binary\n", 9), {"f 64x1 small", "g 8x8 large"}};
  store_program(file, "key", program);
  const auto loaded = load_program(file, "key");
  REQUIRE(loaded);
  CHECK(loaded->binary == program.binary);
  CHECK(loaded->variants == program.variants);
  CHECK(!load_program(file, "other key"));
  CHECK(!load_program(folder.path() / "two.bin", "key"));
}

TEST_CASE("a stored program takes less room than its key, which holds the kernel's source") {
  const TemporaryFolder folder;
  std::string key;
  for (int i = 0; i < 10000; ++i) key += "float x" + std::to_string(i) + ";\n";
  store_program(folder.path() / "one.bin", key, {"binary", {"f"}});
  CHECK(std::filesystem::file_size(folder.path() / "one.bin") < key.size() / 3);
  CHECK(load_program(folder.path() / "one.bin", key));
}

TEST_CASE("no single changed, missing or added byte of a stored program goes unnoticed") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "one.bin";
  store_program(file, "key", {"binary", {"f"}});
  const std::string good = read_file(file);
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] ^= 1;
    write_file(file, bad);
    accepted += load_program(file, "key").has_value();
    write_file(file, good.substr(0, i));
    accepted += load_program(file, "key").has_value();
  }
  write_file(file, good + '\0');
  accepted += load_program(file, "key").has_value();
  CHECK(accepted == 0);
}

TEST_CASE("storing removes the programs used longest ago once the folder is too large") {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  std::mt19937 random;
  std::string binary(1000, '\0');  // which nothing packs
  for (char& byte : binary) byte = static_cast<char>(random());
  for (const char* name : {"a", "b", "c"}) store_program(folder.path() / name, name, {binary, {}});
  const auto now = fs::file_time_type::clock::now();
  fs::last_write_time(folder.path() / "a", now - std::chrono::hours(3));
  fs::last_write_time(folder.path() / "b", now - std::chrono::hours(2));
  fs::last_write_time(folder.path() / "c", now - std::chrono::hours(1));
  CHECK(load_program(folder.path() / "a", "a"));  // used just now
  store_program(folder.path() / "d", "d", {binary, {}}, 2500);
  CHECK(fs::exists(folder.path() / "a"));
  CHECK(!fs::exists(folder.path() / "b"));
  CHECK(!fs::exists(folder.path() / "c"));
  CHECK(fs::exists(folder.path() / "d"));
}

TEST_CASE("a cache folder that cannot be made is an IoError") {
  const TemporaryFolder folder;
  write_file(folder.path() / "file", "");
  CHECK_THROWS_AS(store_program(folder.path() / "file" / "one.bin", "key", {"binary", {}}), IoError);
}
