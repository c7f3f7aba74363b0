// PLY, ASCII and binary in both byte orders: vertices with normals, texture coordinates and colours; faces,
// with colours of their own, or triangle strips.
#include <fmt/format.h>

#include <array>
#include <limits>

#include "scene/models/far_mesh.h"
#include "scene/models/normals.h"
#include "scene/models/ply_cursor.h"
#include "scene/models/polygon.h"
#include "scene/models/readers.h"

namespace sundog::models {
namespace {

enum Slot { px, py, pz, nx, ny, nz, tu, tv, red, green, blue, slot_count, no_slot = slot_count };

Slot slot_of(std::string_view name) {
  struct Known {
    std::string_view name;
    Slot slot;
  };
  static constexpr std::array<Known, 21> known{{{"x", px},
                                                {"y", py},
                                                {"z", pz},
                                                {"nx", nx},
                                                {"ny", ny},
                                                {"nz", nz},
                                                {"u", tu},
                                                {"v", tv},
                                                {"s", tu},
                                                {"t", tv},
                                                {"texture_u", tu},
                                                {"texture_v", tv},
                                                {"red", red},
                                                {"green", green},
                                                {"blue", blue},
                                                {"r", red},
                                                {"g", green},
                                                {"b", blue},
                                                {"diffuse_red", red},
                                                {"diffuse_green", green},
                                                {"diffuse_blue", blue}}};
  for (const Known& k : known)
    if (k.name == name) return k.slot;
  return no_slot;
}

// Where an element's properties go, and which slots it fills.
struct Layout {
  std::vector<Slot> slots;
  std::array<bool, slot_count + 1> has{};

  explicit Layout(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) {
      const Slot slot = property.count_type ? no_slot : slot_of(property.name);
      slots.push_back(slot);
      has[slot] = true;
    }
  }
  bool normals() const { return has[nx] && has[ny] && has[nz]; }
  bool uvs() const { return has[tu] && has[tv]; }
  bool colors() const { return has[red] && has[green] && has[blue]; }
};

using Values = std::array<double, slot_count + 1>;

double slot_value(Slot slot, PlyType type, double value) {
  if (slot < red || slot > blue || is_real(type)) return value;
  const double most = type == PlyType::uint16 ? 65535.0 : 255.0;
  return static_cast<double>(linear_from_srgb(std::clamp(value / most, 0.0, 1.0)));
}

glm::vec3 color_of(const Values& values) {
  return glm::max(glm::vec3(dvec3(values[red], values[green], values[blue])), glm::vec3(0));
}

// What the file's elements become, while they are read.
struct Content {
  Mesh mesh;
  dvec3 origin{0};                     // of its positions
  std::vector<glm::vec3> face_colors;  // per triangle, when faces have colours and vertices have none
  std::size_t dropped = 0;
};

template <class Cursor>
class DataReader {
 public:
  DataReader(const Source& source, const PlyHeader& header) : header_(header), cursor_(source, header) {}

  Content read() {
    for (const PlyElement& element : header_.elements) {
      check_count(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face" || element.name == "tristrips") {
        read_faces(element);
      } else {
        skip(element);
      }
    }
    return std::move(content_);
  }

 private:
  std::size_t vertex_count() const {
    for (const PlyElement& element : header_.elements)
      if (element.name == "vertex") return element.count;
    return 0;
  }

  // Before anything is allocated: the bytes that are left must be able to hold that many.
  void check_count(const PlyElement& element) const {
    std::size_t least = 0;
    for (const PlyProperty& p : element.properties)
      least += Cursor::least_bytes(p.count_type ? *p.count_type : p.type);
    if (least > 0 && element.count > cursor_.bytes_left() / least)
      cursor_.fail(fmt::format("the header promises {} of '{}', more than the {} bytes left can hold",
                               element.count, element.name, cursor_.bytes_left()));
    if (element.count > std::numeric_limits<std::uint32_t>::max() / 4)
      cursor_.fail(fmt::format("{} of '{}' are too many", element.count, element.name));
  }

  double bounded(double value) const {
    if (std::abs(value) > static_cast<double>(std::numeric_limits<float>::max()))
      cursor_.fail(fmt::format("{} is beyond single precision's range", value));
    return value;
  }
  float narrow(double value) const { return static_cast<float>(bounded(value)); }

  // Reads one element's scalars into `values`; hands each list's items to `item(property number, value)`.
  template <class Item>
  void read_element(const PlyElement& element, const Layout& layout, Values& values, Item item) {
    cursor_.begin_element(element.name);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.count_type) {
        const double length = cursor_.value(property, *property.count_type);
        if (length < 0) cursor_.fail(fmt::format("{}: a list of length {}", property.name, length));
        for (double i = 0; i < length; ++i) item(p, cursor_.value(property, property.type));
      } else {
        values[layout.slots[p]] =
            slot_value(layout.slots[p], property.type, cursor_.value(property, property.type));
      }
    }
    cursor_.end_element(element.name);
  }

  void skip(const PlyElement& element) {
    if (element.properties.empty()) return;
    const Layout layout(element);
    Values values{};
    for (std::uint64_t i = 0; i < element.count; ++i)
      read_element(element, layout, values, [](std::size_t, double) {});
  }

  void read_vertices(const PlyElement& element) {
    const Layout layout(element);
    if (!layout.has[px] || !layout.has[py] || !layout.has[pz])
      cursor_.fail("a vertex needs the properties x, y and z");
    if (!content_.mesh.positions.empty()) cursor_.fail("a second element 'vertex'");
    Mesh& mesh = content_.mesh;
    std::vector<dvec3> positions;
    positions.reserve(element.count);
    mesh.source_vertex_count = element.count;
    Values v{};
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_element(element, layout, v, [](std::size_t, double) {});
      positions.emplace_back(bounded(v[px]), bounded(v[py]), bounded(v[pz]));
      if (layout.normals()) mesh.normals.emplace_back(narrow(v[nx]), narrow(v[ny]), narrow(v[nz]));
      if (layout.uvs()) mesh.uvs.emplace_back(narrow(v[tu]), narrow(v[tv]));
      if (layout.colors()) mesh.colors.push_back(color_of(v));
    }
    content_.origin = near_origin(positions);
    mesh.positions.reserve(positions.size());
    for (const dvec3& p : positions) mesh.positions.emplace_back(p - content_.origin);
  }

  void read_faces(const PlyElement& element) {
    const Layout layout(element);
    const bool strips = element.name == "tristrips";
    const std::size_t count = vertex_count();
    if (content_.mesh.positions.empty() && element.count > 0) cursor_.fail("faces before any vertex");
    std::size_t list = element.properties.size();
    for (std::size_t p = 0; p < element.properties.size(); ++p)
      if (element.properties[p].name == "vertex_indices" || element.properties[p].name == "vertex_index")
        list = p;
    if (list == element.properties.size() || !element.properties[list].count_type)
      cursor_.fail(fmt::format("'{}' needs a list vertex_indices", element.name));
    content_.mesh.triangles.reserve(element.count);
    Values values{};
    for (std::uint64_t i = 0; i < element.count; ++i) {
      corners_.clear();
      read_element(element, layout, values, [&](std::size_t p, double value) {
        if (p != list) return;
        const bool restart = strips && value == -1;
        if (!restart && !(value >= 0 && value < static_cast<double>(count) && value == std::trunc(value)))
          cursor_.fail(
              fmt::format("{} {}: vertex {}, but there are {} vertices", element.name, i, value, count));
        corners_.push_back(restart ? strip_end : static_cast<std::uint32_t>(value));
      });
      strips ? add_strips() : add_polygon();
      if (layout.colors()) content_.face_colors.resize(content_.mesh.triangles.size(), color_of(values));
    }
  }

  void add_polygon() {
    Mesh& mesh = content_.mesh;
    if (corners_.size() == 3) {
      mesh.triangles.emplace_back(corners_[0], corners_[1], corners_[2]);
      return;
    }
    if (corners_.size() < 3) {
      ++content_.dropped;
      return;
    }
    places_.clear();
    pieces_.clear();
    for (const std::uint32_t corner : corners_) places_.push_back(mesh.positions[corner]);
    if (!triangulate(places_, pieces_))
      cursor_.fail(fmt::format("a concave polygon of {} corners; at most {} are triangulated",
                               corners_.size(), most_concave_corners));
    for (const glm::uvec3 t : pieces_)
      mesh.triangles.emplace_back(corners_[t.x], corners_[t.y], corners_[t.z]);
  }

  void add_strips() {
    for (std::size_t begin = 0, i = 0; i < corners_.size(); ++i) {
      if (corners_[i] == strip_end) {
        begin = i + 1;
      } else if (i >= begin + 2) {
        const bool odd = (i - begin) % 2 == 1;
        content_.mesh.triangles.emplace_back(corners_[i - (odd ? 1 : 2)], corners_[i - (odd ? 2 : 1)],
                                             corners_[i]);
      }
    }
  }

  static constexpr std::uint32_t strip_end = std::numeric_limits<std::uint32_t>::max();
  const PlyHeader& header_;
  Cursor cursor_;
  Content content_;
  std::vector<std::uint32_t> corners_;
  std::vector<glm::vec3> places_;
  std::vector<glm::uvec3> pieces_;
};

// Faces' colours become vertices' colours: a vertex is split between faces of different colour.
// Returns each vertex's original, so that normals still smooth across the split.
std::vector<std::uint32_t> paint_faces(Mesh& mesh, const std::vector<glm::vec3>& face_colors) {
  std::vector<std::uint32_t> original(mesh.positions.size());
  for (std::uint32_t i = 0; i < original.size(); ++i) original[i] = i;
  std::vector<bool> painted(mesh.positions.size(), false);
  mesh.colors.assign(mesh.positions.size(), glm::vec3(1));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      if (!painted[v]) {
        painted[v] = true;
        mesh.colors[v] = face_colors[t];
      } else if (mesh.colors[v] != face_colors[t]) {
        mesh.triangles[t][k] = static_cast<std::uint32_t>(mesh.positions.size());
        original.push_back(v);
        mesh.positions.push_back(glm::vec3(mesh.positions[v]));
        if (!mesh.normals.empty()) mesh.normals.push_back(glm::vec3(mesh.normals[v]));
        if (!mesh.uvs.empty()) mesh.uvs.push_back(glm::vec2(mesh.uvs[v]));
        mesh.colors.push_back(face_colors[t]);
      }
    }
  return original;
}

Content read_content(const Source& source, const PlyHeader& header) {
  switch (header.format) {
    case PlyFormat::ascii:
      return DataReader<AsciiPlyCursor>(source, header).read();
    case PlyFormat::little_endian:
      return DataReader<BinaryPlyCursor<std::endian::little>>(source, header).read();
    case PlyFormat::big_endian:
      return DataReader<BinaryPlyCursor<std::endian::big>>(source, header).read();
  }
  return {};
}

}  // namespace

Model load_ply(const Source& source, const ModelOptions& options) {
  const PlyHeader header = read_ply_header(source);
  Content content = read_content(source, header);
  Mesh& mesh = content.mesh;
  if (mesh.positions.empty()) fail(source, "", "the file has no vertices");
  mesh.name = source.path.stem().string();
  std::vector<std::uint32_t> points;
  if (mesh.colors.empty() && !content.face_colors.empty()) points = paint_faces(mesh, content.face_colors);
  complete_normals(mesh, {}, options.crease_angle.value_or(45), std::move(points));
  Model model;
  model.dropped_polygons = content.dropped;
  if (!mesh.colors.empty() && !mesh.triangles.empty()) {
    MaterialDescription material;
    material.name = "vertex colors";
    material.vertex_color = true;
    model.materials.push_back(material);
    mesh.materials.assign(mesh.triangles.size(), 0);
  }
  add_mesh(model, std::move(mesh), content.origin);
  return model;
}

}  // namespace sundog::models
