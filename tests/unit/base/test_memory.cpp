// How much memory there is, and how much a frame takes.
#include <base/memory.h>

#include "catch.h"
#include "temporary_folder.h"

using namespace sundog;

TEST_CASE("the memory available is the machine's, or what a cgroup leaves") {
  constexpr std::uint64_t mib = 1 << 20;
  const TemporaryFolder root;
  const auto available = [&] { return available_memory(root.path()); };
  CHECK_FALSE(available());
  root.write("proc/meminfo", "MemTotal:       9999999 kB\nMemAvailable:    4096000 kB\n");
  CHECK(available() == 4000 * mib);

  SECTION("version 2: the least of a group and those around it, files that can go being free") {
    root.write("proc/self/cgroup", "0::/job.slice/step\n");
    root.write("sys/fs/cgroup/job.slice/memory.max", std::to_string(3000 * mib));
    root.write("sys/fs/cgroup/job.slice/memory.current", std::to_string(1000 * mib));
    root.write("sys/fs/cgroup/job.slice/memory.stat",
               "anon 1\ninactive_file " + std::to_string(500 * mib) + "\n");
    CHECK(available() == 2500 * mib);
    root.write("sys/fs/cgroup/job.slice/step/memory.max", "max\n");
    root.write("sys/fs/cgroup/job.slice/step/memory.current", "5\n");
    CHECK(available() == 2500 * mib);
    root.write("sys/fs/cgroup/job.slice/memory.current", std::to_string(9000 * mib));
    CHECK(available() == 0);
  }
  SECTION("version 2 in a container, which sees its own group at the root") {
    root.write("proc/self/cgroup", "0::/\n");
    root.write("sys/fs/cgroup/memory.max", std::to_string(300 * mib));
    root.write("sys/fs/cgroup/memory.current", std::to_string(100 * mib));
    CHECK(available() == 200 * mib);
  }
  SECTION("version 1") {
    root.write("proc/self/cgroup", "9:cpu,cpuacct:/a\n7:memory:/a\n0::/\n");
    root.write("sys/fs/cgroup/memory/a/memory.limit_in_bytes", std::to_string(700 * mib));
    root.write("sys/fs/cgroup/memory/a/memory.usage_in_bytes", std::to_string(100 * mib));
    CHECK(available() == 600 * mib);
  }
}

TEST_CASE("this machine says how much memory it has available") {
  REQUIRE(available_memory());
  CHECK(*available_memory() > 1 << 20);
}
