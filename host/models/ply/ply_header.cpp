// Reads PLY's header (G. Turk, "The PLY polygon file format", 1994).
#include "models/ply/ply_header.h"

#include <array>

#include "models/text.h"

namespace sundog::models {
namespace {

struct TypeName {
  std::string_view name;
  PlyType type;
};
constexpr std::array<TypeName, 16> type_names{{{"char", PlyType::int8},
                                               {"int8", PlyType::int8},
                                               {"uchar", PlyType::uint8},
                                               {"uint8", PlyType::uint8},
                                               {"short", PlyType::int16},
                                               {"int16", PlyType::int16},
                                               {"ushort", PlyType::uint16},
                                               {"uint16", PlyType::uint16},
                                               {"int", PlyType::int32},
                                               {"int32", PlyType::int32},
                                               {"uint", PlyType::uint32},
                                               {"uint32", PlyType::uint32},
                                               {"float", PlyType::float32},
                                               {"float32", PlyType::float32},
                                               {"double", PlyType::float64},
                                               {"float64", PlyType::float64}}};

PlyType read_type(TextReader& text) {
  const std::string word = text.keyword();
  for (const TypeName& known : type_names)
    if (word == known.name) return known.type;
  text.fail("a property's type wanted (char uchar short ushort int uint float double)");
}

PlyFormat read_format(TextReader& text) {
  const std::string word = text.keyword();
  if (word == "ascii") return PlyFormat::ascii;
  if (word == "binary_little_endian") return PlyFormat::little_endian;
  if (word == "binary_big_endian") return PlyFormat::big_endian;
  text.fail("the format must be ascii, binary_little_endian or binary_big_endian");
}

PlyProperty read_property(TextReader& text) {
  PlyProperty property;
  TextReader peek = text;
  if (peek.keyword() == "list") {
    text.word();
    property.count_type = read_type(text);
    if (is_real(*property.count_type)) text.fail("a list's length must be of a whole-number type");
  }
  property.type = read_type(text);
  property.name = text.keyword();
  if (property.name.empty()) text.fail("the property has no name");
  return property;
}

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

PlyHeader read_ply_header(const Source& source) {
  TextReader text(source, {.hash_comments = false, .continuations = false});
  if (!text.next_line() || text.keyword() != "ply" || text.line() != 1)
    fail(source, "line 1", "not a PLY file: it must begin with 'ply'");
  PlyHeader header;
  bool has_format = false;
  while (text.next_line()) {
    const std::string word = text.keyword();
    if (word == "end_header") {
      if (!has_format) text.fail("the header names no format");
      header.data_byte = source.bytes.size() - text.bytes_left();
      header.data_line = text.line() + 1;
      return header;
    }
    if (word == "format") {
      header.format = read_format(text);
      has_format = true;
    } else if (word == "element") {
      PlyElement element;
      element.name = text.keyword();
      element.count = text.count("the element's count");
      header.elements.push_back(std::move(element));
    } else if (word == "property") {
      if (header.elements.empty()) text.fail("a property before any element");
      header.elements.back().properties.push_back(read_property(text));
    } else if (word == "comment") {
      if (text.keyword() != "texturefile") continue;
      MtlMap map;
      map.file = text.rest();
      if (map.file.starts_with("<this>")) map.file.replace(0, 6, source.path.stem().string());  // MeshLab's
      map.line = text.line();
      if (!map.file.empty()) header.textures.push_back(map);
    } else if (word != "obj_info") {
      text.fail("the header wants format, element, property, comment or end_header here");
    }
  }
  text.fail("the header has no end_header");
}

}  // namespace sundog::models
