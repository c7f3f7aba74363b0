// Serialises the values sent through a channel: JSON, with pixels as bytes.
#pragma once
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "render/frame/device_worker.h"

namespace sundog {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeviceInfo, platform, device, platform_name, platform_version, name,
                                   vendor, driver, version, c_version, extensions, type, compute_units,
                                   clock_mhz, native_vector_width, preferred_vector_width, global_memory,
                                   max_allocation, local_memory, cache, max_work_group, timer_resolution_ns,
                                   max_sub_devices, little_endian, compiler_available, available,
                                   host_unified_memory, device_class, problem, estimate, sub_units,
                                   first_unit, identity, rank, host)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Tile, x, y, width, height)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WorkGroup, kind, x, y)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RenderTimes, build_kernels, upload, render, readback, cached)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(KernelTimes, launches, device_ms, host_ms, first_ms, local_x, local_y)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WorkerFigures, kernels, readback_seconds, notes)

/// Calls `read`; throws DeviceError "FROM: ..." if the message lacks a value.
template <class Read>
auto understood(const std::string& from, const Read& read) {
  try {
    return read();
  } catch (const nlohmann::json::exception&) {
    throw DeviceError(from + ": its process sent a message that makes no sense");
  }
}

/// A request or result of a tile as JSON values, and its pixels as bytes.
struct PackedTile {
  nlohmann::json values;
  std::string data;
};
PackedTile pack_request(const TileRequest& request);
/// Throws DeviceError for an invalid tile or if the bytes do not match the request.
TileRequest unpack_request(const nlohmann::json& values, const std::string& data);
PackedTile pack_tile(const TileResult& result);
/// Throws DeviceError unless this is the requested tile with the values that these AOVs need, and the bytes
/// match the tile.
TileResult unpack_tile(const nlohmann::json& values, const std::string& data, const TileRequest& request,
                       const std::vector<std::string>& aov_names);

}  // namespace sundog
