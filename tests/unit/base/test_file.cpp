// Files appear whole or not at all.
#include <base/error.h>
#include <base/file.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "catch.h"
#include "temporary_folder.h"

using namespace sundog;

TEST_CASE("a written file is read again, and replaces an older one") {
  const TemporaryFolder folder;
  const std::string bytes(200000, '\0');
  write_file(folder / "a", "old");
  write_file(folder / "a", bytes);
  CHECK(read_file(folder / "a") == bytes);
  CHECK(folder.entries() == 1);
  write_file(folder / "a", "");
  CHECK(read_file(folder / "a").empty());
}

TEST_CASE("a file that cannot be written whole leaves the old one and nothing else") {
  const TemporaryFolder folder;
  write_file(folder / "a", "old");
  const pid_t child = ::fork();
  if (child == 0) {  // in a process of its own: a limit on file sizes cannot be taken back
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_file(folder / "a", std::string(100000, 'x'));
    } catch (const IoError& error) {
      ::_exit(std::string(error.what()).find("a: cannot be written: ") != std::string::npos ? 0 : 2);
    }
    ::_exit(1);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(status == 0);
  CHECK(read_file(folder / "a") == "old");
  CHECK(folder.entries() == 1);
}

TEST_CASE("check_writable tells what is wrong before the work is done") {
  const TemporaryFolder folder;
  CHECK_NOTHROW(check_writable(folder / "a.png"));
  CHECK_NOTHROW(check_writable("a.png"));
  CHECK_THROWS_AS(check_writable(folder.path()), IoError);
  CHECK_THROWS_AS(check_writable(folder / "none/a.png"), IoError);
  folder.write("file", "");
  CHECK_THROWS_AS(check_writable(folder / "file/a.png"), IoError);
  CHECK_THROWS_WITH(check_writable(folder / std::string(300, 'a')), ContainsSubstring("File name too long"));
  std::filesystem::create_symlink("loop", folder / "loop");
  CHECK_THROWS_WITH(check_writable(folder / "loop"), ContainsSubstring("symbolic links"));
}

TEST_CASE("a link is followed to what it names, which is replaced as a whole") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "real");
  std::filesystem::create_symlink("real/b", folder / "a");
  std::filesystem::create_symlink("a", folder / "c");
  write_file(folder / "c", "one");
  CHECK(read_file(folder / "real/b") == "one");
  const std::string longest = "real/" + std::string(255, 'x');  // no room for what a temporary adds
  write_file(folder / longest, "two");
  CHECK(read_file(folder / longest) == "two");
  CHECK(std::filesystem::is_symlink(folder / "a"));
  CHECK(std::filesystem::is_symlink(folder / "c"));
  CHECK(folder.entries() == 3);
}

TEST_CASE("a pipe is written into, and stays one") {
  const TemporaryFolder folder;
  const std::string pipe = (folder / "pipe").string();
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  CHECK_NOTHROW(check_writable(pipe));
  write_file(pipe, "bytes");
  std::string found(9, '-');
  CHECK(::read(reader, found.data(), found.size()) == 5);
  ::close(reader);
  CHECK(found == "bytes----");
  CHECK(std::filesystem::is_fifo(pipe));
  CHECK(folder.entries() == 1);
}
