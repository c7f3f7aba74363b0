// Inputs are regular files of bounded size: a pipe is not waited for, a device not read without end.
#include <base/error.h>
#include <base/input.h>
#include <sys/stat.h>
#include <unistd.h>

#include "catch.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

std::string error_of(const std::filesystem::path& path, std::uintmax_t most = most_input_bytes) {
  try {
    read_input(path, most);
    return "";
  } catch (const SceneError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("only regular files are read, and no writer of a pipe is waited for") {
  const TemporaryFolder folder;
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  std::filesystem::create_symlink("/dev/zero", folder / "endless");
  for (const char* name : {"pipe", "endless"})
    CHECK(error_of(folder / name) ==
          (folder / name).string() + ": is no regular file, but a pipe or a device");
  CHECK(error_of(folder.path()) == folder.path().string() + ": is a directory");
  CHECK(error_of(folder / "none") ==
        (folder / "none").string() + ": cannot be read: No such file or directory");
}

TEST_CASE("a file larger than is believed is not read") {
  const TemporaryFolder folder;
  folder.write("large", "");
  std::filesystem::resize_file(folder / "large", most_input_bytes + 1);  // sparse
  CHECK(error_of(folder / "large") == (folder / "large").string() + ": is larger than 2048 MiB");
  folder.write("small", "12345");
  CHECK(error_of(folder / "small", 4) == (folder / "small").string() + ": is larger than 4 bytes");
  CHECK(read_input(folder / "small", 5) == "12345");
}

TEST_CASE("a pipe that the program was given is read to its end") {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const std::string text(10000, 'x');
  REQUIRE(::write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  ::close(ends[1]);
  CHECK(read_input("/dev/fd/" + std::to_string(ends[0])) == text);
  ::close(ends[0]);
}
