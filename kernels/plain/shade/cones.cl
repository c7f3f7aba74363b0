// Changes of pixel cones by reflection and refraction, at a surface of some curvature.
#include "plain/path/scene_ray.cl"
#include "plain/shade/specular.cl"

// Neighbouring rays diverge by twice the angle between their normals.
ENTRY static inline void spread_reflected(float curvature, SceneRay* child) {
  if (HAS_CONES) child->cone_spread = fma(2.0f * curvature, child->cone_width, child->cone_spread);
}

// Snell's law for neighbouring rays perpendicular to the plane of incidence (Coddington's sagittal equation).
ENTRY static inline void spread_transmitted(float curvature, const SpecularSplit* split, SceneRay* child) {
  if (HAS_CONES && split->eta != 1.0f) {
    const float inverse = 1.0f / split->eta, bend = split->cos_t - split->cos_i * inverse;
    child->cone_spread = fma(-curvature * bend, child->cone_width, child->cone_spread * inverse);
  }
}
