// Shared structs lie in a device's memory as they do in the host's.
#include <cstddef>

#include "base/file.h"
#include "catch.h"
#include "devices.h"
#include "shared/bvh.h"
#include "shared/environment.h"
#include "shared/halo.h"
#include "shared/launch.h"
#include "shared/layers.h"
#include "shared/photons.h"
#include "shared/scene.h"
#include "shared/sdf.h"
#include "shared/textures.h"

using namespace sundog;

namespace {

struct Place {
  const char* what;
  u32 host;
};

const Place places[] = {
#define SUNDOG_STRUCT(type) {"sizeof(" #type ")", sizeof(type)},
#define SUNDOG_MEMBER(type, member) {#type "." #member, offsetof(type, member)},
#include "shared_layout.h"
#undef SUNDOG_STRUCT
#undef SUNDOG_MEMBER
};

const std::string probe = R"(
#include "shared/bvh.h"
#include "shared/environment.h"
#include "shared/halo.h"
#include "shared/layers.h"
#include "shared/launch.h"
#include "shared/photons.h"
#include "shared/scene.h"
#include "shared/sdf.h"
#include "shared/textures.h"
#define SUNDOG_STRUCT(type) places[n++] = (u32)sizeof(type);
#define SUNDOG_MEMBER(type, member) \
  { type probed; places[n++] = (u32)((size_t)&probed.member - (size_t)&probed); }
__kernel void probe_layout(__global u32* places) {
  u32 n = 0;
#include "generated/shared_layout.h"
}
)";

}  // namespace

TEST_CASE("every member of every shared struct has the same offset on the host and on each device") {
  REQUIRE(std::size(places) > 80);  // the list was read from the headers, and they have not shrunk to nothing
  const GeneratedFiles files = {{"probe.cl", probe},
                                {"generated/shared_layout.h", read_file(SUNDOG_SHARED_LAYOUT)}};
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    auto kernel = device.build("probe.cl", {}, nullptr, files).kernel<Buffer<u32>>("probe_layout");
    const auto memory = device.make<u32>(std::size(places));
    device.run(kernel, {.x = 1, .local_x = 1}, memory);
    std::vector<u32> found(std::size(places));
    device.read(memory, std::span<u32>(found));
    for (std::size_t i = 0; i < found.size(); ++i) {
      INFO(places[i].what);
      CHECK(found[i] == places[i].host);
    }
  });
}
