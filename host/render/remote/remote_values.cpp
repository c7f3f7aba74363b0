// Writes arrays as bytes beside the JSON, and checks their lengths when reading.
#include "render/remote/remote_values.h"

#include <cstring>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/limits.h"
#include "render/plan/tiles.h"

namespace sundog {
namespace {

template <class T>
void append(std::string& bytes, const std::vector<T>& values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values.data()), count * sizeof(T));
}

template <class T>
std::vector<T> take(const std::string& bytes, std::size_t& at, std::size_t count) {
  std::vector<T> values(count);
  if (count > 0) std::memcpy(values.data(), bytes.data() + at, count * sizeof(T));
  at += count * sizeof(T);
  return values;
}

/// The length of an array that has one value per pixel or none at all.
std::size_t none_or_all(const nlohmann::json& count, std::size_t pixels) {
  const auto found = count.get<std::size_t>();
  if (found != 0 && found != pixels) throw DeviceError("a message has values for some of a tile's pixels");
  return found;
}

Tile tile_from(const nlohmann::json& values) {
  const Tile tile = values.at("tile").get<Tile>();
  if (tile.x < 0 || tile.x > most_edge || tile.y < 0 || tile.y > most_edge || tile.width < 1 ||
      tile.width > most_edge || tile.height < 0 || tile.height > most_edge ||
      std::int64_t{tile.width} * tile.height > most_pixels)
    throw DeviceError("a message is about a tile that no frame has");
  return tile;
}

/// Throws DeviceError unless the tile is the requested one or its first rows.
void check_asked(const Tile& tile, const Tile& asked) {
  if (tile.x != asked.x || tile.y != asked.y || tile.width != asked.width || tile.height > asked.height)
    throw DeviceError("a tile came that was not asked for");
}

}  // namespace

PackedTile pack_request(const TileRequest& request) {
  PackedTile packed;
  packed.values = {{"tile", request.tile}};
  packed.values["pass"] = {{"pixels", request.pixels.size()}, {"sums", request.sums.size()},
                           {"rays", request.rays.size()},     {"aovs", request.aovs.size()},
                           {"first", request.first_sample},   {"count", request.sample_count},
                           {"surfaces", request.surfaces},    {"costs", request.costs}};
  append(packed.data, request.pixels, request.pixels.size());
  visit_samples([&](const auto& array) { append(packed.data, array, array.size()); }, request);
  return packed;
}

TileRequest unpack_request(const nlohmann::json& values, const std::string& data) {
  TileRequest request;
  request.tile = tile_from(values);
  const nlohmann::json& pass = values.at("pass");
  request.first_sample = pass.at("first").get<u32>();
  request.sample_count = pass.at("count").get<u32>();
  request.surfaces = pass.at("surfaces").get<bool>();
  request.costs = pass.at("costs").get<bool>();
  const std::size_t all = pixel_count(request.tile);
  const std::size_t pixels = none_or_all(pass.at("pixels"), all), sums = none_or_all(pass.at("sums"), all),
                    rays = none_or_all(pass.at("rays"), all), aovs = pass.at("aovs").get<std::size_t>();
  if (aovs > most_aov_vectors * all || (all > 0 && aovs % all != 0) ||
      data.size() !=
          (pixels + rays) * sizeof(u32) + sums * (sizeof(float4) + sizeof(float)) + aovs * sizeof(float4))
    throw DeviceError("a tile was asked for with too many or too few bytes");
  std::size_t at = 0;
  request.pixels = take<u32>(data, at, pixels);
  request.sums = take<float4>(data, at, sums);
  request.weights = take<float>(data, at, sums);
  request.aovs = take<float4>(data, at, aovs);
  request.rays = take<u32>(data, at, rays);
  return request;
}

PackedTile pack_tile(const TileResult& result) {
  const std::size_t pixels = pixel_count(result.tile);
  PackedTile packed;
  packed.values = {{"tile", result.tile},
                   {"counts", result.counts},
                   {"aovs", result.aovs.size()},
                   {"rays", std::min(result.rays.size(), pixels)}};
  append(packed.data, result.sums, pixels);
  append(packed.data, result.weights, pixels);
  if (!result.aovs.empty()) append(packed.data, result.aovs, result.aovs.size());
  append(packed.data, result.rays, std::min(result.rays.size(), pixels));
  return packed;
}

TileResult unpack_tile(const nlohmann::json& values, const std::string& data, const TileRequest& request,
                       const std::vector<std::string>& aov_names) {
  TileResult result;
  result.tile = tile_from(values);
  check_asked(result.tile, request.tile);
  result.counts = values.at("counts").get<RayCounts>();
  const std::size_t pixels = pixel_count(result.tile);
  const bool counted = counts_rays(aov_names) || request.costs;
  const std::size_t aovs = none_or_all(values.at("aovs"),
                                       request.surfaces ? aov_layout(aov_names).vectors() * pixels : 0),
                    rays = none_or_all(values.at("rays"), counted ? pixels : 0);
  if (data.size() != pixels * (sizeof(float4) + sizeof(float)) + aovs * sizeof(float4) + rays * sizeof(u32))
    throw DeviceError("a tile came with too many or too few bytes");
  std::size_t at = 0;
  result.sums = take<float4>(data, at, pixels);
  result.weights = take<float>(data, at, pixels);
  result.aovs = take<float4>(data, at, aovs);
  result.rays = take<u32>(data, at, rays);
  return result;
}

}  // namespace sundog
