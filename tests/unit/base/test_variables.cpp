// Variables that are set for drivers while other threads of the program read theirs.
#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>

#include "base/environment.h"
#include "catch.h"

using namespace sundog;

namespace {

std::string value(const std::string& name) {
  const char* found = std::getenv(name.c_str());
  return found ? found : "(none)";
}

}  // namespace

TEST_CASE("variables are set while other threads read theirs") {
  std::atomic<int> readers{0};
  std::atomic<bool> done{false};
  const auto read = [&] {
    ++readers;
    while (!done) static_cast<void>(std::getenv("SUNDOG_TEST_NOBODY_SETS"));
  };
  std::thread first(read), second(read);
  while (readers < 2) std::this_thread::yield();
  for (int i = 0; i < 300; ++i) set_variable("SUNDOG_TEST_" + std::to_string(i), std::to_string(i));
  done = true;
  first.join();
  second.join();
  for (int i = 0; i < 300; ++i) CHECK(value("SUNDOG_TEST_" + std::to_string(i)) == std::to_string(i));
}

TEST_CASE("a variable that is set stays, unless it is empty or to be replaced") {
  set_variable("SUNDOG_TEST_KEPT", "a");
  set_variable("SUNDOG_TEST_KEPT", "b");
  CHECK(value("SUNDOG_TEST_KEPT") == "a");
  set_variable("SUNDOG_TEST_KEPT", "c", true);
  CHECK(value("SUNDOG_TEST_KEPT") == "c");
  set_variable("SUNDOG_TEST_KEPT", "", true);
  set_variable("SUNDOG_TEST_KEPT", "d");
  CHECK(value("SUNDOG_TEST_KEPT") == "d");
  CHECK(::setenv("SUNDOG_TEST_KEPT", "e", 1) == 0);  // the C library's list begins with this one
  CHECK(value("SUNDOG_TEST_KEPT") == "e");
  CHECK(::unsetenv("SUNDOG_TEST_KEPT") == 0);
  CHECK(value("SUNDOG_TEST_KEPT") == "(none)");
}
