// PLY's header: the elements and their properties.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "models/obj/mtl_maps.h"
#include "models/source.h"

namespace sundog::models {

enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count_type;  // set for a list: the type of its length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::vector<MtlMap> textures;              // of "comment TextureFile NAME" lines, as MeshLab writes
  std::size_t data_byte = 0, data_line = 1;  // where the data begins
};

std::size_t size_of(PlyType type);
inline bool is_real(PlyType type) { return type == PlyType::float32 || type == PlyType::float64; }

PlyHeader read_ply_header(const Source& source);

}  // namespace sundog::models
