// Converts the numbers of materials to those of their lobes: on devices for textures, on the host
// (host/models/values/lowering.h, in doubles) for constants of a scene.

// Metalness and roughness (glTF 2.0, appendix B) in terms of the phong model. For base colour b, metalness m,
// roughness r and a dielectric's normal reflectance f:
//   mirror share  k = m (1 - r)^2: only a smooth metal is a mirror
//   reflection    b k
//   highlight     s = f (1 - m) + b m, Blinn with exponent 2 / r^4 - 2 (Karis 2013: alpha = r^2). It
//                 returns s h of uniform light, where h is at most (1 - k) / 2: a rough one is
//                 weaker
//   diffuse       b (1 - k - h (m + f (1 - m))), the rest, and a tenth of it ambient
static inline LOWERED metal_mirror(LOWERED metalness, LOWERED roughness) {
  const LOWERED smooth = 1.0f - roughness;
  return metalness * smooth * smooth;
}
static inline LOWERED rough_exponent(LOWERED roughness) {
  const LOWERED square = roughness * roughness;
  return real_clamp(2.0f / real_clamp(square * square, 1e-9f, 1.0f) - 2.0f, 1.0f, 1e5f);
}
// The fraction of uniform white light that max(n.h, 0)^e reflects along n, its maximum.
static inline LOWERED highlight_energy(LOWERED e) {
  return 8.0f * (1.0f - real_exp(-0.34657359f * (e + 2.0f))) / (e + 2.0f);
}
// h above. A mirror keeps its small highlight.
static inline LOWERED metal_highlight(LOWERED energy, LOWERED mirror) {
  return real_clamp(0.5f * (1.002f - mirror), 0.0f, energy);
}

// Layered materials (shared/layers.h). The relative index of a dielectric base of this index below one of the
// index `above`, inverted if below 1; `scale`: the root of the factor on its normal reflectance (OpenPBR 1.1,
// "Coat", "Index of refraction").
static inline LOWERED base_index(LOWERED index, LOWERED scale, LOWERED above) {
  const LOWERED root = real_min(scale * fabs(index - above) / (index + above), 0.99949987f);
  return (1.0f + root) / (1.0f - root);
}
// The base's roughness as seen through a coat of this weight, whose facets blur it; `haze`: twice the 4th
// power of the coat's roughness.
static inline LOWERED seen_roughness(LOWERED roughness, LOWERED haze, LOWERED coat_weight) {
  const LOWERED square = roughness * roughness;
  const LOWERED both = real_sqrt(real_sqrt(real_min(1.0f, fma(square, square, haze))));
  return real_clamp(fma(coat_weight, both - roughness, roughness), 0.0f, 1.0f);
}
// How diffuse a base is for light that a coat sends back to it; `straight`: its normal reflectance.
static inline LOWERED base_diffuseness(LOWERED straight, LOWERED metalness, LOWERED roughness) {
  const LOWERED of_glass = fma(straight, roughness - 1.0f, 1.0f);
  return fma(metalness, roughness - of_glass, of_glass);
}
