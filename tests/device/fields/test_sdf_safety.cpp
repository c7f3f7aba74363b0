// A safety that a formula needs costs steps and moves no surface.
#include <cmath>
#include <glm/glm.hpp>

#include "sdf_marching.h"

using namespace sundog;
using glm::dvec3;

namespace {

/// The hit of the torus about y with radii 1 and 0.35, by sphere tracing in double precision.
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
