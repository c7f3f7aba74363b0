// Surfaces and lights in plain scalar C++: shading data of a hit, light samples, and the reflection of a
// light.
#pragma once
#include <string_view>

#include "bench/plain/tracer.h"

namespace sundog::plain {

struct Surface {
  glm::vec3 p{0};
  glm::vec3 ng{0}, ns{0};  // unit, facing the ray's origin
  glm::vec3 side{0};       // likewise; reflected rays must leave to this side
  float offset = 0;        // of the start of new rays from the surface
  float lift = 0;          // how far the smooth surface of the vertex normals lies in front
  const Material* material = nullptr;
  glm::vec3 ambient{0}, diffuse{0};  // with checker and vertex colour
};

glm::vec3 rgb(const float4& v);

/// x^e, by squaring for whole e.
float power(float x, float e);

const Material& material_of(const CompiledScene& scene, const Hit& hit);

/// How far off the surface at p a new ray starts. `outward`: the hit's world_normal(), not normalised.
float start_offset(const CompiledScene& scene, const glm::vec3& o, const Hit& hit, const glm::vec3& p,
                   const glm::vec3& outward);

Surface make_surface(const CompiledScene& scene, const Ray& ray, const Hit& hit);

struct LightSample {
  glm::vec3 wi{0};  // unit, to the light
  float distance = 0;
  glm::vec3 radiance{0};  // before shadowing
};

/// Whether the plain program implements this lobe of shared/lobes.h, or this kind of light.
bool knows_lobe(std::string_view name);
bool knows_light(u32 kind);

LightSample sample_light(const Light& light, const glm::vec3& p);

/// kd (n.l) + ks (r.v)^beta (Phong), or with (n.h)^beta (Blinn).
glm::vec3 local_reflection(const Surface& surface, const glm::vec3& d, const glm::vec3& wi);

/// Reflectance of an interface between dielectrics, unpolarised; eta is the far index over the near one.
float fresnel(float cos_i, float eta);

/// Cosine of the refracted angle; 0 at total reflection.
float refracted_cosine(float cos_i, float eta);

}  // namespace sundog::plain
