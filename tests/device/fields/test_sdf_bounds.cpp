// The bound of estimates beyond the list's defaults: parameters at the ends of their ranges, hybrids,
// operations, formulas of the user's own. Each field is read from a scene, so that its safety is what a scene
// would get.
#include <fmt/format.h>

#include <random>

#include "scene/load.h"
#include "sdf_bound.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

struct Case {
  const char* json;  // members of the object besides material
  double exceptions = 0;
  bool any_length = false;
};

const std::string box = R"("interval": {"min": [-1.5, -1.5, -1.5], "max": [1.5, 1.5, 1.5]})";

std::vector<SdfDescription> read_fields(const std::vector<Case>& cases) {
  std::string objects;
  for (const Case& c : cases) {
    const bool has_interval = std::string(c.json).find("\"interval\"") != std::string::npos ||
                              std::string(c.json).find("\"fractal\"") == 9;
    objects += fmt::format(R"({}{{"material": "m", {}{}}})", objects.empty() ? "" : ",\n", c.json,
                           has_interval ? "" : ", " + box);
  }
  const TemporaryFolder folder;
  return load_scene(folder.write("scene.json",
                                 fmt::format(R"({{"materials": {{"m": {{}}}}, "objects": [{}]}})", objects)))
      .fields;
}

void check_bounds(const std::vector<Case>& cases) {
  const auto descriptions = read_fields(cases);
  REQUIRE(descriptions.size() == cases.size());
  const CompiledFields fields = compile_fields(descriptions);
  on_every_device([&](const DeviceInfo& info) {
    if (!is_quick(info)) return;
    Device device(info);
    BoundTester tester(device, fields);
    for (u32 f = 0; f < cases.size(); ++f) {
      INFO(cases[f].json);
      check_bound(tester.ratios(f, 20480), cases[f].exceptions, cases[f].any_length);
      if (const SdfNode& root = descriptions[f].root; root.kind == SdfNode::Kind::formula)
        check_against_doubles(tester.places(), root.formula);
    }
  });
}

// The greatest difference of the gradient and central differences among random points, but for a hundredth of
// them, which lie across a seam.
const char* const gradient_kernel = R"(
#include "lib/sdf/surface.cl"
__kernel void gradients(__global const float* q, __global const float* points, __global float* errors, u32 field, u32 count) {
  const u32 i = get_global_id(0);
  if (i >= count) return;
  const REAL3 p = real3((REAL)(points[3 * i]), (REAL)(points[3 * i + 1]), (REAL)(points[3 * i + 2]));
  const float h = 2e-3f;
  const REAL3 g = sdf_sample(field, p, q).gradient;
  const REAL3 d = real3(
    (sdf_signed(field, real3(p.x + h, p.y, p.z), ALL_LANES, q) - sdf_signed(field, real3(p.x - h, p.y, p.z), ALL_LANES, q)) / (2 * h),
    (sdf_signed(field, real3(p.x, p.y + h, p.z), ALL_LANES, q) - sdf_signed(field, real3(p.x, p.y - h, p.z), ALL_LANES, q)) / (2 * h),
    (sdf_signed(field, real3(p.x, p.y, p.z + h), ALL_LANES, q) - sdf_signed(field, real3(p.x, p.y, p.z - h), ALL_LANES, q)) / (2 * h));
  errors[i] = length3(subtract3(g, d));
}
)";

float gradient_error(Device& device, const CompiledFields& fields, u32 field) {
  auto kernel = build_fields(device, gradient_kernel, fields, 1)
                    .kernel<Buffer<float>, Buffer<float>, Buffer<float>, u32, u32>("gradients");
  constexpr u32 count = 1024;
  std::mt19937 random(field);
  std::uniform_real_distribution<float> uniform(-1.4f, 1.4f);
  std::vector<float> points(3 * count), errors(count);
  for (float& x : points) x = uniform(random);
  const auto q = device.upload<float>(fields.parameters), in = device.upload<float>(points);
  auto out = device.make<float>(count);
  device.run(kernel, {.x = count, .local_x = 16}, q, in, out, field, count);
  device.read(out, std::span<float>(errors));
  device.finish();
  std::sort(errors.begin(), errors.end());
  return errors[count - count / 100];
}

}  // namespace

TEST_CASE("closed forms, a user's among them, and their smooth joints have the gradient of their distance") {
  const std::vector<Case> cases{
      {R"f("type": "formula", "distance": "10 * (length(p) - 0.8)")f"},
      {R"f("type": "formula", "distance": "length(p) - 0.8 + 0.05 * sin(9 * p.x)")f"},
      {R"f("type": "union", "smooth": 0.6, "fields": [{"type": "formula", "distance": "4 * (length(p) - 0.6)", "safety": 0.2}, {"type": "moved", "translate": [0.5, 0.4, 0], "rotate": {"axis": [1, 2, 3], "degrees": 40}, "scale": 0.8, "field": {"type": "formula", "distance": "p.x * p.x + p.y * p.y + 2 * p.z * p.z - 0.4", "safety": 0.2}}])f"},
      {R"f("type": "difference", "smooth": 0.4, "fields": [{"type": "fractal", "formula": "sphere"}, {"type": "moved", "translate": [0.5, 0.4, 0], "field": {"type": "fractal", "formula": "torus"}}])f"},
      {R"f("type": "shell", "amount": 0.1, "field": {"type": "intersection", "smooth": 0.3, "fields": [{"type": "fractal", "formula": "box"}, {"type": "fractal", "formula": "sphere"}]})f"},
  };
  const auto descriptions = read_fields(cases);
  const CompiledFields fields = compile_fields(descriptions);
  on_every_device([&](const DeviceInfo& info) {
    if (!is_quick(info)) return;
    Device device(info);
    for (u32 f = 0; f < cases.size(); ++f) {
      INFO(cases[f].json);
      CHECK((fields.fields[f].flags & SDF_SMOOTH) != 0);
      CHECK(gradient_error(device, fields, f) < 4e-3f);
    }
  });
}

TEST_CASE("estimates keep their bound with parameters at the ends of their ranges") {
  check_bounds({
      {R"f("type": "fractal", "formula": "mandelbulb", "parameters": {"power": 2})f", 0.01},
      {R"f("type": "fractal", "formula": "mandelbulb", "parameters": {"power": 1.5})f", 0.01},
      {R"f("type": "fractal", "formula": "mandelbulb", "parameters": {"power": 16})f", 0.01},
      {R"("type": "fractal", "formula": "juliabulb", "parameters": {"power": 2, "seed": [-0.2, 0.7, 0.1]})",
       0.01},
      {R"f("type": "fractal", "formula": "julia", "parameters": {"power": 3, "seed": [0.3, 0.5, 0.1, 0.2], "slice": 0.3})f"},
      {R"f("type": "fractal", "formula": "julia", "parameters": {"power": 16, "seed": [0.3, 0.5, 0.1, 0.2]})f"},
      {R"f("type": "fractal", "formula": "quaternion_mandelbrot", "parameters": {"power": 8, "slice": 0.2})f"},
      {R"f("type": "fractal", "formula": "bicomplex", "parameters": {"slice": 0.3})f"},
      {R"f("type": "fractal", "formula": "mandelbox", "parameters": {"scale": -1.5})f", 0.01},
      {R"f("type": "fractal", "formula": "mandelbox", "parameters": {"scale": 4})f"},
      {R"f("type": "fractal", "formula": "mandelbox", "parameters": {"scale": -4})f"},
      {R"f("type": "fractal", "formula": "mandelbox", "parameters": {"scale": 1.5}, "interval": {"min": [-12, -12, -12], "max": [12, 12, 12]})f",
       0.01},
      {R"f("type": "fractal", "formula": "mandelbox", "parameters": {"scale": 2, "least_radius": 0.1})f"},
      {R"f("type": "fractal", "formula": "amazing_surf", "parameters": {"scale": -1.8, "angle": 90})f", 0.01},
      {R"f("type": "fractal", "formula": "menger", "parameters": {"scale": 1.5, "angle": 45})f"},
      {R"f("type": "fractal", "formula": "menger", "parameters": {"scale": 6, "offset": [1, 0.5, 0.3]})f"},
      {R"f("type": "fractal", "formula": "sierpinski", "parameters": {"scale": 1.2, "angle": -30, "axis": [1, 1, 0]})f"},
      {R"f("type": "fractal", "formula": "octahedron_flake", "parameters": {"scale": 1.5, "angle": 180})f"},
      {R"f("type": "fractal", "formula": "icosahedron_flake", "parameters": {"scale": 1.5, "angle": 20})f"},
      {R"f("type": "fractal", "formula": "apollonian", "parameters": {"scale": 0.8})f"},
      {R"f("type": "fractal", "formula": "apollonian", "parameters": {"scale": 2, "thickness": 0.2})f"},
      {R"f("type": "fractal", "formula": "pseudo_kleinian", "parameters": {"radius": 0.5})f"},
      {R"f("type": "fractal", "formula": "pseudo_kleinian", "parameters": {"radius": 2, "size": [0.5, 1.5, 0.7]})f"},
      {R"f("type": "fractal", "formula": "ellipsoid", "parameters": {"half": [1, 0.05, 0.3]})f"},
      {R"f("type": "fractal", "formula": "round_box", "parameters": {"half": [1, 0.1, 0.5], "radius": 0.4})f"},
      {R"f("type": "fractal", "formula": "lattice", "parameters": {"cell": 0.5, "size": [0.3, 0.3, 0.3]})f"},
      {R"f("type": "fractal", "formula": "torus_knot", "parameters": {"windings": 5, "turns": 7})f"},
      {R"f("type": "fractal", "formula": "torus_knot", "parameters": {"windings": 1, "turns": 16})f", 0.01},
      {R"f("type": "fractal", "formula": "gyroid", "parameters": {"cell": 0.1, "thickness": 0.02})f"},
  });
}

TEST_CASE("estimates have room for what the greatest powers and bailouts make of an orbit") {
  check_bounds({
      {R"f("type": "fractal", "formula": "mandelbulb", "parameters": {"power": 16})f", 0.01},
      {R"f("type": "fractal", "formula": "mandelbulb", "parameters": {"power": 15.5})f", 0.01},
      {R"f("type": "fractal", "formula": "mandelbulb", "bailout": 1000)f", 0.01},
      {R"f("type": "fractal", "formula": "mandelbulb", "bailout": 1e9)f", 0.01},
      {R"f("type": "fractal", "formula": "mandelbulb", "derivative": "jacobian", "bailout": 1e6)f"},
      {R"f("type": "fractal", "formula": "juliabulb", "parameters": {"power": 16}, "bailout": 1e9)f", 0.01},
      {R"f("type": "fractal", "formula": "julia", "parameters": {"power": 16}, "iterations": 16)f"},
      {R"f("type": "fractal", "formula": "julia", "bailout": 1e9, "iterations": 16)f"},
      {R"f("type": "fractal", "formula": "quaternion_mandelbrot", "parameters": {"power": 16}, "bailout": 1000, "iterations": 16)f"},
      {R"f("type": "fractal", "formula": "bicomplex", "bailout": 1e9, "iterations": 16)f"},
      {R"f("type": "fractal", "formula": "tricorn", "parameters": {"power": 16}, "bailout": 1e9)f", 0.01},
      {R"f("type": "fractal", "formula": "mandelbox", "bailout": 1e6, "iterations": 64)f"},
      {R"f("type": "formula", "map": "z = z ^ 8 + c", "bailout": 1000)f", 0.01},
      {R"f("type": "formula", "map": "z = z ^ 8 + c", "bailout": 1e9)f", 0.01},
      {R"f("type": "formula", "map": "z = vec3(z.x^3 - 3 * z.x * z.y^2, 3 * z.x^2 * z.y - z.y^3, z.z * z.z * z.z) + c", "bailout": 1e9)f"},
      {R"f("type": "formula", "map": "z = z ^ 4 + c", "estimate": "linear", "bailout": 1e9)f", 0.01, true},
      {R"f("type": "hybrid", "steps": [{"type": "fractal", "formula": "mandelbox"}, {"type": "fractal", "formula": "mandelbulb"}], "iterations": 8, "bailout": 1e6)f",
       0.01},
  });
}

TEST_CASE("estimates of hybrids keep their bound") {
  check_bounds({
      {R"f("type": "hybrid", "steps": [{"type": "fractal", "formula": "mandelbox"}, {"type": "fractal", "formula": "mandelbulb"}], "iterations": 8)f",
       0.01},
      {R"f("type": "hybrid", "steps": [{"type": "fractal", "formula": "mandelbulb", "times": 2}, {"type": "fractal", "formula": "mandelbox"}], "iterations": 9)f",
       0.01, true},
      {R"f("type": "hybrid", "steps": [{"type": "fractal", "formula": "menger", "times": 2}, {"type": "fractal", "formula": "sierpinski"}], "iterations": 6)f"},
      {R"f("type": "hybrid", "steps": [{"type": "fractal", "formula": "mandelbox"}, {"type": "fractal", "formula": "menger"}], "iterations": 6)f"},
      {R"f("type": "hybrid", "steps": [{"type": "fractal", "formula": "sierpinski", "times": 2}, {"type": "fractal", "formula": "mandelbulb", "parameters": {"power": 2}}], "iterations": 9)f",
       0.01},
      {R"f("type": "hybrid", "steps": [{"type": "fractal", "formula": "julia"}, {"type": "fractal", "formula": "bicomplex"}], "iterations": 20)f"},
      {R"f("type": "hybrid", "steps": [{"type": "formula", "map": "z = abs(z) - vec3(0.3, 0.1, 0.2)"}, {"type": "fractal", "formula": "mandelbulb", "parameters": {"power": 3}}], "iterations": 16)f",
       0.01},
      {R"f("type": "hybrid", "steps": [{"type": "formula", "map": "z = vec3(z.x * z.x - z.y * z.y, 2 * z.x * z.y, z.z * z.z) + c"}, {"type": "fractal", "formula": "tricorn"}], "iterations": 10)f",
       0.01},
      {R"f("type": "hybrid", "steps": [{"type": "fractal", "formula": "amazing_surf"}, {"type": "fractal", "formula": "burning_ship"}], "iterations": 10)f",
       0.01},
  });
}

TEST_CASE("operations keep the bound of what they put together") {
  const char* ball_and_box =
      R"("fields": [{"type": "fractal", "formula": "sphere"}, {"type": "moved", "translate": [0.8, 0.3, 0], "rotate": {"axis": [1, 2, 3], "degrees": 40}, "scale": 0.6, "field": {"type": "fractal", "formula": "box"}}])";
  std::vector<std::string> joints;
  for (const char* type : {"union", "intersection", "difference"})
    for (const char* smooth : {"0", "0.4"})
      joints.push_back(fmt::format(R"("type": "{}", "smooth": {}, {})", type, smooth, ball_and_box));
  std::vector<Case> cases;
  for (const std::string& joint : joints) cases.push_back({joint.c_str()});
  const std::vector<Case> more{
      {R"f("type": "union", "smooth": 0.3, "fields": [{"type": "fractal", "formula": "julia"}, {"type": "fractal", "formula": "torus"}, {"type": "fractal", "formula": "box", "parameters": {"size": [0.2, 2, 0.2]}}])f"},
      {R"f("type": "difference", "smooth": 0.2, "fields": [{"type": "fractal", "formula": "sphere"}, {"type": "fractal", "formula": "menger"}])f"},
      {R"f("type": "intersection", "smooth": 0.2, "fields": [{"type": "fractal", "formula": "gyroid"}, {"type": "fractal", "formula": "sphere"}])f"},
      {R"f("type": "difference", "fields": [{"type": "fractal", "formula": "box"}, {"type": "fractal", "formula": "julia"}])f",
       0.01, true},
      {R"f("type": "repeat", "period": [0.8, 0, 1.1], "field": {"type": "moved", "scale": 0.3, "field": {"type": "fractal", "formula": "torus"}})f"},
      {R"f("type": "repeat", "period": [0.7, 0.7, 0.7], "count": [1, 0, 1], "field": {"type": "moved", "scale": 0.25, "rotate": {"axis": [1, 1, 0], "degrees": 30}, "field": {"type": "fractal", "formula": "menger"}})f"},
      {R"f("type": "thicken", "amount": 0.1, "field": {"type": "fractal", "formula": "torus_knot"})f", 0.01},
      {R"f("type": "thicken", "amount": -0.1, "field": {"type": "fractal", "formula": "box"})f"},
      {R"f("type": "shell", "amount": 0.1, "field": {"type": "fractal", "formula": "ellipsoid"})f", 0.01},
      {R"f("type": "shell", "amount": 0.05, "field": {"type": "fractal", "formula": "octahedron_flake"})f"},
      {R"f("type": "shell", "amount": 0.05, "field": {"type": "fractal", "formula": "julia"})f", 0.01, true},
      {R"f("type": "moved", "scale": 3, "translate": [2, 0, 0], "field": {"type": "fractal", "formula": "heart"})f"},
  };
  cases.insert(cases.end(), more.begin(), more.end());
  check_bounds(cases);
}

TEST_CASE("estimates of a user's formulas keep their bound, whatever their expressions") {
  check_bounds({
      {R"f("type": "formula", "map": "z = z ^ 8 + c")f", 0.01},
      {R"f("type": "formula", "map": "z = z ^ 8 + c", "derivative": "running")f"},
      {R"f("type": "formula", "map": ["z = boxfold(z, 1)", "z = z ^ 3 + c"], "iterations": 10)f"},
      {R"f("type": "formula", "map": "z = vec3(z.x * z.x - z.y * z.y - z.z * z.z, 2 * z.x * z.y, 2 * z.x * z.z) + c")f"},
      {R"f("type": "formula", "map": "z = vec3(z.x^3 - 3 * z.x * z.y^2, 3 * z.x^2 * z.y - z.y^3, z.z * z.z * z.z) + c", "iterations": 10)f"},
      {R"f("type": "formula", "map": ["z = abs(z) - vec3(0.1, 0, 0)", "z = rotate(z, vec3(1, 1, 1), 0.25)", "z = z ^ 5 + c"], "iterations": 12)f"},
      {R"f("type": "formula", "map": "z = z ^ 2 + c + 0.2 * vec3(sin(3 * z.x), sin(3 * z.y), sin(3 * z.z))", "iterations": 10)f"},
      {R"f("type": "formula", "map": "z = normalize(z) * dot(z, z) + vec3(z.y, z.z, z.x) * 0.3 + c", "iterations": 10)f"},
      {R"f("type": "formula", "space": "quat", "start": "z = quat(p, 0.2); c = quat(-0.2, 0.6, 0.2, 0.2)", "map": "z = z * z * z + c", "iterations": 20)f"},
      {R"f("type": "formula", "map": "z = 2 * ballfold(boxfold(z, 1), 0.5, 1) + c", "estimate": "linear", "bailout": 1000, "iterations": 12)f"},
      {R"f("type": "formula", "map": "z = vec3(2, 1.6, 2.2) * boxfold(z, 0.7) + c", "estimate": "linear", "iterations": 24, "interval": {"min": [-6, -6, -6], "max": [6, 6, 6]})f"},
      {R"f("type": "formula", "map": ["z = abs(z)", "z = 2 * z - vec3(1, 1, 1)"], "distance": "3 * (length(z) - 1.2)", "iterations": 5)f"},
      {R"f("type": "formula", "map": ["z = abs(z)", "z = vec3(2, 1.5, 1.8) * z - vec3(1, 1, 1)"], "distance": "length(z) - 1.2", "iterations": 5)f"},
      {R"f("type": "formula", "map": ["z = z + 0.1 * vec3(sin(4 * z.y), sin(4 * z.z), sin(4 * z.x))"], "distance": "length(z) - 0.8", "iterations": 2)f"},
      {R"f("type": "formula", "distance": "10 * (length(p) - 0.8)")f"},
      {R"f("type": "formula", "distance": "length(p) - 0.8 + 0.2 * sin(40 * p.x)")f"},
      {R"f("type": "formula", "distance": "p.x^4 + p.y^4 + p.z^4 - 0.5")f"},
      {R"f("type": "formula", "distance": "p.x^4 + p.y^4 + p.z^4 - 0.5", "normalize": true)f"},
      {R"f("type": "formula", "distance": "log(length(p) / 0.8)")f"},
      {R"f("type": "formula", "distance": "0.5 - sqrt(abs(p.x)) + 0.3 * length(p)")f"},
      {R"f("type": "formula", "distance": "0.01 * (length(p) - 0.8)")f"},
      {R"f("type": "formula", "distance": "(p.x*p.x + 2.25*p.z*p.z + p.y*p.y - 1)^3 - p.x*p.x*p.y^3 - 0.1125*p.z*p.z*p.y^3", "normalize": true)f"},
      {R"f("type": "formula", "distance": "sin(3*p.x)*cos(3*p.y) + sin(3*p.y)*cos(3*p.z) + sin(3*p.z)*cos(3*p.x)")f"},
  });
}
