// Sixteen pixels of a 4x4 tile at a time: every loop over the lanes is omp simd, masks take the place of
// branches.
#include <algorithm>
#include <cmath>

#include "mandelbulb_peer.h"

namespace {

constexpr int N = 16;
struct alignas(64) F {
  float v[N];
};
struct alignas(64) M {
  int v[N];
};
struct V {
  F x, y, z;
};

#define LANES_DO _Pragma("omp simd") for (int l = 0; l < N; ++l)

bool any(const M& m) {
  int all = 0;
  _Pragma("omp simd reduction(| : all)") for (int l = 0; l < N; ++l) all |= m.v[l];
  return all != 0;
}

class Renderer {
 public:
  explicit Renderer(const Picture& p) : p_(p) {}

  void tile(int x0, int y0, float* shades) const {
    const float scale = 2 * p_.half_angle / static_cast<float>(p_.height);
    V o, d;
    M active;
    LANES_DO {
      const int row = y0 + l / 4;
      const float a = (static_cast<float>(x0 + l % 4) + 0.5f - 0.5f * static_cast<float>(p_.width)) * scale;
      const float b = (0.5f * static_cast<float>(p_.height) - static_cast<float>(row) - 0.5f) * scale;
      const float x = p_.forward[0] + a * p_.right[0] + b * p_.up[0];
      const float y = p_.forward[1] + a * p_.right[1] + b * p_.up[1];
      const float z = p_.forward[2] + a * p_.right[2] + b * p_.up[2];
      const float inverse = 1 / std::sqrt(x * x + y * y + z * z);
      o.x.v[l] = p_.origin[0];
      o.y.v[l] = p_.origin[1];
      o.z.v[l] = p_.origin[2];
      d.x.v[l] = x * inverse;
      d.y.v[l] = y * inverse;
      d.z.v[l] = z * inverse;
      active.v[l] = -1;
    }
    F t, threshold;
    const M hit = march(o, d, active, scale, t, threshold);
    F shade;
    LANES_DO shade.v[l] = 0;
    if (any(hit)) light(o, d, t, threshold, hit, shade);
    for (int l = 0; l < N; ++l) shades[(y0 + l / 4) * p_.width + x0 + l % 4] = shade.v[l];
  }

 private:
  void distance(const V& p, const M& active, F& out) const {
    const float bailout = p_.bailout * p_.bailout;
    V z = p;
    F r2, dr;
    M alive, entered;
    LANES_DO {
      r2.v[l] = z.x.v[l] * z.x.v[l] + z.y.v[l] * z.y.v[l] + z.z.v[l] * z.z.v[l];
      dr.v[l] = 1;
      alive.v[l] = active.v[l] & (r2.v[l] < bailout ? -1 : 0);
      entered.v[l] = alive.v[l];
    }
    int i = 0;
    for (; i < p_.iterations && any(alive); ++i) {
      LANES_DO {
        const float x = z.x.v[l], y = z.y.v[l], w = z.z.v[l], q = r2.v[l];
        const float r4 = q * q, r8 = r4 * r4;
        const float growth = 8 * (q * r4) * std::sqrt(q) * dr.v[l] + 1;
        const float x2 = x * x, rho2 = x2 + y * y, rho4 = rho2 * rho2;
        const float a2 = 2 * w * w - q, a4 = 2 * a2 * a2 - r4, a8 = 2 * a4 * a4 - r8;
        const float c2 = 2 * x2 - rho2, c4 = 2 * c2 * c2 - rho4, c8 = 2 * c4 * c4 - rho4 * rho4;
        const float kept = std::max(rho2, 1e-10f);
        const float factor = 8 * w * a2 * a4 / (kept * kept * kept * std::sqrt(kept));
        const bool on = alive.v[l] != 0;
        dr.v[l] = on ? growth : dr.v[l];
        z.x.v[l] = on ? factor * c8 + p.x.v[l] : x;
        z.y.v[l] = on ? factor * (8 * x * y * c2 * c4) + p.y.v[l] : y;
        z.z.v[l] = on ? a8 + p.z.v[l] : w;
        const float square = z.x.v[l] * z.x.v[l] + z.y.v[l] * z.y.v[l] + z.z.v[l] * z.z.v[l];
        r2.v[l] = square;
        entered.v[l] = alive.v[l];
        alive.v[l] &= square < bailout ? -1 : 0;
      }
    }
    const float level = i == p_.iterations ? std::log(bailout) : 0;
    LANES_DO {
      const float rise = std::log(std::max(r2.v[l], 1e-30f)) - (entered.v[l] ? level : 0);
      out.v[l] = std::max(0.25f * rise * std::sqrt(r2.v[l]) / dr.v[l], -1e-3f);
    }
  }

  void along(const V& o, const F& t, const V& d, V& p) const {
    LANES_DO {
      p.x.v[l] = o.x.v[l] + t.v[l] * d.x.v[l];
      p.y.v[l] = o.y.v[l] + t.v[l] * d.y.v[l];
      p.z.v[l] = o.z.v[l] + t.v[l] * d.z.v[l];
    }
  }

  void interval(const V& o, const V& d, F& enter, F& leave) const {
    const F* from[3] = {&o.x, &o.y, &o.z};
    const F* dir[3] = {&d.x, &d.y, &d.z};
    for (int i = 0; i < 3; ++i) LANES_DO {
        const float w = dir[i]->v[l], inverse = 1 / (std::abs(w) < 1e-30f ? 1e-30f : w);
        const float a = (-p_.bound - from[i]->v[l]) * inverse, b = (p_.bound - from[i]->v[l]) * inverse;
        enter.v[l] = std::max(enter.v[l], std::min(a, b));
        leave.v[l] = std::min(leave.v[l], std::max(a, b));
      }
  }

  M march(const V& o, const V& d, M active, float spread, F& t, F& threshold) const {
    F last, previous, step, slope;
    M hit, relaxed;
    LANES_DO {
      t.v[l] = 0;
      last.v[l] = 1e20f;
      previous.v[l] = step.v[l] = 0;
      slope.v[l] = -1;
      hit.v[l] = relaxed.v[l] = 0;
      threshold.v[l] = 0;
    }
    interval(o, d, t, last);
    LANES_DO active.v[l] &= t.v[l] <= last.v[l] ? -1 : 0;
    for (int i = 0; i < p_.step_limit && any(active); ++i) {
      V p;
      F f;
      along(o, t, d, p);
      distance(p, active, f);
      LANES_DO {
        const float limit = std::min(std::max(t.v[l] * spread * p_.detail, p_.least), p_.greatest);
        const int on = active.v[l];
        threshold.v[l] = on ? limit : threshold.v[l];
        const int gap = on & relaxed.v[l] & (f.v[l] + previous.v[l] < step.v[l] ? -1 : 0),
                  forward = on & ~gap;
        const int arrived = forward & (f.v[l] < limit ? -1 : 0);
        hit.v[l] |= arrived;
        const float measured =
            std::min(std::max((f.v[l] - previous.v[l]) / std::max(step.v[l], 1e-30f), -1.0f), 0.5f);
        const float smoothed =
            (forward & (step.v[l] > 0 ? -1 : 0)) ? 0.5f * (slope.v[l] + measured) : slope.v[l];
        const float s = gap ? -1.0f : smoothed;
        slope.v[l] = s;
        const float proven = std::max(f.v[l], 0.5f * limit), remaining = last.v[l] - t.v[l];
        const int through = forward & ~arrived & (proven >= remaining ? -1 : 0);
        active.v[l] = on & ~(arrived | through);
        const float stride = std::min(std::max(2 * f.v[l] / (1 - s), proven), remaining);
        relaxed.v[l] = forward & (stride > proven ? -1 : 0);
        const float back = std::min(std::max(limit - f.v[l], 0.0f), step.v[l]);
        t.v[l] += gap ? previous.v[l] - step.v[l] : arrived ? -back : active.v[l] ? stride : 0.0f;
        step.v[l] = gap ? previous.v[l] : stride;
        previous.v[l] = gap ? previous.v[l] : f.v[l];
      }
    }
    LANES_DO hit.v[l] |= active.v[l];
    return hit;
  }

  void light(const V& o, const V& d, const F& t, const F& threshold, const M& hit, F& shade) const {
    static constexpr float corners[4][3] = {{1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, 1, 1}};
    V p, n, q, wi;
    F f, cosine;
    along(o, t, d, p);
    LANES_DO n.x.v[l] = n.y.v[l] = n.z.v[l] = 0;
    for (const auto& k : corners) {
      LANES_DO {
        q.x.v[l] = p.x.v[l] + 0.5f * k[0] * threshold.v[l];
        q.y.v[l] = p.y.v[l] + 0.5f * k[1] * threshold.v[l];
        q.z.v[l] = p.z.v[l] + 0.5f * k[2] * threshold.v[l];
      }
      distance(q, hit, f);
      LANES_DO {
        n.x.v[l] += k[0] * f.v[l];
        n.y.v[l] += k[1] * f.v[l];
        n.z.v[l] += k[2] * f.v[l];
      }
    }
    M facing;
    LANES_DO {
      const float square = n.x.v[l] * n.x.v[l] + n.y.v[l] * n.y.v[l] + n.z.v[l] * n.z.v[l];
      const float inverse = 1 / std::sqrt(std::max(square, 1e-30f));
      n.x.v[l] = square > 0 ? n.x.v[l] * inverse : 1;
      n.y.v[l] *= inverse;
      n.z.v[l] *= inverse;
      wi.x.v[l] = p_.light[0];
      wi.y.v[l] = p_.light[1];
      wi.z.v[l] = p_.light[2];
      cosine.v[l] = std::max(n.x.v[l] * p_.light[0] + n.y.v[l] * p_.light[1] + n.z.v[l] * p_.light[2], 0.0f);
      p.x.v[l] += 2 * threshold.v[l] * n.x.v[l];
      p.y.v[l] += 2 * threshold.v[l] * n.y.v[l];
      p.z.v[l] += 2 * threshold.v[l] * n.z.v[l];
      facing.v[l] = hit.v[l] & (cosine.v[l] > 0 ? -1 : 0);
    }
    F open, lit;
    openness(p, n, hit, open);
    shadow(p, wi, threshold, facing, lit);
    LANES_DO shade.v[l] = hit.v[l] ? 0.8f * cosine.v[l] * lit.v[l] + 0.2f * open.v[l] : shade.v[l];
  }

  void openness(const V& p, const V& n, const M& hit, F& open) const {
    F missing, h, d;
    V q;
    float weight = 1, total = 0;
    LANES_DO missing.v[l] = 0;
    for (int i = 1; i <= 5; ++i) {
      const float height = 0.2f * static_cast<float>(i) * 0.2f;
      LANES_DO h.v[l] = height;
      along(p, h, n, q);
      distance(q, hit, d);
      LANES_DO missing.v[l] += weight * std::max(height - d.v[l], 0.0f) / height;
      total += weight;
      weight *= 0.6f;
    }
    LANES_DO open.v[l] = std::min(std::max(1 - missing.v[l] / total, 0.0f), 1.0f);
  }

  void shadow(const V& p, const V& wi, const F& threshold, M active, F& open) const {
    F t, leave, d;
    V q;
    LANES_DO {
      t.v[l] = 2 * threshold.v[l];
      leave.v[l] = 4;
      open.v[l] = 1;
    }
    interval(p, wi, t, leave);
    LANES_DO active.v[l] &= t.v[l] <= leave.v[l] ? -1 : 0;
    for (int i = 0; i < p_.step_limit && any(active); ++i) {
      along(p, t, wi, q);
      distance(q, active, d);
      LANES_DO {
        const float seen = std::min(open.v[l], 16 * d.v[l] / t.v[l]);
        open.v[l] = active.v[l] ? seen : open.v[l];
        t.v[l] += std::max(d.v[l], 0.02f * t.v[l]);
        active.v[l] &= (open.v[l] > 0.002f ? -1 : 0) & (t.v[l] < leave.v[l] ? -1 : 0);
      }
    }
    LANES_DO open.v[l] = std::min(std::max(open.v[l], 0.0f), 1.0f);
  }

  const Picture& p_;
};

}  // namespace

void render_simd(const Picture& picture, std::vector<float>& shades) {
  const Renderer renderer(picture);
  for (int y = 0; y < picture.height; y += 4)
    for (int x = 0; x < picture.width; x += 4) renderer.tile(x, y, shades.data());
}
