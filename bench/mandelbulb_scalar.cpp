// One pixel at a time, with branches.
#include <algorithm>
#include <cmath>

#include "mandelbulb_peer.h"

namespace {

struct V {
  float x, y, z;
};
V operator+(V a, V b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
V operator*(V a, float s) { return {a.x * s, a.y * s, a.z * s}; }
float dot(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
V unit(V a) { return a * (1 / std::sqrt(dot(a, a))); }
V vec(const float* f) { return {f[0], f[1], f[2]}; }

class Renderer {
 public:
  explicit Renderer(const Picture& p) : p_(p), light_(vec(p.light)) {}

  float pixel(int x, int y) const {
    const float scale = 2 * p_.half_angle / static_cast<float>(p_.height);
    const float a = (static_cast<float>(x) + 0.5f - 0.5f * static_cast<float>(p_.width)) * scale;
    const float b = (0.5f * static_cast<float>(p_.height) - static_cast<float>(y) - 0.5f) * scale;
    const V o = vec(p_.origin), d = unit(vec(p_.forward) + vec(p_.right) * a + vec(p_.up) * b);
    float t = 0, threshold = 0;
    if (!march(o, d, scale, t, threshold)) return 0;
    const V at = o + d * t, n = normal(at, 0.5f * threshold);
    const V above = at + n * (2 * threshold);
    const float cosine = dot(n, light_);
    const float lit = cosine > 0 ? cosine * shadow(above, 2 * threshold) : 0;
    return 0.8f * lit + 0.2f * openness(above, n);
  }

 private:
  float distance(V p) const {
    const float bailout = p_.bailout * p_.bailout;
    V z = p;
    float r2 = dot(z, z), dr = 1;
    int i = 0;
    for (; i < p_.iterations && r2 < bailout; ++i) {
      const float r4 = r2 * r2, r8 = r4 * r4;
      dr = 8 * (r2 * r4) * std::sqrt(r2) * dr + 1;
      const float x2 = z.x * z.x, y2 = z.y * z.y, rho2 = x2 + y2, rho4 = rho2 * rho2;
      const float a2 = 2 * z.z * z.z - r2, a4 = 2 * a2 * a2 - r4, a8 = 2 * a4 * a4 - r8;
      const float c2 = 2 * x2 - rho2, c4 = 2 * c2 * c2 - rho4, c8 = 2 * c4 * c4 - rho4 * rho4;
      const float kept = std::max(rho2, 1e-10f);
      const float factor = 8 * z.z * a2 * a4 / (kept * kept * kept * std::sqrt(kept));
      z = V{factor * c8, factor * (8 * z.x * z.y * c2 * c4), a8} + p;
      r2 = dot(z, z);
    }
    const float level = i == p_.iterations ? std::log(bailout) : 0;
    return std::max(0.25f * (std::log(std::max(r2, 1e-30f)) - level) * std::sqrt(r2) / dr, -1e-3f);
  }

  bool interval(V o, V d, float& enter, float& leave) const {
    const float from[3] = {o.x, o.y, o.z}, along[3] = {d.x, d.y, d.z};
    for (int i = 0; i < 3; ++i) {
      const float inverse = 1 / (std::abs(along[i]) < 1e-30f ? 1e-30f : along[i]);
      const float a = (-p_.bound - from[i]) * inverse, b = (p_.bound - from[i]) * inverse;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
  }

  bool march(V o, V d, float spread, float& t, float& threshold) const {
    float last = 1e20f;
    if (!interval(o, d, t, last)) return false;
    float previous = 0, step = 0, slope = -1;
    bool relaxed = false;
    for (int i = 0; i < p_.step_limit; ++i) {
      const float f = distance(o + d * t);
      threshold = std::clamp(t * spread * p_.detail, p_.least, p_.greatest);
      if (relaxed && f + previous < step) {
        t += previous - step;
        step = previous;
        slope = -1;
        relaxed = false;
        continue;
      }
      if (f < threshold) {
        t -= std::min(std::max(threshold - f, 0.0f), step);  // back to where the surface is a threshold away
        return true;
      }
      const float remaining = last - t;
      if (f >= remaining) return false;
      if (step > 0) slope = 0.5f * (slope + std::clamp((f - previous) / step, -1.0f, 0.5f));
      step = std::min(std::max(2 * f / (1 - slope), f), remaining);
      relaxed = step > f;
      previous = f;
      t += step;
    }
    return true;
  }

  V normal(V p, float e) const {
    static constexpr V corners[4] = {{1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, 1, 1}};
    V sum{0, 0, 0};
    for (const V& k : corners) sum = sum + k * distance(p + k * e);
    return dot(sum, sum) > 0 ? unit(sum) : V{1, 0, 0};
  }

  float openness(V p, V n) const {
    float missing = 0, weight = 1, total = 0;
    for (int i = 1; i <= 5; ++i) {
      const float h = 0.2f * static_cast<float>(i) * 0.2f;
      missing += weight * std::max(h - distance(p + n * h), 0.0f) / h;
      total += weight;
      weight *= 0.6f;
    }
    return std::clamp(1 - missing / total, 0.0f, 1.0f);
  }

  float shadow(V p, float t) const {
    float leave = 4, open = 1;
    if (!interval(p, light_, t, leave)) return 1;
    for (int i = 0; i < p_.step_limit; ++i) {
      const float d = distance(p + light_ * t);
      open = std::min(open, 16 * d / t);
      t += std::max(d, 0.02f * t);
      if (open <= 0.002f || t >= leave) break;
    }
    return std::clamp(open, 0.0f, 1.0f);
  }

  const Picture& p_;
  V light_;
};

}  // namespace

void render_scalar(const Picture& picture, std::vector<float>& shades) {
  const Renderer renderer(picture);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      shades[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
             static_cast<std::size_t>(x)] = renderer.pixel(x, y);
}
