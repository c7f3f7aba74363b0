// Files appear whole or not at all.
#include <base/error.h>
#include <base/file.h>
#include <sys/resource.h>
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
}
