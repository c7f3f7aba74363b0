// Reads PLY, ASCII and binary in both byte orders: vertices with normals, texture coordinates and colours;
// faces, with optional colours and texture coordinates, or triangle strips.
#include <fmt/format.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "models/colors.h"
#include "models/normals.h"
#include "models/ply/ply_vertices.h"
#include "models/polygon.h"
#include "models/readers.h"

namespace sundog::models {
using namespace ply;
namespace {

bool is_face(const PlyElement& element) { return element.name == "face" || element.name == "tristrips"; }

bool faces_come_first(const PlyHeader& header) {
  for (const PlyElement& element : header.elements)
    if (is_face(element) || element.name == "vertex") return is_face(element);
  return false;
}

template <class Cursor>
class DataReader {
 public:
  /// With `known` vertices from read_vertices(), faces may come before the vertices.
  DataReader(const Source& source, const PlyHeader& header, Content known = {})
      : header_(header), cursor_(source, header), content_(std::move(known)) {}

  Content read_vertices() {
    for (const PlyElement& element : header_.elements) {
      check_count(element);
      if (element.name == "vertex")
        read_vertices(element);
      else
        skip(element);
    }
    return std::move(content_);
  }

  Content read() {
    const bool known = !content_.mesh.positions.empty();
    for (const PlyElement& element : header_.elements) {
      check_count(element);
      if (element.name == "vertex" && !known) {
        read_vertices(element);
      } else if (is_face(element)) {
        read_faces(element);
      } else {
        skip(element);
      }
    }
    // Some elements of faces may have neither colours nor texture coordinates.
    const std::size_t triangles = content_.mesh.triangles.size();
    if (!content_.face_colors.empty()) content_.face_colors.resize(triangles, glm::vec3(1));
    if (!content_.corner_uvs.empty()) content_.corner_uvs.resize(3 * triangles);
    return std::move(content_);
  }

 private:
  std::size_t vertex_count() const {
    for (const PlyElement& element : header_.elements)
      if (element.name == "vertex") return element.count;
    return 0;
  }

  // Checks before allocating: the remaining bytes must be able to hold that many.
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

  void skip(const PlyElement& element) {
    if (element.properties.empty()) return;
    const Layout layout(element);
    Values values{};
    for (std::uint64_t i = 0; i < element.count; ++i)
      read_element(cursor_, element, layout, values, [](std::size_t, double) {});
  }

  void read_vertices(const PlyElement& element) { VertexReader<Cursor>(element, content_).read(cursor_); }

  void read_faces(const PlyElement& element) {
    const Layout layout(element);
    const bool strips = element.name == "tristrips";
    const std::size_t count = vertex_count();
    if (content_.mesh.positions.empty() && element.count > 0) cursor_.fail("faces before any vertex");
    const std::size_t none = element.properties.size();
    std::size_t list = none, uvs = none;
    for (std::size_t p = 0; p < none; ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.name == "vertex_indices" || property.name == "vertex_index") list = p;
      if (property.name == "texcoord" && property.count_type && !strips && content_.mesh.uvs.empty()) uvs = p;
    }
    if (list == none || !element.properties[list].count_type)
      cursor_.fail(fmt::format("'{}' needs a list vertex_indices", element.name));
    const bool plain = !strips && !layout.colors() && !layout.has[image] && uvs == none;
    if (plain && content_.mesh.triangles.empty() && read_triangles(element, list)) return;
    content_.mesh.triangles.reserve(element.count);
    if (uvs != none) content_.corner_uvs.resize(3 * content_.mesh.triangles.size());
    Values values{};
    for (std::uint64_t i = 0; i < element.count; ++i) {
      corners_.clear();
      uvs_.clear();
      read_element(cursor_, element, layout, values, [&](std::size_t p, double value) {
        if (p == uvs) uvs_.push_back(std::isfinite(value) ? static_cast<float>(value) : 0.0f);
        if (p != list) return;
        const bool restart = strips && value == -1;
        if (!restart && !(value >= 0 && value < static_cast<double>(count) && value == std::trunc(value)))
          cursor_.fail(
              fmt::format("{} {}: vertex {}, but there are {} vertices", element.name, i, value, count));
        corners_.push_back(restart ? strip_end : static_cast<std::uint32_t>(value));
        if (content_.lost.contains(corners_.back()))
          cursor_.fail(
              fmt::format("{} {}: vertex {} has a coordinate that is no number", element.name, i, value));
      });
      uvs_.resize(2 * corners_.size());
      strips ? add_strips() : add_polygon(uvs != none);
      const std::size_t triangles = content_.mesh.triangles.size();
      if (layout.colors()) content_.face_colors.resize(triangles, color_of(values));
      const bool known = values[image] >= 0 && values[image] < static_cast<double>(header_.textures.size());
      if (layout.has[image])
        content_.images.resize(triangles, known ? static_cast<std::uint32_t>(values[image]) : 0);
    }
  }

  // Reads faces in parallel if all are triangles. Returns false, with nothing read, if one is not a triangle
  // or has a corner that read_faces() would refuse.
  bool read_triangles(const PlyElement& element, std::size_t list) {
    const std::size_t bytes = Cursor::bytes_of_triangles(element);
    if (bytes == 0 || cursor_.bytes_left() / bytes < element.count) return false;
    if (is_real(element.properties[list].type) || !content_.lost.empty()) return false;
    const auto vertices = static_cast<double>(vertex_count());
    std::vector<glm::uvec3> triangles(element.count);
    std::atomic<bool> plain = true;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, triangles.size(), 4096), [&](const auto& range) {
      Cursor cursor = cursor_;
      cursor.skip(range.begin() * bytes);
      for (std::size_t i = range.begin(); i != range.end() && plain; ++i)
        for (const PlyProperty& property : element.properties) {
          if (property.count_type && cursor.value(property, *property.count_type) != 3) plain = false;
          for (int k = 0; k < (property.count_type ? 3 : 1) && plain; ++k) {
            const double value = cursor.value(property, property.type);
            if (&property != &element.properties[list]) continue;
            if (!(value >= 0 && value < vertices)) plain = false;
            if (plain) triangles[i][k] = static_cast<std::uint32_t>(value);
          }
        }
    });
    if (!plain) return false;
    cursor_.skip(element.count * bytes);
    content_.mesh.triangles = std::move(triangles);
    return true;
  }

  void add_triangle(glm::uvec3 t, bool with_uvs) {
    content_.mesh.triangles.emplace_back(corners_[t.x], corners_[t.y], corners_[t.z]);
    for (int k = 0; k < 3 && with_uvs; ++k) {
      const std::size_t u = std::size_t{2} * t[k];
      content_.corner_uvs.emplace_back(uvs_[u], uvs_[u + 1]);
    }
  }

  void add_polygon(bool with_uvs) {
    if (corners_.size() == 3) return add_triangle({0, 1, 2}, with_uvs);
    if (corners_.size() < 3) {
      ++content_.dropped;
      return;
    }
    places_.clear();
    pieces_.clear();
    for (const std::uint32_t corner : corners_) places_.push_back(content_.mesh.positions[corner]);
    if (!triangulate(places_, pieces_))
      cursor_.fail(fmt::format("a concave polygon of {} corners; at most {} are triangulated",
                               corners_.size(), most_concave_corners));
    for (const glm::uvec3 t : pieces_) add_triangle(t, with_uvs);
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
  std::vector<float> uvs_;  // of the corners
  std::vector<glm::vec3> places_;
  std::vector<glm::uvec3> pieces_;
};

// Gives vertices the colours and texture coordinates of faces' corners: splits those whose corners differ.
// Returns each vertex's original, so that normals are still smoothed across the split.
std::vector<std::uint32_t> split_by_corners(const Content& content, Mesh& mesh) {
  const bool colored = mesh.colors.empty() && !content.face_colors.empty(),
             mapped = !content.corner_uvs.empty();
  if (!colored && !mapped) return {};
  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> original(mesh.positions.size());
  for (std::uint32_t i = 0; i < original.size(); ++i) original[i] = i;
  std::vector<bool> given(mesh.positions.size(), false);
  std::vector<std::uint32_t> next(mesh.positions.size(), none);  // copies of a vertex
  if (colored) mesh.colors.assign(mesh.positions.size(), glm::vec3(1));
  if (mapped) mesh.uvs.assign(mesh.positions.size(), glm::vec2(0));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 color = colored ? content.face_colors[t] : glm::vec3(1);
      const glm::vec2 uv = mapped ? content.corner_uvs[3 * t + static_cast<std::size_t>(k)] : glm::vec2(0);
      std::uint32_t v = mesh.triangles[t][k];
      while (given[v] && ((colored && mesh.colors[v] != color) || (mapped && mesh.uvs[v] != uv))) {
        if (next[v] == none) {
          next[v] = static_cast<std::uint32_t>(mesh.positions.size());
          original.push_back(original[v]);
          given.push_back(false);
          next.push_back(none);
          mesh.positions.push_back(glm::vec3(mesh.positions[v]));
          if (!mesh.normals.empty()) mesh.normals.push_back(glm::vec3(mesh.normals[v]));
          if (!mesh.uvs.empty()) mesh.uvs.push_back(glm::vec2(mesh.uvs[v]));
          if (!mesh.colors.empty()) mesh.colors.push_back(glm::vec3(mesh.colors[v]));
        }
        v = next[v];
      }
      given[v] = true;
      if (colored) mesh.colors[v] = color;
      if (mapped) mesh.uvs[v] = uv;
      mesh.triangles[t][k] = v;
    }
  return original;
}

// Adds a material for each of the header's textures, or one that shows vertex colours.
void add_materials(const Source& source, const PlyHeader& header, const Content& content, Mesh& mesh,
                   Model& model) {
  if (mesh.triangles.empty()) return;
  MtlTextures textures(model);
  if (!mesh.uvs.empty())
    for (const MtlMap& map : header.textures) {
      MaterialDescription material;
      material.name = map.file;
      material.textures.diffuse = material.textures.ambient = textures.use(map, true, source, source.path);
      if (material.textures.diffuse >= 0) material.diffuse = dvec3(1);
      model.materials.push_back(material);
    }
  if (model.materials.empty() && mesh.colors.empty()) return;
  if (model.materials.empty()) {
    MaterialDescription material;
    material.name = "vertex colors";
    material.vertex_color = true;
    model.materials.push_back(material);
  }
  mesh.materials.assign(mesh.triangles.size(), 0);
  for (std::size_t t = 0; t < content.images.size() && model.materials.size() > 1; ++t)
    mesh.materials[t] = static_cast<int>(content.images[t]);
}

template <class Cursor>
Content read_by(const Source& source, const PlyHeader& header) {
  Content vertices;
  if (faces_come_first(header)) vertices = DataReader<Cursor>(source, header).read_vertices();
  return DataReader<Cursor>(source, header, std::move(vertices)).read();
}

Content read_content(const Source& source, const PlyHeader& header) {
  switch (header.format) {
    case PlyFormat::ascii:
      return read_by<AsciiPlyCursor>(source, header);
    case PlyFormat::little_endian:
      return read_by<BinaryPlyCursor<std::endian::little>>(source, header);
    case PlyFormat::big_endian:
      return read_by<BinaryPlyCursor<std::endian::big>>(source, header);
  }
  return {};
}

void warn_of_no_numbers(std::size_t count, const char* what, const char* mend, Model& model) {
  if (count > 0) model.warnings.push_back(fmt::format("{} {} that are no numbers are {}", count, what, mend));
}

}  // namespace

// All readers have this signature: NOLINTNEXTLINE(performance-unnecessary-value-param)
Model load_ply(Source source, const ModelOptions& options) {
  const PlyHeader header = read_ply_header(source);
  Content content = read_content(source, header);
  Mesh& mesh = content.mesh;
  if (mesh.positions.empty()) fail(source, "", "the file has no vertices");
  mesh.name = source.path.stem().string();
  share_byte_colors(mesh.colors.values());
  share_byte_colors(content.face_colors);
  const std::vector<std::uint32_t> points = split_by_corners(content, mesh);
  complete_normals(mesh, {}, options.crease_angle.value_or(45), points);
  Model model;
  model.dropped_polygons = content.dropped;
  warn_of_no_numbers(content.normals_of_no_number, "normals", "made up", model);
  warn_of_no_numbers(content.uvs_of_no_number, "texture coordinates", "taken as 0", model);
  for (const std::string& feature : content.unread) leave_unread(model, feature);
  add_materials(source, header, content, mesh, model);
  add_mesh(model, std::move(mesh), content.origin);
  return model;
}

}  // namespace sundog::models
