// Bends smooth normals to the silhouette, lifts points off smooth meshes (Hanika 2021), filters checkers, and
// evaluates lights, Phong's or Blinn's highlight and Fresnel's equations.
#include "bench/plain/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace sundog::plain {
namespace {

using glm::vec3;

vec3 interpolate(const Hit& hit, const vec3& a, const vec3& b, const vec3& c) {
  return (1 - hit.u - hit.v) * a + hit.u * b + hit.v * c;
}

vec3 normal_of(const Vertex& v) { return {v.nx, v.ny, v.nz}; }
vec3 color_of(const Vertex& v) { return {v.r, v.g, v.b}; }

float greatest_size(const vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The share of the interval of width w around x that lies in x's own cell (between whole numbers), minus the
/// share in the cells beside it.
float own_part(float x, float w) {
  const float f = x - std::floor(x);
  return std::min(2 * std::min(f, 1 - f), std::min(w, std::max(2 - w, 0.0f))) / w;
}

/// The share of a checker's odd cells in the footprint of a ray that has travelled the distance t.
float odd_part(const CompiledScene& scene, const Ray& ray, float t, const Instance& instance,
               const Surface& s) {
  const SceneInfo& info = scene.info;
  const float spread =
      glm::length(rgb(info.camera_dx)) * std::max(1 / std::sqrt(static_cast<float>(info.samples)), 0.125f);
  const float cosine = std::max(std::abs(glm::dot(s.ng, ray.d)), 0.01f);
  const float frequency = s.material->checker_diffuse.w;
  const vec3 scale = rgb(instance.pattern_scale), q = object_point(instance, s.p) * scale * frequency;
  const vec3 n = glm::normalize(object_vector(instance, s.ng) * scale);
  const vec3 w = glm::max(glm::sqrt(glm::max(1.0f - n * n, vec3(0))) *
                              (t * spread / cosine * frequency * instance.pattern_scale.w),
                          vec3(1e-5f));
  const vec3 at = q + 0x1p-17f, cell = glm::floor(at);
  const float contrast = own_part(at.x, w.x) * own_part(at.y, w.y) * own_part(at.z, w.z);
  const bool odd = std::fmod(std::abs(cell.x + cell.y + cell.z), 2.0f) == 1;
  return 0.5f + (odd ? 0.5f : -0.5f) * contrast;
}

vec3 corner_of(const CompiledScene& scene, u32 place, std::size_t corner) {
  const float* at = scene.blocks[place >> 3].v0_x + 24 * corner + (place & 7u);
  return {at[0], at[8], at[16]};
}

/// How far the smooth surface of the corners' normals lies in front of a triangle, in object space, from the
/// tangent planes at the corners (Hanika 2021); nothing if a normal turns by more than 60 degrees.
std::optional<float> smooth_lift(const CompiledScene& scene, const Hit& hit, bool entering,
                                 const std::array<vec3, 3>& normals) {
  std::array<vec3, 3> corner;
  for (std::size_t i = 0; i < 3; ++i) corner[i] = corner_of(scene, scene.triangles[hit.prim].place, i);
  const vec3 p = interpolate(hit, corner[0], corner[1], corner[2]);
  const vec3 face = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
  const std::array share{1 - hit.u - hit.v, hit.u, hit.v};
  float lift = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(glm::dot(face, normals[i]) > 0.5f)) return std::nullopt;
    lift += share[i] * std::max(glm::dot(p - corner[i], entering ? -normals[i] : normals[i]), 0.0f);
  }
  return lift;
}

/// Sets a mesh's smooth normal, bent no further than the silhouette, its lift and its vertex colour.
void shade_mesh(const CompiledScene& scene, const Ray& ray, const Hit& hit, bool entering, Surface& s,
                vec3& color) {
  const TriangleShading& triangle = scene.triangles[hit.prim];
  const Vertex &a = scene.vertices[triangle.vertex[0]], &b = scene.vertices[triangle.vertex[1]],
               &c = scene.vertices[triangle.vertex[2]];
  color = interpolate(hit, color_of(a), color_of(b), color_of(c));
  const vec3 mean = interpolate(hit, normal_of(a), normal_of(b), normal_of(c));
  const vec3 ns = world_normal(scene.instances[hit.instance], mean);
  const float length = glm::length(ns);
  if (!(length > 0)) return;
  const vec3 facing = ns / (entering ? length : -length);
  const float towards = glm::dot(facing, ray.d);
  s.ns = towards < 0 ? facing : glm::normalize(facing - (towards + 1e-4f) * ray.d);
  if (s.material->flags & MATERIAL_TRANSMITS) return;
  const auto lift = smooth_lift(scene, hit, entering, {normal_of(a), normal_of(b), normal_of(c)});
  if (!lift) return;
  s.side = s.ns;
  s.lift = *lift * glm::length(mean) / length;
}

}  // namespace

glm::vec3 rgb(const float4& v) { return {v.x, v.y, v.z}; }

float power(float x, float e) {
  if (e != std::floor(e) || e > 65535) return std::pow(x, e);
  float result = 1;
  for (u32 bits = static_cast<u32>(e); bits; bits >>= 1) {
    if (bits & 1u) result *= x;
    x *= x;
  }
  return result;
}

const Material& material_of(const CompiledScene& scene, const Hit& hit) {
  const u32 own = scene.instances[hit.instance].material;
  return scene.materials[own != NO_MATERIAL ? own : scene.triangles[hit.prim].material];
}

float start_offset(const CompiledScene& scene, const vec3& o, const Hit& hit, const vec3& p,
                   const vec3& outward) {
  const Instance& instance = scene.instances[hit.instance];
  const float4* rows = instance.object_from_world;
  const u32 shape = instance.shape;
  const bool flat =
      shape == SHAPE_MESH || shape == SHAPE_PLANE || shape == SHAPE_DISK || shape == SHAPE_RECTANGLE;
  const float size = flat ? 0 : 1;
  float rounding = greatest_size(hit.ng * (glm::abs(vec3(rows[0].w, rows[1].w, rows[2].w)) + size));
  if (instance.shape == SHAPE_MESH)
    rounding = std::max(rounding, scene.triangles[hit.prim].extent * greatest_size(hit.ng));
  return std::max(std::max(greatest_size(o), greatest_size(p)) * 0x1p-19f,
                  rounding * 0x1p-21f / greatest_size(outward));
}

Surface make_surface(const CompiledScene& scene, const Ray& ray, const Hit& hit) {
  const Instance& instance = scene.instances[hit.instance];
  Surface s;
  s.material = &material_of(scene, hit);
  const vec3 normal = world_normal(instance, hit.ng), outward = glm::normalize(normal);
  const bool entering = glm::dot(outward, ray.d) < 0;
  s.ng = s.ns = s.side = entering ? outward : -outward;
  s.p = ray.o + hit.t * ray.d;
  s.offset = start_offset(scene, ray.o, hit, s.p, normal);
  vec3 color(1);
  if (instance.shape == SHAPE_MESH) shade_mesh(scene, ray, hit, entering, s, color);
  const u32 flags = s.material->flags;
  const float odd = flags & MATERIAL_CHECKER ? odd_part(scene, ray, hit.t, instance, s) : 0.0f;
  s.ambient = glm::mix(rgb(s.material->ambient), rgb(s.material->checker_ambient), odd);
  s.diffuse = glm::mix(rgb(s.material->diffuse), rgb(s.material->checker_diffuse), odd);
  if (flags & MATERIAL_VERTEX_COLOR) s.ambient *= color, s.diffuse *= color;
  return s;
}

bool knows_lobe(std::string_view name) {
  return name == "mirror" || name == "refraction" || name == "diffuse" || name == "highlight";
}
bool knows_light(u32 kind) { return kind == LIGHT_DIRECTIONAL || kind == LIGHT_POINT || kind == LIGHT_SPOT; }

LightSample sample_light(const Light& light, const vec3& p) {
  LightSample sample;
  sample.radiance = rgb(light.color);
  if (light.kind == LIGHT_DIRECTIONAL) {
    sample.wi = -rgb(light.direction);
    sample.distance = std::numeric_limits<float>::infinity();
    return sample;
  }
  const vec3 to = rgb(light.position) - p;
  const float d = sample.distance = glm::length(to);
  sample.wi = to / d;
  sample.radiance /= light.falloff_constant + light.falloff_linear * d + light.falloff_quadratic * d * d;
  const float part = d * light.edge_v.x;
  sample.radiance *= std::max(1 - part * part * part * part, 0.0f);
  if (light.kind == LIGHT_SPOT) {
    const float cosine = -glm::dot(sample.wi, rgb(light.direction)), outer = light.direction.w,
                inner = light.edge_u.z;
    const float s =
        inner > outer ? std::clamp((cosine - outer) / (inner - outer), 0.0f, 1.0f) : cosine >= outer;
    sample.radiance *= s * s * (light.edge_u.x - light.edge_u.y * s);
  }
  return sample;
}

vec3 local_reflection(const Surface& surface, const vec3& d, const vec3& wi) {
  const Material& material = *surface.material;
  const float n_dot_l = glm::dot(surface.ns, wi);
  const bool blinn = material.flags & MATERIAL_BLINN;
  const float cosine =
      blinn ? glm::dot(surface.ns, glm::normalize(wi - d)) : glm::dot(2 * n_dot_l * surface.ns - wi, -d);
  vec3 sum = surface.diffuse * n_dot_l;
  const float exponent = material.specular.w;
  if (cosine > 0 || exponent == 0)
    sum += rgb(material.specular) * power(std::clamp(cosine, 0.0f, 1.0f), exponent);
  return sum;
}

float refracted_cosine(float cos_i, float eta) {
  const float sin2 = (1 - cos_i * cos_i) / (eta * eta);
  return sin2 < 1 ? std::sqrt(1 - sin2) : 0;
}

float fresnel(float cos_i, float eta) {
  if (eta == 1) return 0;
  const float cos_t = refracted_cosine(cos_i, eta);
  if (cos_t <= 0) return 1;
  const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

}  // namespace sundog::plain
