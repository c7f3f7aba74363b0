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

PackedTile pack_tile(const TileResult& result) {
  const std::size_t pixels = pixel_count(result.tile);
  PackedTile packed;
  packed.values = {{"tile", result.tile}, {"counts", result.counts}, {"aovs", !result.aovs.empty()}};
  append(packed.data, result.sums, pixels);
  append(packed.data, result.weights, pixels);
  if (!result.aovs.empty()) append(packed.data, result.aovs, 3 * pixels);
  return packed;
}

TileResult unpack_tile(const nlohmann::json& values, const std::string& data) {
  TileResult result;
  result.tile = values.at("tile").get<Tile>();
  result.counts = values.at("counts").get<RayCounts>();
  const std::size_t pixels = pixel_count(result.tile), aovs = values.at("aovs").get<bool>() ? 3 * pixels : 0;
  if (data.size() != pixels * (sizeof(float4) + sizeof(float)) + aovs * sizeof(float4))
    throw DeviceError("a tile came with too many or too few bytes");
  std::size_t at = 0;
  result.sums = take<float4>(data, at, pixels);
  result.weights = take<float>(data, at, pixels);
  result.aovs = take<float4>(data, at, aovs);
  return result;
}

}  // namespace sundog
