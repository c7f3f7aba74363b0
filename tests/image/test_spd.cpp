// Ray counts of the Standard Procedural Databases (Haines 1987) against the published ones: 513 x 513 rays,
// depth 5, every ray followed. The counts "should all be within about 10%"; ours are printed.
#include <cmath>
#include <cstdio>

#include "assets.h"
#include "base/environment.h"
#include "catch.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"
#include "render/render.h"
#include "scene/load.h"

using namespace sundog;

namespace {

struct Published {
  const char* name;
  double eye_hits, reflection, refraction, shadow;
};

constexpr Published published[] = {{"balls", 263169, 175095, 0, 954368},
                                   {"mount", 173125, 354769, 354769, 412922},
                                   {"rings", 263169, 315236, 0, 1085002},
                                   {"tetra", 49788, 0, 0, 46112}};

void check_count(const char* scene, const char* what, std::uint64_t ours, double expected) {
  const auto found = static_cast<double>(ours);
  if (expected > 0)
    std::printf("  %-6s %-10s %8.0f published %8.0f (%+.2f %%)\n", scene, what, found, expected,
                100 * (found / expected - 1));
  INFO(scene << ", " << what);
  CHECK(std::abs(found - expected) <= 0.1 * expected);
}

}  // namespace

TEST_CASE("ray counts of the Standard Procedural Databases are the published ones", "[spd]") {
  const auto assets = assets_directory();
  if (assets.empty()) {
    std::printf("no assets: the ray counts of the Standard Procedural Databases were not compared\n");
    return;
  }
  const auto device = select_devices(enumerate_devices(plain_environment()), {});
  RenderOptions options;
  options.kernels = KernelChoice::general;  // several of the scenes share them
  for (const Published& p : published) {
    const SceneDescription scene =
        load_scene(assets / "reference" / "spd" / (std::string(p.name) + ".nff.gz"),
                   {"/image/width=513", "/image/height=513", "/render/max_depth=5", "/render/cutoff=0",
                    "/render/samples=1"});
    const RayCounts counts = render(compile(scene), device, options).counts;
    CHECK(counts[COUNT_PRIMARY] == 513u * 513u);
    check_count(p.name, "eye hits", counts[COUNT_PRIMARY_HIT], p.eye_hits);
    check_count(p.name, "reflection", counts[COUNT_REFLECTION], p.reflection);
    check_count(p.name, "refraction", counts[COUNT_REFRACTION], p.refraction);
    check_count(p.name, "shadow", counts[COUNT_SHADOW], p.shadow);
    CHECK(counts[COUNT_CUT_OFF] == 0);
    CHECK(counts[COUNT_RAY_STACK_OVERFLOW] == 0);
    CHECK(counts[COUNT_NON_FINITE] == 0);
  }
}
