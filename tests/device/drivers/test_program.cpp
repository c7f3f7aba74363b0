// Programs: built, refused with file and line, kept in the binary cache.
#include <sys/stat.h>

#include <functional>

#include "base/cache_folder.h"
#include "base/deflate.h"
#include "base/environment.h"
#include "base/error.h"
#include "base/file.h"
#include "catch.h"
#include "device/program_cache.h"
#include "devices.h"
#include "shared/bvh.h"
#include "temporary_folder.h"

using namespace sundog;
namespace fs = std::filesystem;

namespace {

const std::string add_kernel = R"(
__kernel void add(__global float* values, float what, uint count) {
  const uint i = get_global_id(0);
  if (i < count) values[i] += what;
}
)";

/// Builds and runs the add kernel; what the build said.
BuildReport add_on(const DeviceInfo& info, const std::string& text = add_kernel, std::size_t local = 64) {
  Device device(info);
  BuildReport report;
  auto add = device.build("add.cl", {}, &report, {{"add.cl", text}}).kernel<Buffer<float>, float, u32>("add");
  const auto values = device.upload<float>(std::vector<float>(100, 1.0f));
  device.run(add, {.x = values.count, .local_x = local}, values, 2.5f, 100u);
  std::vector<float> result(values.count);
  device.read(values, std::span<float>(result));
  CHECK(result == std::vector<float>(100, 3.5f));
  return report;
}

std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  if (fs::exists(folder))
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  return files;
}

/// The key of a cache file: after magic and checksum stand the sizes of key, variants and binary, 20 digits
/// each, then the three as one zlib stream.
std::string key_of(const fs::path& file) {
  const std::string stored = read_file(file);
  const std::size_t sizes = stored.find('\n') + 1 + 32;
  const auto size = [&](std::size_t field) { return std::stoul(stored.substr(sizes + field * 20, 20)); };
  const std::string body = inflated(stored.substr(sizes + 60), size(0) + size(1) + size(2)).value();
  return body.substr(0, size(0));
}

/// The device, with another environment.
DeviceInfo changed(DeviceInfo info, const std::function<void(HostEnvironment&)>& change) {
  HostEnvironment environment = value_of(info.environment);
  change(environment);
  info.environment = std::make_shared<const HostEnvironment>(std::move(environment));
  return info;
}

/// A cache folder of this test's own.
struct OwnCache {
  TemporaryFolder folder;
  fs::path kernels() const { return folder.path() / "sundog" / "kernels"; }
  DeviceInfo with(const DeviceInfo& info) const {
    return changed(info, [&](HostEnvironment& environment) {
      environment.cache = folder.path() / "sundog";
      environment.kernel_cache = true;
    });
  }
};

}  // namespace

TEST_CASE("a program is compiled once and comes from the cache after that") {
  on_every_device([&](const DeviceInfo& device) {
    const OwnCache cache;
    const DeviceInfo info = cache.with(device);
    CHECK(!add_on(info).cached);
    CHECK(files_of(cache.kernels()).size() == 1);
    const BuildReport second = add_on(info);
    CHECK(second.cached);
    CHECK(second.note.empty());
    CHECK(add_on(info, add_kernel, 8).cached);  // another local size
    CHECK(!add_on(info, add_kernel + " ").cached);
    CHECK(files_of(cache.kernels()).size() == 2);
  });
}

TEST_CASE("a damaged cache file is compiled anew and replaced") {
  on_every_device([&](const DeviceInfo& device) {
    const OwnCache cache;
    const DeviceInfo info = cache.with(device);
    add_on(info);
    const auto files = files_of(cache.kernels());
    REQUIRE(files.size() == 1);
    const std::string good = read_file(files[0]);
    std::string flipped = good;
    flipped[flipped.size() / 2] ^= 1;
    for (const std::string& bad :
         {flipped, good.substr(0, good.size() - 1), good + "x", std::string(), std::string("\0\0", 2)}) {
      write_file(files[0], bad);
      CHECK(!add_on(info).cached);
      CHECK(add_on(info).cached);
    }
  });
}

TEST_CASE("a binary that the driver refuses is compiled anew, and the report says so") {
  for (const DeviceInfo& device : test_devices()) {
    if (device.platform_name == "rusticl")
      continue;  // aborts the process for a binary that is not its own (Mesa 22.3)
    DYNAMIC_SECTION(device.label()) {
      const OwnCache cache;
      const DeviceInfo info = cache.with(device);
      add_on(info);
      const auto files = files_of(cache.kernels());
      REQUIRE(files.size() == 1);
      const std::string key = key_of(files[0]);
      REQUIRE(load_program(files[0], key));
      // A file that is sound in itself, of the right key, with a binary that is none.
      store_program(files[0], key, {"this is no binary", {}});
      const BuildReport report = add_on(info);
      CHECK(!report.cached);
      CHECK_THAT(report.note, ContainsSubstring("refused"));
      CHECK(add_on(info).cached);
    }
  }
}

TEST_CASE("an unusable cache folder costs time and nothing else") {
  const OwnCache cache;
  const DeviceInfo info = cache.with(test_devices().front());
  write_file(cache.folder.path() / "sundog", "a file where the folder should be");
  CHECK(!add_on(info).cached);
  CHECK(!add_on(info).cached);
  CHECK_THAT(cache_refusal(cache.folder.path() / "sundog"), ContainsSubstring("is not a folder"));
  CHECK(fs::is_regular_file(cache.folder.path() / "sundog"));
}

TEST_CASE("without a kernel cache a program neither reads nor writes the cache") {
  const OwnCache cache;
  const DeviceInfo info = cache.with(test_devices().front());
  add_on(info);
  const DeviceInfo off = changed(info, [](HostEnvironment& e) { e.kernel_cache = false; });
  CHECK(!add_on(off).cached);
  CHECK(!add_on(off, add_kernel + "\n").cached);
  CHECK(files_of(cache.kernels()).size() == 1);
}

TEST_CASE("a build error names the kernel file and the line, and carries the compiler's log") {
  const GeneratedFiles files = {
      {"main.cl", "#include \"shared/types.h\"\n#include \"lib/wrong.cl\"\n"},
      {"lib/wrong.cl", "// One line.\n__kernel void f(__global u32* a) {\n  a[0] = undeclared;\n}\n"}};
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    try {
      device.build("main.cl", {}, nullptr, files);
      FAIL("it built");
    } catch (const BuildError& error) {
      CHECK_THAT(error.what(), ContainsSubstring("main.cl did not build on"));
      CHECK_THAT(error.what(), ContainsSubstring("lib/wrong.cl:3"));
      CHECK_THAT(error.log, ContainsSubstring("undeclared"));
    }
  });
}

TEST_CASE("a kernel that is not in the program is a build error") {
  Device device(test_devices().front());
  const Program program = build_text(device, add_kernel);
  CHECK_THROWS_AS(program.kernel<Buffer<float>>("subtract"), BuildError);
  CHECK_THROWS_AS(Program().kernel<>("add"), BuildError);
}

TEST_CASE("a folder for texts keeps the text that the compiler gets") {
  const TemporaryFolder folder;
  Device device(changed(test_devices().front(),
                        [&](HostEnvironment& environment) { environment.dump_folder = folder.path(); }));
  build_text(device, add_kernel, {{"WIDTH", "8"}});
  const auto files = files_of(folder.path());
  REQUIRE(files.size() == 1);
  CHECK_THAT(read_file(files[0]),
             ContainsSubstring("#define WIDTH 8") && ContainsSubstring("values[i] += what;"));
}

TEST_CASE("the user's options reach the compiler and are part of what the cache knows a program by") {
  const std::string text = add_kernel +
                           "#ifndef FROM_OUTSIDE\n#error not defined\n#endif\n"
                           "__kernel void tell(__global uint* value) { value[0] = FROM_OUTSIDE; }\n";
  on_every_device([&](const DeviceInfo& tested) {
    const OwnCache cache;
    const DeviceInfo info = cache.with(tested);
    const auto told = [&](const char* options, bool* cached) {
      Device device(changed(info, [&](HostEnvironment& e) { e.build_options = options; }));
      BuildReport report;
      auto tell = device.build("add.cl", {}, &report, {{"add.cl", text}}).kernel<Buffer<u32>>("tell");
      *cached = report.cached;
      const auto value = device.make<u32>(1);
      device.run(tell, {1, 1, 1, 1}, value);
      std::vector<u32> result(1);
      device.read(value, std::span<u32>(result));
      return result[0];
    };
    bool cached = true;
    CHECK(told("-DFROM_OUTSIDE=7", &cached) == 7);
    CHECK(!cached);
    CHECK(told("-DFROM_OUTSIDE=8", &cached) == 8);
    CHECK(!cached);
    CHECK(told("-DFROM_OUTSIDE=7", &cached) == 7);
    CHECK(cached);
  });
}

TEST_CASE("options that the compiler refuses are an error that names the variable") {
  on_every_device([&](const DeviceInfo& on) {
    const OwnCache cache;
    const DeviceInfo info =
        changed(cache.with(on), [](HostEnvironment& e) { e.build_options = "--no-such-option"; });
    Device device(info);
    CHECK_THROWS_WITH(build_text(device, add_kernel),
                      ContainsSubstring("SUNDOG_BUILD_OPTIONS '--no-such-option': " + info.label()));
  });
}

TEST_CASE("an error of a kernel is its own, whatever options were given") {
  Device device(changed(test_devices().front(), [](HostEnvironment& e) { e.build_options = "-DANYTHING"; }));
  CHECK_THROWS_WITH(build_text(device, "__kernel void f(__global float* a) { a[0] = undeclared; }"),
                    ContainsSubstring("did not build on"));
}

TEST_CASE("a folder for logs keeps log, options and source of each program, cached or not") {
  const GeneratedFiles bad = {{"bad.cl", "__kernel void f(__global float* a) { a[0] = undeclared; }"}};
  on_every_device([&](const DeviceInfo& on) {
    const OwnCache cache;
    add_on(cache.with(on));
    const TemporaryFolder folder;
    const DeviceInfo info =
        changed(cache.with(on), [&](HostEnvironment& environment) { environment.build_log = folder.path(); });
    CHECK(!add_on(info).cached);
    auto files = files_of(folder.path());
    REQUIRE(files.size() == 1);
    CHECK_THAT(read_file(files[0]),
               ContainsSubstring("program  add.cl") && ContainsSubstring(info.label()) &&
                   ContainsSubstring(info.driver) && ContainsSubstring("options  -cl-std=CL1.2") &&
                   ContainsSubstring("status   CL_SUCCESS") && ContainsSubstring("values[i] += what;"));
    fs::remove(files[0]);
    Device device(info);
    CHECK_THROWS_AS(device.build("bad.cl", {}, nullptr, bad), BuildError);
    files = files_of(folder.path());
    REQUIRE(files.size() == 1);
    CHECK_THAT(read_file(files[0]), ContainsSubstring("undeclared identifier"));
  });
}

TEST_CASE("a kernel tells how large its groups may be") {
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const Program program = build_text(device, add_kernel);
    CHECK(program.kernel_names() == std::vector<std::string>{"add"});
    const KernelLimits limits = device.limits(program.kernel<>("add"));
    CHECK(limits.work_group > 0);
    CHECK(limits.work_group <= info.max_work_group);
    CHECK(limits.preferred_multiple > 0);
  });
}

TEST_CASE("a kernel's parameter types are known by their names") {
  const std::string text =
      "#include \"shared/bvh.h\"\n"
      "__kernel void f(__global const Ray* rays, __global Hit* hits, u32 count, float4 v) {}\n";
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto types = argument_types(build_text(device, text).kernel<>("f").kernel);
    CHECK(types == std::vector<std::string>{"Ray*", "Hit*", "u32", "float4"});
  });
}

TEST_CASE("a kernel whose parameters are not those that the host passes is refused") {
  const std::string text =
      "#include \"shared/bvh.h\"\n"
      "__kernel void f(__global const Ray* rays, __global Hit* hits, uint count, int offset) {}\n";
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const Program program = build_text(device, text);
    CHECK_NOTHROW(program.kernel<Buffer<Ray>, Buffer<Hit>, u32, i32>("f"));
    CHECK_THROWS_WITH(
        (program.kernel<Buffer<Hit>, Buffer<Ray>, u32, i32>("f")),
        "test.cl: kernel f takes (Ray*, Hit*, u32, i32), the host passes (Hit*, Ray*, u32, i32)");
    CHECK_THROWS_AS((program.kernel<Buffer<Ray>, Buffer<Hit>, i32, u32>("f")), BuildError);
    CHECK_THROWS_AS((program.kernel<Buffer<Ray>, Buffer<Hit>, u32>("f")), BuildError);
  });
}
