#include "render/remote/remote_values.h"

#include <cstring>
#include <nlohmann/json.hpp>

#include "base/error.h"
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
  std::memcpy(values.data(), bytes.data() + at, count * sizeof(T));
  at += count * sizeof(T);
  return values;
}

}  // namespace

PackedTile pack_request(const TileRequest& request) {
  PackedTile packed;
  packed.values = {{"tile", request.tile}};
  if (!request.in_pass) return packed;
  packed.values["pass"] = {{"pixels", request.pixels.size()}, {"sums", request.sums.size()},
                           {"rays", request.rays.size()},     {"first", request.first_sample},
                           {"count", request.sample_count},   {"surfaces", request.surfaces},
                           {"costs", request.costs}};
  append(packed.data, request.pixels, request.pixels.size());
  append(packed.data, request.sums, request.sums.size());
  append(packed.data, request.weights, request.weights.size());
  append(packed.data, request.rays, request.rays.size());
  return packed;
}

TileRequest unpack_request(const nlohmann::json& values, const std::string& data) {
  TileRequest request;
  request.tile = values.at("tile").get<Tile>();
  if (!values.contains("pass")) return request;
  const nlohmann::json& pass = values.at("pass");
  request.in_pass = true;
  request.first_sample = pass.at("first").get<u32>();
  request.sample_count = pass.at("count").get<u32>();
  request.surfaces = pass.at("surfaces").get<bool>();
  request.costs = pass.at("costs").get<bool>();
  const auto pixels = pass.at("pixels").get<std::size_t>(), sums = pass.at("sums").get<std::size_t>();
  const auto rays = pass.at("rays").get<std::size_t>();
  if (data.size() != (pixels + rays) * sizeof(u32) + sums * (sizeof(float4) + sizeof(float)))
    throw DeviceError("a tile was asked for with too many or too few bytes");
  std::size_t at = 0;
  request.pixels = take<u32>(data, at, pixels);
  request.sums = take<float4>(data, at, sums);
  request.weights = take<float>(data, at, sums);
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

TileResult unpack_tile(const nlohmann::json& values, const std::string& data) {
  TileResult result;
  result.tile = values.at("tile").get<Tile>();
  result.counts = values.at("counts").get<RayCounts>();
  const std::size_t pixels = pixel_count(result.tile), aovs = values.at("aovs").get<std::size_t>(),
                    rays = values.at("rays").get<std::size_t>();
  if (aovs > all_aov_vectors * pixels || rays > pixels ||
      data.size() != pixels * (sizeof(float4) + sizeof(float)) + aovs * sizeof(float4) + rays * sizeof(u32))
    throw DeviceError("a tile came with too many or too few bytes");
  std::size_t at = 0;
  result.sums = take<float4>(data, at, pixels);
  result.weights = take<float>(data, at, pixels);
  result.aovs = take<float4>(data, at, aovs);
  result.rays = take<u32>(data, at, rays);
  return result;
}

}  // namespace sundog
