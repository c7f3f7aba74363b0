// Marching: hits of closed forms, cuts, both sides of a surface, limits.
#include <cmath>
#include <glm/glm.hpp>
#include <random>

#include "scene/formula/lower.h"
#include "sdf_testing.h"
#include "shared/bvh.h"

using namespace sundog;
using glm::dvec3;

namespace {

const char* const march_kernel = R"(
#include "lib/sdf/surface.cl"
#include "shared/bvh.h"
// mode bit 0: inside, bit 1: leaving. A Hit: t, steps in u, taken back in v, flags (1 hit, 2 cut, 4 limited) in prim, the normal.
__kernel void march(__global const SdfField* fields, __global const float* q, __global const Ray* rays,
                    __global Hit* hits, u32 field, u32 mode, float footprint, float spread, u32 count) {
  const u32 item = get_global_id(0);
  if (item * LANES >= count) return;
  MarchRays r;
  for (u32 i = 0; i < LANES; ++i) {
    const Ray ray = rays[item * LANES + i];
    REAL_LANE(r.origin.x, i) = ray.ox; REAL_LANE(r.origin.y, i) = ray.oy; REAL_LANE(r.origin.z, i) = ray.oz;
    REAL_LANE(r.direction.x, i) = ray.dx; REAL_LANE(r.direction.y, i) = ray.dy; REAL_LANE(r.direction.z, i) = ray.dz;
    REAL_LANE(r.t_min, i) = ray.t_min; REAL_LANE(r.t_max, i) = ray.t_max;
  }
  r.footprint = (REAL)(footprint);
  r.spread = (REAL)(spread);
  r.active = ALL_LANES;
  r.step_limit = fields[field].step_limit;
  r.inside = (mode & 1u) ? ALL_LANES : NO_LANES;
  r.leaving = (mode & 2u) ? ALL_LANES : NO_LANES;
  const Scene scene = {.sdf_fields = fields, .sdf_parameters = q};
  MarchHits h = march_rays(&scene, field, &r);
  REAL3 normal = sdf_normal(&scene, field, along3(r.origin, h.t, r.direction), h.threshold, h.hit, h.cut);
  for (u32 i = 0; i < LANES; ++i) {
    Hit hit;
    hit.t = REAL_LANE(h.t, i);
    hit.u = (float)MASK_LANE(h.steps, i);
    hit.v = (float)MASK_LANE(h.taken_back, i);
    hit.prim = (MASK_LANE(h.hit, i) ? 1u : 0u) | (MASK_LANE(h.cut, i) ? 2u : 0u) | (MASK_LANE(h.limited, i) ? 4u : 0u);
    hit.instance = 0;
    hit.ng_x = REAL_LANE(normal.x, i); hit.ng_y = REAL_LANE(normal.y, i); hit.ng_z = REAL_LANE(normal.z, i);
    hits[item * LANES + i] = hit;
  }
}
)";

Ray make_ray(const dvec3& o, const dvec3& d, double t_min = 0, double t_max = 1e20) {
  const auto f = [](double v) { return static_cast<float>(v); };
  return {f(o.x), f(o.y), f(o.z), f(t_min), f(d.x), f(d.y), f(d.z), f(t_max)};
}

struct MarchOptions {
  int lanes = 0;  // 0: as the renderer would choose them
  u32 mode = 0;
  float footprint = 0, spread = 0;
  u32 field = 0;
};

std::vector<Hit> march(Device& device, const CompiledFields& fields, std::vector<Ray> rays,
                       MarchOptions options = {}) {
  if (options.lanes == 0) options.lanes = usual_lanes(device.info());
  const std::size_t count = rays.size();
  while (rays.size() % 16) rays.push_back(rays.back());
  auto kernel =
      build_fields(device, march_kernel, fields, options.lanes, true)
          .kernel<Buffer<SdfField>, Buffer<float>, Buffer<Ray>, Buffer<Hit>, u32, u32, float, float, u32>(
              "march");
  const auto records = device.upload<SdfField>(fields.fields);
  const auto q = device.upload<float>(fields.parameters);
  const auto in = device.upload<Ray>(rays);
  auto out = device.make<Hit>(rays.size());
  device.run(kernel, {.x = rays.size() / static_cast<std::size_t>(options.lanes), .local_x = 16}, records, q,
             in, out, options.field, options.mode, options.footprint, options.spread,
             static_cast<u32>(rays.size()));
  std::vector<Hit> hits(rays.size());
  device.read(out, std::span<Hit>(hits));
  device.finish();
  hits.resize(count);
  return hits;
}

CompiledFields compiled(const SdfDescription& field) { return compile_fields(std::span(&field, 1)); }

std::vector<Ray> random_rays(int count, double distance, double target) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const dvec3 o = distance * glm::normalize(dvec3(normal(random), normal(random), normal(random)));
    const dvec3 to = target * dvec3(normal(random), normal(random), normal(random));
    rays.push_back(make_ray(o, (to - o) * (0.25 + 0.05 * (i % 40))));  // of many lengths
  }
  return rays;
}

struct Plain {
  dvec3 o, d;
  explicit Plain(const Ray& r) : o(r.ox, r.oy, r.oz), d(r.dx, r.dy, r.dz) {}
};

/// First crossing of the unit sphere, infinite where there is none.
double sphere_hit(const Ray& ray, double radius = 1) {
  const Plain r(ray);
  const double a = glm::dot(r.d, r.d), b = glm::dot(r.o, r.d), c = glm::dot(r.o, r.o) - radius * radius;
  const double square = b * b - a * c;
  return square < 0 ? INFINITY : (-b - std::sqrt(square)) / a;
}
double box_hit(const Ray& ray, const dvec3& half) {
  const Plain r(ray);
  double first = -INFINITY, last = INFINITY;
  for (int i = 0; i < 3; ++i) {
    const double a = (-half[i] - r.o[i]) / r.d[i], b = (half[i] - r.o[i]) / r.d[i];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first > last ? INFINITY : first;
}

/// What sphere tracing in double precision finds of the torus about y with radii 1 and 0.35.
struct TorusHit {
  double t = INFINITY, nearest = INFINITY;  // in lengths of the direction; least distance on the way
};
TorusHit torus_hit(const Ray& ray) {
  const Plain r(ray);
  const double speed = glm::length(r.d);
  TorusHit hit;
  double t = 0;
  for (int i = 0; i < 20000 && t * speed < 20; ++i) {
    const dvec3 p = r.o + t * r.d;
    const double d = std::hypot(std::hypot(p.x, p.z) - 1, p.y) - 0.35;
    hit.nearest = std::min(hit.nearest, d);
    if (d < 1e-9) {
      hit.t = t;
      break;
    }
    t += d / speed;
  }
  return hit;
}

/// A formula of the user's own, as its file would have it.
SdfDescription own_formula(const std::string& distance, double safety, bool normalize) {
  FormulaDefinition d;
  d.name = "own";
  d.kind = FormulaKind::direct;
  d.distance = distance;
  d.normalize = normalize;
  d.smooth = true;
  SdfDescription field;
  field.root.formula.steps.push_back({d, {}, 1});
  field.root.formula.safety = safety;
  field.lower = dvec3(-1.6);
  field.upper = dvec3(1.6);
  field.step_limit = 8192;
  return field;
}

constexpr const char* torus_quartic = "(dot(p, p) + 1 - 0.1225)^2 - 4 * (p.x^2 + p.z^2)";

}  // namespace

TEST_CASE("a small safety costs steps and moves no surface") {
  const bool normalize = GENERATE(false, true);
  SdfDescription field = own_formula(torus_quartic, normalize ? 0.02 : 0.0121, normalize);
  SdfNode joint;  // the same beside another field and moved: the torus' own surface is still where it was
  joint.kind = SdfNode::Kind::unite;
  SdfNode moved = field.root;
  SdfNode away;
  away.kind = SdfNode::Kind::transform;
  away.offset = {0, 9, 0};
  away.scale = 0.5;
  away.children.push_back(listed_field("mandelbulb").root);
  joint.children = {moved, away};
  SdfDescription beside = field;
  beside.root = joint;
  const SdfDescription both[] = {field, beside};
  const CompiledFields fields = compile_fields(both);
  std::vector<Ray> rays;
  const dvec3 eye(1.5, 2.2, 3.1), forward = glm::normalize(-eye);
  const dvec3 right = glm::normalize(glm::cross(forward, dvec3(0, 1, 0))), up = glm::cross(right, forward);
  const int width = 96;
  const double scale = 2 * 0.4 / width;
  for (int y = 0; y < width; ++y)
    for (int x = 0; x < width; ++x)
      rays.push_back(make_ray(eye, 0.7 * glm::normalize(forward + (x + 0.5 - width / 2) * scale * right +
                                                        (y + 0.5 - width / 2) * scale * up)));
  for (const DeviceInfo& info : test_devices()) DYNAMIC_SECTION(info.label() << normalize) {
      if (!is_quick(info)) continue;
      Device device(info);
      for (u32 index = 0; index < 2; ++index) {
        const auto hits = march(device, fields, rays, {.spread = static_cast<float>(scale), .field = index});
        // Hits beside a fractal are not refined: they are a threshold off, to first order.
        const double threshold = index == 0 ? 0.05 * 4.2 * scale : 1.25 * 0.5 * 4.2 * scale;
        int false_hits = 0, lost = 0, off = 0, seen = 0, limited = 0;
        double worst = 0, steps = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          const TorusHit wanted = torus_hit(rays[i]);
          const bool hit = hits[i].prim & 1u;
          seen += std::isfinite(wanted.t);
          steps += hits[i].u;
          limited += (hits[i].prim & 4u) != 0;
          if (hit && !std::isfinite(wanted.t)) false_hits += wanted.nearest > threshold;
          if (!hit && std::isfinite(wanted.t)) ++lost;
          if (!hit || !std::isfinite(wanted.t)) continue;
          const Plain r(rays[i]);
          const dvec3 p = r.o + double(hits[i].t) * r.d;
          const double error = std::abs(std::hypot(std::hypot(p.x, p.z) - 1, p.y) - 0.35);
          worst = std::max(worst, error);
          off += error > threshold || (hits[i].t - wanted.t) * 0.7 < -0.5;
        }
        INFO("field " << index << ", seen " << seen << ", worst " << worst << ", steps a ray "
                      << steps / double(rays.size()));
        CHECK(seen > 2000);
        CHECK(false_hits == 0);
        CHECK(lost == 0);
        CHECK(off == 0);
        CHECK(limited == 0);
      }
    }
}

TEST_CASE("a safety moves neither what is thickened nor a rounded joint") {
  const auto with = [](double safety) {
    SdfNode thick;
    thick.kind = SdfNode::Kind::thicken;
    thick.amount = 0.3;
    thick.children = {own_formula("2 * (length(p) - 0.5)", safety, false).root};  // a ball of 0.65
    SdfNode joint;
    joint.kind = SdfNode::Kind::unite;
    joint.smooth = 0.4;
    joint.children = {thick, own_formula("p.y + 0.6", 1, false).root};
    SdfDescription field = own_formula("p.x", 1, false);
    field.root = joint;
    return field;
  };
  const SdfDescription both[] = {with(0.5), with(0.05)};
  const CompiledFields fields = compile_fields(both);
  std::vector<Ray> rays;
  for (int i = 0; i < 256; ++i)
    rays.push_back(
        make_ray({1.4, 1.5, 0}, glm::normalize(dvec3(-1.4, -2.2 + 0.1 * (i / 16), 0.05 * (i % 16)))));
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto wanted = march(device, fields, rays, {.spread = 1e-3f});
    const auto found = march(device, fields, rays, {.spread = 1e-3f, .field = 1});
    int seen = 0, different = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      seen += wanted[i].prim & 1u;
      different += wanted[i].prim != found[i].prim || std::abs(wanted[i].t - found[i].t) > 1e-3f;
    }
    CHECK(seen > 100);
    CHECK(different <= 2);  // of 256: an outline
  });
}

TEST_CASE("a marched sphere and box are the exact ones") {
  auto ball = listed_field("sphere"), box = listed_field("box");
  ball.lower = box.lower = dvec3(-1.5);
  ball.upper = box.upper = dvec3(1.5);
  box.root.formula.steps[0].values = {0.9, 0.6, 0.8};
  const SdfDescription both[] = {ball, box};
  const CompiledFields fields = compile_fields(both);
  const auto rays = random_rays(4096, 4, 0.6);
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    for (u32 field = 0; field < 2; ++field) {
      const auto hits = march(device, fields, rays, {.field = field});
      int wrong = 0, grazing = 0;
      double worst = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const double wanted = field == 0 ? sphere_hit(rays[i]) : box_hit(rays[i], {0.9, 0.6, 0.8});
        const bool hit = hits[i].prim & 1u;
        const double length = glm::length(Plain(rays[i]).d);
        if (hit != std::isfinite(wanted))
          ++grazing;  // within the threshold of the outline
        else if (hit)
          worst = std::max(worst, std::abs(hits[i].t - wanted) * length);
        wrong += hits[i].prim & 6u;
      }
      INFO((field == 0 ? "sphere" : "box"));
      CHECK(wrong == 0);
      CHECK(grazing <= 4);
      CHECK(worst < 3e-5);  // in units of the field, from 4 away
    }
  });
}

TEST_CASE("marching gives the same bits for every number of lanes") {
  const CompiledFields fields = compiled(listed_field("mandelbulb"));
  const auto rays = random_rays(1024, 3, 0.4);
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto wanted = march(device, fields, rays, {.lanes = 1, .spread = 1e-3f});
    int hit = 0;
    for (const Hit& h : wanted) hit += h.prim & 1u;
    CHECK(hit > 500);
    for (const int lanes : {4, 8, 16}) {
      if (!is_quick(info) && lanes != 4) continue;
      const auto found = march(device, fields, rays, {.lanes = lanes, .spread = 1e-3f});
      int different = 0;
      for (std::size_t i = 0; i < rays.size(); ++i)
        different += found[i].t != wanted[i].t || found[i].prim != wanted[i].prim ||
                     found[i].u != wanted[i].u || found[i].ng_x != wanted[i].ng_x;
      CHECK(different == 0);
    }
  });
}

TEST_CASE("the interval cuts the surface and the cut is solid") {
  auto ball = listed_field("sphere");
  ball.lower = {-1.5, -1.5, -1.5};
  ball.upper = {1.5, 0.25, 1.5};  // a sphere with its top cut off at y = 0.25
  const CompiledFields fields = compiled(ball);
  std::vector<Ray> down;
  for (int i = 0; i < 256; ++i)
    down.push_back(make_ray({-1.2 + 2.4 * (i % 16) / 15, 3, -1.2 + 2.4 * (i / 16) / 15}, {0, -1, 0}));
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto hits = march(device, fields, down);
    for (std::size_t i = 0; i < down.size(); ++i) {
      const double r = std::hypot(down[i].ox, down[i].oz), rim = std::sqrt(1 - 0.25 * 0.25);
      if (std::abs(r - rim) < 1e-3 || std::abs(r - 1) < 1e-3) continue;
      INFO("radius " << r);
      CHECK((hits[i].prim & 3u) == (r < rim ? 3u : r < 1 ? 1u : 0u));
      if (r < rim) {
        CHECK(hits[i].t == Approx(2.75));
        CHECK(hits[i].ng_y == 1.0f);
      } else if (r < 1) {
        CHECK(hits[i].t == Approx(3 - std::sqrt(1 - r * r))
                               .margin(1e-4));  // below the cut, from above: the sphere widens there
      }
    }
    // from inside, upwards: out through the cut
    std::vector<Ray> up;
    for (int i = 0; i < 16; ++i) up.push_back(make_ray({0.05 * i, -0.3, 0}, {0, 1, 0}));
    for (const Hit& hit : march(device, fields, up, {.mode = 1})) {
      CHECK((hit.prim & 7u) == 3u);
      CHECK(hit.t == Approx(0.55));
      CHECK(hit.ng_y == 1.0f);
    }
  });
}

TEST_CASE("a ball cuts a field as the interval does") {
  auto box = listed_field("box");
  box.sphere = glm::dvec4(0, 0, 0, 1.2);
  box.lower = dvec3(-2);
  box.upper = dvec3(2);
  const CompiledFields fields = compiled(box);
  const Ray corner = make_ray({3, 3, 3}, {-1, -1, -1}), face = make_ray({3, 0.1, 0.1}, {-1, 0, 0});
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto hits = march(device, fields, {corner, face});
    CHECK(hits[0].prim == 3u);  // the box's corner lies beyond the ball
    CHECK(hits[0].t == Approx(3 - 1.2 / std::sqrt(3.0)));
    CHECK(hits[0].ng_x == Approx(1 / std::sqrt(3.0)));
    CHECK(hits[1].prim == 1u);
    CHECK(hits[1].t == Approx(2).margin(1e-5));
    CHECK(hits[1].ng_x == 1.0f);
  });
}

TEST_CASE("a ray that starts on the surface leaves it, whichever side it takes") {
  const CompiledFields fields = compiled(listed_field("sphere"));
  std::vector<Ray> outwards, inwards;
  for (int i = 0; i < 64; ++i) {
    const double a = 0.1 * i, up = 0.02 + 0.015 * i;  // from grazing to steep
    const dvec3 n(std::cos(a), 0, std::sin(a)), side(-n.z, 0, n.x);
    outwards.push_back(make_ray(n * 1.0005, glm::normalize(side + up * n)));
    inwards.push_back(make_ray(n * 0.9995, glm::normalize(side - up * n)));
  }
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    for (const Hit& hit : march(device, fields, outwards, {.mode = 2, .footprint = 1e-4f}))
      CHECK_FALSE(hit.prim & 1u);
    const auto hits = march(device, fields, inwards, {.mode = 3, .footprint = 1e-4f});
    for (std::size_t i = 0; i < inwards.size(); ++i) {
      const Plain r(inwards[i]);
      const double b = glm::dot(r.o, r.d), chord = -b + std::sqrt(b * b - glm::dot(r.o, r.o) + 1);
      CHECK(hits[i].prim == 1u);
      CHECK(hits[i].t == Approx(chord).margin(1e-4));
      CHECK(hits[i].ng_x * r.d.x + hits[i].ng_z * r.d.z > 0);  // outward, along the ray
    }
  });
}

TEST_CASE("t_max ends a march and the step limit is counted as a hit") {
  auto ball = listed_field("sphere");
  const CompiledFields fields = compiled(ball);
  ball.step_limit = 2;
  ball.root.formula.safety = 0.1;
  const CompiledFields hurried = compiled(ball);
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto hits = march(device, fields,
                            {make_ray({0, 0, 3}, {0, 0, -1}, 0, 1.9), make_ray({0, 0, 3}, {0, 0, -1}, 0, 2.1),
                             make_ray({0, 0, 3}, {0, 0, -1}, 4.5, 9), make_ray({3, 3, 3}, {1, 0, 0}),
                             make_ray({0, 0, 3}, {0, 0, -1e-3})});
    CHECK(hits[0].prim == 0u);
    CHECK(hits[1].prim == 1u);
    CHECK(hits[2].prim == 0u);  // starts behind the interval
    CHECK(hits[3].prim == 0u);
    CHECK(hits[4].prim == 1u);
    CHECK(hits[4].t == Approx(2000).epsilon(1e-4));
    const auto limited = march(device, hurried, {make_ray({0, 0, 3}, {0, 0, -1})});
    CHECK(limited[0].prim == 5u);
    CHECK(limited[0].u == 2.0f);
  });
}

TEST_CASE("a fractal is entered and left: the way through a Julia set's body is found from inside") {
  auto julia = listed_field("julia");
  julia.root.formula.steps[0].values = {2, 0, 0, 0, 0, 0};  // power 2, c = 0: the unit ball
  const CompiledFields fields = compiled(julia);
  std::vector<Ray> rays;
  for (int i = 0; i < 64; ++i)
    rays.push_back(make_ray({0.6 * std::sin(i), 0.5 * std::cos(2.0 * i), 0.1},
                            glm::normalize(dvec3(std::cos(3.0 * i), std::sin(3.0 * i), 0.3))));
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto hits = march(device, fields, rays, {.mode = 1, .footprint = 2e-4f});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Plain r(rays[i]);
      const double b = glm::dot(r.o, r.d), chord = -b + std::sqrt(b * b - glm::dot(r.o, r.o) + 1);
      CHECK(hits[i].prim == 1u);
      CHECK(hits[i].t == Approx(chord).margin(4e-3));
    }
  });
}
