// Views of fractals from so near that floats do not tell the pixels' points apart.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "compile/compiled_scene.h"
#include "compile/fields/sdf_deep.h"
#include "devices.h"
#include "formula/evaluate.h"
#include "scene/json/parse.h"
#include "scene/read/scene_reader.h"
#include "scenes.h"
#include "sdf_testing.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr int size = 40;

/// From `a` towards `b`, to the first point where the estimate is below `limit + spread * t`.
double march_in_doubles(const FormulaField& field, const dvec3& a, const dvec3& direction, double limit,
                        double spread) {
  FormulaEvaluator at(field);
  double t = 0;
  for (int i = 0; i < 20000; ++i) {
    const double d = at.at(a + t * direction).distance;
    if (d < limit + spread * t) return t;
    t += 0.5 * d;
  }
  return INFINITY;
}

struct NearView {
  dvec3 surface, forward;
  SceneDescription scene;
};

/// A Mandelbulb that is moved, turned and twice as large, seen over a width of `width` in its own units.
NearView near_view(double width) {
  const auto scene = [&](const dvec3& position, const dvec3& target) {
    const std::string text = fmt::format(
        R"({{"image": {{"width": {0}, "height": {0}}},
          "camera": {{"position": [{1:.17g}, {2:.17g}, {3:.17g}], "target": [{4:.17g}, {5:.17g}, {6:.17g}], "fov": 28}},
          "lights": [{{"type": "ambient", "intensity": 0.3}},
                     {{"type": "directional", "direction": [-0.5, -0.7, -0.6]}}],
          "materials": {{"m": {{"color": [1, 1, 1]}}}},
          "objects": [{{"type": "fractal", "formula": "mandelbulb", "material": "m",
            "transform": [{{"rotate": {{"axis": [0, 0, 1], "degrees": 90}}}}, {{"scale": 2}},
                          {{"translate": [3, -5, 7]}}]}}]}})",
        size, position.x, position.y, position.z, target.x, target.y, target.z);
    const nlohmann::json document = parse_json(text, "test.json");
    const JsonContext context{"test.json"};
    return read_scene(JsonValue(document, context));
  };
  const auto world = [](const dvec3& p) { return 2.0 * dvec3(-p.y, p.x, p.z) + dvec3(3, -5, 7); };
  const dvec3 from(0.9, 0.7, 2.1), forward = glm::normalize(dvec3(0.25, 0.31, 0) - from);
  FormulaField fine = listed_field("mandelbulb").root.formula;
  fine.iterations = 60;
  const dvec3 surface = from + march_in_doubles(fine, from, forward, 4e-15, 0) * forward;
  return {surface, forward, scene(world(surface - 2 * width * forward), world(surface))};
}

const char* const depth_kernel = R"(
#include "lib/sdf/surface.cl"
__kernel void depths(__global const SdfField* fields, __global const float* q, __global const float4* directions,
                     __global float* found, float spread, u32 count) {
  const u32 item = get_global_id(0);
  if (item * LANES >= count) return;
  MarchRays r;
  for (u32 i = 0; i < LANES; ++i) {
    const float4 d = directions[item * LANES + i];
    REAL_LANE(r.direction.x, i) = d.x; REAL_LANE(r.direction.y, i) = d.y; REAL_LANE(r.direction.z, i) = d.z;
  }
  r.origin = real3((REAL)(0.0f), (REAL)(0.0f), (REAL)(0.0f));
  r.t_min = (REAL)(0.0f); r.t_max = (REAL)(1e20f);
  r.footprint = (REAL)(0.0f); r.spread = (REAL)(spread);
  r.active = ALL_LANES; r.step_limit = fields[0].step_limit; r.inside = NO_LANES; r.leaving = NO_LANES;
  const Scene scene = {.sdf_fields = fields, .sdf_parameters = q};
  const MarchHits h = march_rays(&scene, 0, &r);
  for (u32 i = 0; i < LANES; ++i)
    found[item * LANES + i] = MASK_LANE(h.hit, i) ? REAL_LANE(h.t, i) : INFINITY;
}
)";

std::vector<float> depths(Device& device, const CompiledFields& fields, const std::vector<float4>& directions,
                          double spread) {
  const int lanes = usual_lanes(device.info());
  auto kernel =
      build_fields(device, depth_kernel, fields, lanes)
          .kernel<Buffer<SdfField>, Buffer<float>, Buffer<float4>, Buffer<float>, float, u32>("depths");
  const auto records = device.upload<SdfField>(fields.fields);
  const auto q = device.upload<float>(fields.parameters);
  const auto in = device.upload<float4>(directions);
  auto out = device.make<float>(directions.size());
  device.run(kernel, {.x = directions.size() / static_cast<std::size_t>(lanes), .local_x = 4}, records, q, in,
             out, static_cast<float>(spread), static_cast<u32>(directions.size()));
  std::vector<float> found(directions.size());
  device.read(out, std::span<float>(found));
  device.finish();
  return found;
}

const char* const distance_kernel = R"(
#include "lib/sdf/march.cl"
__kernel void distances(__global const float* q, __global const float4* points, __global float* found,
                        u32 fields, u32 count) {
  const u32 item = get_global_id(0);
  if (item * LANES >= count) return;
  REAL3 p;
  for (u32 i = 0; i < LANES; ++i) {
    const float4 at = points[item * LANES + i];
    REAL_LANE(p.x, i) = at.x; REAL_LANE(p.y, i) = at.y; REAL_LANE(p.z, i) = at.z;
  }
  for (u32 field = 0; field < fields; ++field) {
    const REAL d = sdf_distance(field, p, ALL_LANES, q);
    for (u32 i = 0; i < LANES; ++i) found[field * count + item * LANES + i] = REAL_LANE(d, i);
  }
}
)";

CompiledFields fields_of(const CompiledScene& flat) {
  return {flat.field_source, flat.sdf_parameters, flat.sdf_fields};
}

bool has_doubles(const DeviceInfo& device) {
  return device.extensions.find("cl_khr_fp64") != std::string::npos;
}

}  // namespace

TEST_CASE("a view a millionth wide has the depths that doubles give") {
  const double width = 1e-6;
  const NearView view = near_view(width);
  const CompiledScene flat = compile(view.scene);
  const FieldView seen = view_of_field(view.scene, view.scene.objects[0]);
  REQUIRE(is_deep(seen));
  CHECK(flat.origin == view.scene.camera.position);
  CHECK(glm::length(seen.place - (view.surface - 2 * width * view.forward)) < 1e-14);
  const SdfDescription field = near_description(view.scene.fields[0], seen);
  const double spread = 2 * std::tan(glm::radians(14.0)) / size;

  const dvec3 right = glm::normalize(glm::cross(view.forward, dvec3(0, 1, 0))),
              up = glm::cross(right, view.forward);
  std::vector<dvec3> exact;
  std::vector<float4> directions;
  for (int i = 0; i < size * size; ++i) {
    exact.push_back(glm::normalize(view.forward + (i % size + 0.5 - size / 2) * spread * right +
                                   (i / size + 0.5 - size / 2) * spread * up));
    const glm::vec3 d(exact.back());
    directions.push_back({d.x, d.y, d.z, 0});
  }
  std::vector<double> wanted;
  double nearest = INFINITY, farthest = 0;
  for (const dvec3& d : exact) {
    wanted.push_back(march_in_doubles(field.root.formula, seen.place, d, field.least, 0.5 * spread));
    nearest = std::min(nearest, wanted.back());
    farthest = std::max(farthest, wanted.back());
  }
  CHECK(farthest - nearest > width);  // there is something to be seen
  on_every_device([&](const DeviceInfo& info) {
    if (!has_doubles(info) || !is_quick(info)) return;
    Device device(info);
    const std::vector<float> found = depths(device, fields_of(flat), directions, spread);
    int close = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
      close += std::abs(found[i] - wanted[i]) < 3 * spread * width;
    CHECK(close > 0.97 * size * size);  // outlines of what is in front differ by a step
  });
}

TEST_CASE("fields are marched in doubles only where floats are too coarse, each placed field as its own") {
  for (const double width : {3e-2, 1e-3, 1e-8}) {
    const NearView view = near_view(width);
    const CompiledScene flat = compile(view.scene);
    const bool deep = width < 1e-4;
    CHECK((flat.field_source.find("deep_begin.h") != std::string::npos) == deep);
    const double footprint = view_of_field(view.scene, view.scene.objects[0]).footprint;
    const double real = width * 2 * 2 * std::tan(glm::radians(14.0)) / size;  // in the field's units
    CHECK(footprint < 1.01 * real);
    CHECK(footprint > 0.02 * real);  // estimates are short
    CHECK(flat.sdf_fields[0].lower.w < 0.5 * footprint);
  }
  NearView view = near_view(1e-8);
  view.scene.objects.push_back(view.scene.objects[0]);
  view.scene.objects[1].world_from_object[3].x += 5;
  const CompiledScene both = compile(view.scene);
  REQUIRE(both.sdf_fields.size() == 2);
  CHECK(std::abs(both.sdf_fields[0].lower.y - both.sdf_fields[1].lower.y) == Approx(2.5));
}

TEST_CASE("a deep view is rendered sharp, with its shadows, a batch of rays or a ray at a time") {
  NearView view = near_view(1e-9);
  view.scene.render.tracer = GENERATE(Tracer::automatic, Tracer::compact);
  RenderOptions options;
  options.kernels = GENERATE(KernelChoice::own, KernelChoice::draft);  // the interpreter has no doubles
  on_every_device([&](const DeviceInfo& info) {
    if (!has_doubles(info) || !is_quick(info)) return;
    const RenderResult result = scenes::render_on(info, view.scene, options);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < result.image.data.size(); i += 3) {
      sum += result.image.data[i];
      squares += double(result.image.data[i]) * result.image.data[i];
    }
    const double mean = sum / (size * size);
    CHECK(std::sqrt(squares / (size * size) - mean * mean) > 0.05);
    CHECK(result.counts[COUNT_MARCH_LIMIT] < 100);
  });
}

TEST_CASE("every surface of the list is evaluated in doubles where a view asks for it") {
  std::vector<DeepField> fields;
  const dvec3 origin(0.31, 0.42, -0.57);
  for (const SdfDescription& field : listed_fields()) fields.push_back({field, origin});
  const CompiledFields compiled = compile_deep_fields(fields);
  std::vector<float4> points;  // steps that floats about the origin would lose
  for (int i = 0; i < 64; ++i) points.push_back({1e-9f * float(i % 8), 2e-9f * float(i / 8), 1e-9f, 0});
  on_every_device([&](const DeviceInfo& info) {
    if (!has_doubles(info) || !is_quick(info)) return;
    Device device(info);
    auto kernel = build_fields(device, distance_kernel, compiled, 4)
                      .kernel<Buffer<float>, Buffer<float4>, Buffer<float>, u32, u32>("distances");
    const auto q = device.upload<float>(compiled.parameters);
    const auto in = device.upload<float4>(points);
    auto out = device.make<float>(points.size() * fields.size());
    device.run(kernel, {.x = points.size() / 4, .local_x = 4}, q, in, out, static_cast<u32>(fields.size()),
               static_cast<u32>(points.size()));
    std::vector<float> found(points.size() * fields.size());
    device.read(out, std::span<float>(found));
    device.finish();
    for (std::size_t f = 0; f < fields.size(); ++f) {
      FormulaEvaluator wanted(fields[f].field.root.formula);
      int compared = 0;
      double worst = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const FieldValue value = wanted.at(origin + dvec3(points[i].x, points[i].y, points[i].z));
        if (value.inside) continue;
        ++compared;
        worst = std::max(worst, std::abs(found[f * points.size() + i] - value.distance) / value.distance);
      }
      INFO(fields[f].field.root.formula.steps[0].definition.name << ", outside " << compared);
      CHECK(worst < 1e-6);
    }
  });
}
