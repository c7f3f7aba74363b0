// Reads STL, ASCII and binary. Ignores facet normals, because the order of corners gives the same normals and
// is always present.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "models/far_mesh.h"
#include "models/normals.h"
#include "models/readers.h"
#include "models/text.h"

namespace sundog::models {
namespace {

constexpr std::size_t header_bytes = 84, facet_bytes = 50;

std::uint32_t little_word(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) word = word << 8 | static_cast<unsigned char>(bytes[at + i]);
  return word;
}

std::size_t binary_facets(const Source& source) {
  return source.bytes.size() < header_bytes ? 0 : little_word(source.bytes, 80);
}

TextReader text_of(const Source& source) {
  return {source,
          {.hash_comments = false, .continuations = false},
          source.bytes.starts_with(byte_order_mark) ? byte_order_mark.size() : 0};
}

// Binary files may begin with "solid" too, so the size decides.
bool is_binary(const Source& source) {
  const std::size_t size = source.bytes.size();
  if (size >= header_bytes && size == header_bytes + facet_bytes * binary_facets(source)) return true;
  TextReader text = text_of(source);
  return !text.next_line() || !text.keyword().starts_with("solid");
}

void add_triangle(Mesh& mesh) {
  const auto n = static_cast<std::uint32_t>(3 * mesh.triangles.size());
  mesh.triangles.emplace_back(n, n + 1, n + 2);
}

/// Facets may have a colour in their last two bytes, marked by bit 15 or by a colour of the whole in the
/// header.
bool is_colored(const Source& source, std::size_t facets) {
  if (source.bytes.substr(0, 80).find("COLOR=") != std::string::npos) return true;
  for (std::size_t i = 1; i <= facets; ++i)
    if (static_cast<unsigned char>(source.bytes[header_bytes + facet_bytes * i - 1]) & 0x80u) return true;
  return false;
}

void read_binary(const Source& source, Mesh& mesh, Model& model) {
  const std::size_t size = source.bytes.size(), facets = binary_facets(source);
  if (size < header_bytes)
    fail_at_byte(source, size, "neither 'solid' nor a binary STL's header of 84 bytes");
  const std::size_t room = (size - header_bytes) / facet_bytes;
  if (facets > room)
    fail_at_byte(source, 80, fmt::format("{} facets promised, but the file has room for {}", facets, room));
  if (facets < room)
    model.warnings.push_back(
        fmt::format("{} facets promised, but the file has room for {}: the rest is not read", facets, room));
  if (is_colored(source, facets)) leave_unread(model, "colours of facets");
  mesh.positions.reserve(facets * 3);
  mesh.triangles.reserve(facets);
  for (std::size_t i = 0; i < facets; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      glm::vec3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t at = header_bytes + facet_bytes * i + 12 * (k + 1) + 4 * axis;
        p[static_cast<int>(axis)] = std::bit_cast<float>(little_word(source.bytes, at));
        if (!std::isfinite(p[static_cast<int>(axis)])) fail_at_byte(source, at, "a coordinate is not finite");
      }
      mesh.positions.push_back(p);
    }
    add_triangle(mesh);
  }
}

dvec3 read_corner(TextReader& text) {
  const double x = text.bounded("x"), y = text.bounded("y"), z = text.bounded("z");
  text.expect_line_end("a vertex");
  return {x, y, z};
}

/// Returns the origin of the mesh's positions.
dvec3 read_ascii(const Source& source, Mesh& mesh) {
  TextReader text = text_of(source);
  std::vector<dvec3> positions;
  std::size_t corners = 0;
  bool in_loop = false, ended = false;
  while (text.next_line()) {
    const std::string word = text.keyword();
    ended = word == "endsolid" || (ended && word != "solid");
    if (word == "outer") {
      in_loop = true;
      corners = 0;
    } else if (word == "vertex") {
      if (!in_loop || ++corners > 3) text.fail("a vertex outside a facet's loop of three");
      positions.push_back(read_corner(text));
    } else if (word == "endloop") {
      if (!in_loop || corners != 3) text.fail(fmt::format("a facet needs three vertices, found {}", corners));
      in_loop = false;
      add_triangle(mesh);
    } else if (word != "solid" && word != "facet" && word != "endfacet" && word != "endsolid") {
      text.fail("solid, facet, outer loop, vertex, endloop, endfacet or endsolid wanted");
    }
  }
  if (!ended) text.fail("the file ends without 'endsolid'");
  const dvec3 origin = near_origin(positions);
  for (const dvec3& p : positions) mesh.positions.emplace_back(p - origin);
  return origin;
}

}  // namespace

// All readers have this signature: NOLINTNEXTLINE(performance-unnecessary-value-param)
Model load_stl(Source source, const ModelOptions& options) {
  Model model;
  Mesh mesh;
  mesh.name = source.path.stem().string();
  dvec3 origin(0);
  if (is_binary(source))
    read_binary(source, mesh, model);
  else
    origin = read_ascii(source, mesh);
  mesh.source_vertex_count = mesh.positions.size();
  const double crease = options.crease_angle.value_or(0);
  complete_normals(mesh, {}, crease, crease > 0 ? weld_positions(mesh) : std::vector<std::uint32_t>());
  add_mesh(model, std::move(mesh), origin);
  return model;
}

}  // namespace sundog::models
