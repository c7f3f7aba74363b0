// Traces a ray per texel from the cage inwards, in batches, and stores the hit's normal, height or, with more
// rays, occlusion. Finally fills gaps and margins.
#include "app/bake/bake.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "bench/plain/tracer.h"

namespace sundog {
namespace {

/// Texels and occlusion rays per batch.
constexpr std::size_t texels_at_once = std::size_t{1} << 18, rays_at_once = std::size_t{1} << 20;

Ray make_ray(const CompiledScene& scene, const dvec3& origin, const dvec3& direction, double length) {
  const glm::vec3 o(origin - scene.origin), d(direction);
  return {o.x, o.y, o.z, 0.0f, d.x, d.y, d.z, static_cast<float>(length)};
}

/// The outward shading normal of a hit, in world space.
dvec3 normal_at(const CompiledScene& scene, const Hit& hit) {
  const Instance& instance = scene.instances[hit.instance];
  glm::vec3 n(hit.ng_x, hit.ng_y, hit.ng_z);
  if (instance.shape == SHAPE_MESH) {
    const u32* corner = scene.triangles[hit.prim].vertex;
    const auto normal = [&](u32 i) {
      const Vertex& vertex = scene.vertices[corner[i]];
      return glm::vec3(vertex.nx, vertex.ny, vertex.nz);
    };
    n = (1 - hit.u - hit.v) * normal(0) + hit.u * normal(1) + hit.v * normal(2);
  }
  return glm::normalize(dvec3(plain::world_normal(instance, n)));
}

std::uint8_t byte_of(double value) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

u32 hash(u32 x) {  // Wellons' lowbias32
  x = (x ^ x >> 16) * 0x7feb352du;
  x = (x ^ x >> 15) * 0x846ca68bu;
  return x ^ x >> 16;
}

double radical_inverse(u32 i) {
  u32 bits = 0;
  for (int k = 0; k < 32; ++k, i >>= 1) bits = bits << 1 | (i & 1);
  return bits * 0x1p-32;
}

/// The i-th of `count` cosine-distributed directions around `normal`, shifted by random numbers of the texel.
dvec3 cosine_direction(const dvec3& normal, u32 i, u32 count, u32 texel) {
  const double turn = hash(texel) * 0x1p-32, lift = hash(texel ^ 0x9E3779B9u) * 0x1p-32;
  const double u = std::fmod((i + 0.5) / count + lift, 1.0),
               angle = 2 * std::numbers::pi * std::fmod(radical_inverse(i) + turn, 1.0);
  const dvec3 side = std::abs(normal.x) > 0.7 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
  const dvec3 t = glm::normalize(glm::cross(normal, side)), b = glm::cross(normal, t);
  const double r = std::sqrt(u);
  return r * std::cos(angle) * t + r * std::sin(angle) * b + std::sqrt(std::max(1 - u, 0.0)) * normal;
}

class Baker {
 public:
  Baker(const CompiledScene& high, RayTracer& tracer, const std::vector<LowTriangle>& low,
        const Coverage& coverage, const BakeSettings& settings)
      : high_(high), tracer_(tracer), low_(low), coverage_(coverage), settings_(settings) {
    StoredImage& image = map_.image;
    image.width = image.height = coverage.size;
    image.channels = settings.kind == BakeKind::normal ? 4 : 1;
    image.sample = settings.kind == BakeKind::height ? StoredImage::Sample::word : StoredImage::Sample::byte;
    image.data.resize(image.pixel_count() * image.pixel_bytes());
    filled_.resize(image.pixel_count());
    map_.lowest = std::numeric_limits<double>::infinity();
    map_.highest = -map_.lowest;
  }

  BakedMap run(const std::function<void(std::size_t)>& progress) {
    std::vector<std::size_t> texels;
    for (std::size_t i = 0; i < coverage_.texels.size(); ++i) {
      if (coverage_.texels[i].triangle != Texel::nowhere) texels.push_back(i);
      const bool last = i + 1 == coverage_.texels.size();
      if (texels.size() < texels_at_once && !(last && !texels.empty())) continue;
      bake_texels(texels);
      texels.clear();
      progress(i + 1);
    }
    fill_missing();
    dilate(map_.image, filled_, std::max(8, coverage_.size / 32));
    return std::move(map_);
  }

 private:
  LowPoint point_of_texel(std::size_t texel) const {
    const Texel& at = coverage_.texels[texel];
    return point_of(low_[at.triangle], at);
  }

  /// Traces rays from the cage inwards, so the outermost surface counts.
  void bake_texels(const std::vector<std::size_t>& texels) {
    std::vector<Ray> rays;
    for (const std::size_t texel : texels) {
      const LowPoint point = point_of_texel(texel);
      rays.push_back(
          make_ray(high_, point.position + settings_.cage * point.normal, -point.normal, 2 * settings_.cage));
    }
    const std::vector<Hit> hits = tracer_.trace(rays);
    std::vector<std::size_t> met;
    std::vector<dvec3> places, normals;
    for (std::size_t i = 0; i < texels.size(); ++i) {
      if (hits[i].instance == NO_INSTANCE) {
        ++map_.missed;
        continue;
      }
      const LowPoint point = point_of_texel(texels[i]);
      const dvec3 normal = normal_at(high_, hits[i]);
      if (settings_.kind == BakeKind::normal) set_normal(texels[i], point, normal);
      if (settings_.kind == BakeKind::height) set_height(texels[i], settings_.cage - double(hits[i].t));
      if (settings_.kind != BakeKind::occlusion) continue;
      met.push_back(texels[i]);
      places.push_back(point.position + (settings_.cage - double(hits[i].t)) * point.normal);
      normals.push_back(glm::dot(normal, point.normal) < 0 ? -normal : normal);
    }
    if (settings_.kind == BakeKind::occlusion) bake_occlusion(met, places, normals);
  }

  /// Stores the normal in the tangent frame that rendering uses, whose axes need not be orthogonal.
  void set_normal(std::size_t texel, const LowPoint& point, const dvec3& normal) {
    const glm::dmat3 frame(point.tangent, point.bitangent, point.normal);
    dvec3 local = std::abs(glm::determinant(frame)) > 1e-6 ? glm::inverse(frame) * normal : dvec3(0, 0, 1);
    local = glm::normalize(local);
    for (int c = 0; c < 3; ++c)
      map_.image.data[4 * texel + static_cast<std::size_t>(c)] = byte_of(0.5 + 0.5 * local[c]);
    map_.image.data[4 * texel + 3] = 255;
    filled_[texel] = true;
  }

  void set_height(std::size_t texel, double height) {
    const auto word = static_cast<std::uint16_t>(
        std::lround(65535 * std::clamp(0.5 + 0.5 * height / settings_.cage, 0.0, 1.0)));
    std::memcpy(map_.image.data.data() + 2 * texel, &word, 2);
    map_.lowest = std::min(map_.lowest, height);
    map_.highest = std::max(map_.highest, height);
    filled_[texel] = true;
  }

  void bake_occlusion(const std::vector<std::size_t>& texels, const std::vector<dvec3>& places,
                      const std::vector<dvec3>& normals) {
    const auto samples = static_cast<std::size_t>(settings_.samples);
    const std::size_t at_once = std::max<std::size_t>(1, rays_at_once / samples);
    for (std::size_t first = 0; first < texels.size(); first += at_once) {
      const std::size_t count = std::min(at_once, texels.size() - first);
      std::vector<Ray> rays;
      for (std::size_t i = first; i < first + count; ++i)
        for (std::size_t k = 0; k < samples; ++k) {
          const dvec3 d = cosine_direction(normals[i], static_cast<u32>(k), static_cast<u32>(samples),
                                           static_cast<u32>(texels[i]));
          rays.push_back(make_ray(high_, places[i] + 1e-3 * settings_.cage * normals[i], d,
                                  std::numeric_limits<double>::infinity()));
        }
      const std::vector<u32> dark = tracer_.occlusion(rays);
      for (std::size_t i = 0; i < count; ++i) {
        const auto begin = dark.begin() + static_cast<std::ptrdiff_t>(i * samples);
        const auto held = std::count(begin, begin + static_cast<std::ptrdiff_t>(samples), 1u);
        map_.image.data[texels[first + i]] =
            byte_of(1 - static_cast<double>(held) / static_cast<double>(samples));
        filled_[texels[first + i]] = true;
      }
    }
  }

  /// Fills missing texels with the plain surface's value; dilate() overwrites those near baked texels.
  void fill_missing() {
    for (std::size_t i = 0; i < filled_.size(); ++i) {
      if (filled_[i]) continue;
      if (settings_.kind == BakeKind::normal) {
        const std::uint8_t flat[4] = {128, 128, 255, 255};
        std::copy_n(flat, 4, map_.image.data.begin() + static_cast<std::ptrdiff_t>(4 * i));
      } else if (settings_.kind == BakeKind::height) {
        const std::uint16_t middle = 32768;
        std::memcpy(map_.image.data.data() + 2 * i, &middle, 2);
      } else {
        map_.image.data[i] = 255;
      }
    }
  }

  const CompiledScene& high_;
  RayTracer& tracer_;
  const std::vector<LowTriangle>& low_;
  const Coverage& coverage_;
  const BakeSettings& settings_;
  BakedMap map_;
  std::vector<bool> filled_;
};

/// The value of a pixel's channel.
double get_sample(const StoredImage& image, std::size_t pixel, int channel) {
  const std::size_t at = pixel * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(channel);
  if (image.sample == StoredImage::Sample::byte) return image.data[at];
  std::uint16_t word = 0;
  std::memcpy(&word, image.data.data() + 2 * at, 2);
  return word;
}
void set_sample(StoredImage& image, std::size_t pixel, int channel, double value) {
  const std::size_t at = pixel * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(channel);
  if (image.sample == StoredImage::Sample::byte) {
    image.data[at] = static_cast<std::uint8_t>(std::lround(value));
    return;
  }
  const auto word = static_cast<std::uint16_t>(std::lround(value));
  std::memcpy(image.data.data() + 2 * at, &word, 2);
}

/// The filled neighbours of a pixel; the map repeats.
std::vector<std::size_t> filled_around(const StoredImage& image, const std::vector<bool>& filled, int x,
                                       int y) {
  std::vector<std::size_t> around;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const int nx = (x + dx + image.width) % image.width, ny = (y + dy + image.height) % image.height;
      const auto at =
          static_cast<std::size_t>(ny) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(nx);
      if (filled[at]) around.push_back(at);
    }
  return around;
}

}  // namespace

void dilate(StoredImage& image, std::vector<bool>& filled, int rings) {
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<std::size_t> fresh;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
        if (filled[pixel]) continue;
        const std::vector<std::size_t> around = filled_around(image, filled, x, y);
        if (around.empty()) continue;
        for (int c = 0; c < image.channels; ++c) {
          double sum = 0;
          for (const std::size_t from : around) sum += get_sample(image, from, c);
          set_sample(image, pixel, c, sum / static_cast<double>(around.size()));
        }
        fresh.push_back(pixel);
      }
    if (fresh.empty()) return;
    for (const std::size_t pixel : fresh) filled[pixel] = true;
  }
}

BakedMap bake(const CompiledScene& high, RayTracer& tracer, const std::vector<LowTriangle>& low,
              const Coverage& coverage, const BakeSettings& settings,
              const std::function<void(std::size_t done)>& progress) {
  return Baker(high, tracer, low, coverage, settings).run(progress);
}

}  // namespace sundog
