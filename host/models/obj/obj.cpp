// Reads Wavefront OBJ: polygons with texture coordinates, normals, vertex colours and MTL materials, as one
// mesh. Ignores lines, points, curves and surfaces, and names of objects and groups.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "base/numbers.h"
#include "models/colors.h"
#include "models/far_mesh.h"
#include "models/normals.h"
#include "models/obj/mtl.h"
#include "models/polygon.h"
#include "models/readers.h"
#include "models/text.h"

namespace sundog::models {
namespace {

constexpr std::uint32_t none = 0xFFFFFFFFu;

struct Corner {
  std::uint32_t position = none, uv = none, normal = none;
  bool operator==(const Corner&) const = default;
};

/// Statements that affect the picture but are not read.
constexpr std::pair<std::string_view, const char*> unread_statements[] = {{"l", "lines"},
                                                                          {"p", "points"},
                                                                          {"curv", "curves"},
                                                                          {"curv2", "curves"},
                                                                          {"surf", "free-form surfaces"},
                                                                          {"usemap", "colour textures"}};

constexpr std::string_view axis_names[] = {"x", "y", "z"};

class ObjReader {
 public:
  ObjReader(const Source& source, Model& model)
      : text_(source, {.hash_comments = true, .continuations = true}),
        source_(source),
        model_(model),
        library_(model) {}

  void read() {
    while (text_.next_line()) read_statement(text_.keyword());
    if (positions_.empty()) text_.fail("no vertices: not an OBJ file");
    warn_of_no_numbers("normals", "made up", normals_of_no_number_);
    warn_of_no_numbers("texture coordinates", "taken as 0", uvs_of_no_number_);
    settle_lost("normals", "made up", lost_normals_, normals_.empty());
    settle_lost("texture coordinates", "left out", lost_uvs_, uvs_.empty());
  }

  // The mesh, with positions relative to origin().
  Mesh take_mesh(std::optional<double> crease_degrees) {
    origin_ = near_origin(positions_);
    if (origin_ != dvec3(0))
      for (std::size_t i = 0; i < made_.size(); ++i)
        mesh_.positions[i] = glm::vec3(positions_[made_[i].position] - origin_);
    mesh_.name = source_.path.stem().string();
    mesh_.source_vertex_count = positions_.size();
    if (!any_uv_) mesh_.uvs.clear();
    if (!any_color_) mesh_.colors.clear();
    share_byte_colors(mesh_.colors.values());
    settle_materials();
    const bool by_groups = any_group_ && !crease_degrees;
    const bool flat = by_groups && std::ranges::count(groups_, 0u) == std::ssize(groups_);
    complete_normals(mesh_, std::move(has_normal_), crease_degrees.value_or(flat ? 0 : 45), points_,
                     by_groups ? groups_ : std::vector<std::uint32_t>());
    return std::move(mesh_);
  }

  const dvec3& origin() const { return origin_; }

 private:
  void read_statement(std::string_view key) {
    if (key == "v") {
      read_position();
    } else if (key == "vn") {
      const double x = text_.bounded_or_nan("x"), y = text_.bounded_or_nan("y"),
                   z = text_.bounded_or_nan("z");
      normals_.emplace_back(x, y, z);
    } else if (key == "vt") {
      const double u = text_.bounded_or_nan("u");
      uvs_.emplace_back(u, text_.at_line_end() ? 0 : text_.bounded_or_nan("v"));
    } else if (key == "f" || key == "fo") {
      read_face();
    } else if (key == "usemtl") {
      material_ = library_.find(source_, text_.rest());
    } else if (key == "s") {
      read_group();
    } else if (key == "mtllib") {
      library_.load(source_, text_, text_.rest());
    } else {
      for (const auto& [word, feature] : unread_statements)
        if (key == word) leave_unread(model_, feature);
    }
  }

  // Edges within a smoothing group are smooth; those of group 0 ("off") and between groups are sharp.
  void read_group() {
    any_group_ = true;
    const std::string group = text_.keyword();
    group_ = group == "off" ? 0 : 1;
    std::from_chars(group.data(), group.data() + group.size(), group_);
  }

  // "v x y z", "v x y z w", or "v x y z r g b". NaN is an error if a face uses it.
  void read_position() {
    dvec3 position;
    for (int axis = 0; axis < 3; ++axis) position[axis] = text_.bounded_or_nan(axis_names[axis]);
    if (!is_finite(position)) {
      lines_of_no_number_.emplace(positions_.size(), text_.line());
      position = positions_.empty() ? dvec3(0) : positions_.back();
    }
    positions_.push_back(position);
    glm::vec3 color{1};
    if (!text_.at_line_end()) {
      color.x = text_.real("w or red");
      if (text_.at_line_end()) {
        color = glm::vec3(1);
      } else {
        color.y = text_.real("green");
        color.z = text_.real("blue");
        any_color_ = true;
      }
    }
    colors_.push_back(glm::max(color, glm::vec3(0)));
    newest_.push_back(none);
  }

  // Counts references to values that the file does not define, or that are not numbers, and keeps the first.
  struct Lost {
    std::size_t count = 0;
    std::string place, what;  // of the first
  };

  void warn_of_no_numbers(const char* what, const char* mend, const Lost& lost) {
    if (lost.count > 0)
      model_.warnings.push_back(
          fmt::format("{}: {} that are no numbers are {} ({} in all)", lost.place, what, mend, lost.count));
  }

  // Some programs reference normals or texture coordinates that they do not write.
  void settle_lost(const char* what, const char* mend, const Lost& lost, bool has_none) {
    if (lost.count == 0) return;
    if (!has_none) fail(source_, lost.place, lost.what);
    model_.warnings.push_back(
        fmt::format("{}: faces name {}, but the file has none: they are {}", lost.place, what, mend));
  }

  // Resolves an index: 1 is the first, -1 the latest.
  std::uint32_t resolve(std::string_view digits, std::size_t count, std::string_view what,
                        Lost* lost = nullptr) {
    const auto found = whole_number<std::int64_t>(digits);
    if (!found) text_.fail(fmt::format("a face's {} index wanted, as in 1/2/3", what));
    const std::int64_t index = *found, size = static_cast<std::int64_t>(count);
    if (index == 0 || index > size || index < -size) {
      const std::string why = fmt::format("{} {} does not exist: {} are defined so far", what, index, count);
      if (!lost || count > 0 || index == 0) text_.fail(why);
      if (lost->count++ == 0) *lost = {1, fmt::format("line {}", text_.line()), why};
      return none;
    }
    return static_cast<std::uint32_t>(index > 0 ? index - 1 : size + index);
  }

  Corner read_corner(std::string_view word) {
    const std::size_t first = word.find('/');
    const std::size_t second = first == word.npos ? first : word.find('/', first + 1);
    Corner corner;
    corner.position = resolve(word.substr(0, first), positions_.size(), "vertex");
    if (const auto bad = lines_of_no_number_.find(corner.position); bad != lines_of_no_number_.end())
      text_.fail(fmt::format("vertex {}, of line {}, is no number", corner.position + 1, bad->second));
    if (first != word.npos) {
      const std::string_view uv = word.substr(first + 1, second == word.npos ? second : second - first - 1);
      if (!uv.empty()) corner.uv = resolve(uv, uvs_.size(), "texture coordinate", &lost_uvs_);
    }
    if (second != word.npos) {
      const std::string_view normal = word.substr(second + 1);
      if (!normal.empty()) corner.normal = resolve(normal, normals_.size(), "normal", &lost_normals_);
    }
    return corner;
  }

  void read_face() {
    corners_.clear();
    outline_.clear();
    places_.clear();
    pieces_.clear();
    while (!text_.at_line_end()) {
      corners_.push_back(read_corner(text_.word()));
      outline_.push_back(positions_[corners_.back().position]);
    }
    if (corners_.empty()) text_.fail("a face without corners");
    if (corners_.size() < 3) {
      ++model_.dropped_polygons;
      return;
    }
    constexpr double few_bits = 4096;  // beyond this many sizes, floats hold too little of a polygon's shape
    const dvec3 origin = corners_.size() > 3 ? near_origin(outline_, few_bits) : dvec3(0);
    for (const dvec3& p : outline_) places_.emplace_back(p - origin);
    if (!triangulate(places_, pieces_))
      text_.fail(fmt::format("a concave polygon of {} corners; at most {} are triangulated", corners_.size(),
                             most_concave_corners));
    vertices_.clear();
    for (const Corner& corner : corners_) vertices_.push_back(vertex(corner));
    for (const glm::uvec3 t : pieces_)
      mesh_.triangles.emplace_back(vertices_[t.x], vertices_[t.y], vertices_[t.z]);
    mesh_.materials.resize(mesh_.triangles.size(), material_);
    groups_.resize(mesh_.triangles.size(), group_);
  }

  template <class Vector>
  Vector number_or_zero(const Vector& value, Lost& lost) {
    if (is_finite(value)) return value;
    if (lost.count++ == 0) lost.place = fmt::format("line {}", text_.line());
    return Vector(0);
  }

  // The mesh's vertex for a corner: an existing one with equal indices, else a new one. The search is bounded
  // to avoid quadratic time; duplicates are harmless.
  std::uint32_t vertex(const Corner& corner) {
    constexpr int most_steps = 32;
    std::uint32_t at = newest_[corner.position];
    for (int step = 0; at != none && step < most_steps; ++step, at = older_[at])
      if (made_[at] == corner) return at;
    const auto created = static_cast<std::uint32_t>(mesh_.positions.size());
    const std::uint32_t sibling = newest_[corner.position];
    points_.push_back(sibling == none ? created : points_[sibling]);
    older_.push_back(sibling);
    newest_[corner.position] = created;
    made_.push_back(corner);
    mesh_.positions.emplace_back(positions_[corner.position]);
    mesh_.colors.push_back(colors_[corner.position]);
    mesh_.uvs.push_back(corner.uv == none ? glm::vec2(0)
                                          : number_or_zero(uvs_[corner.uv], uvs_of_no_number_));
    mesh_.normals.push_back(corner.normal == none
                                ? glm::vec3(0)
                                : number_or_zero(normals_[corner.normal], normals_of_no_number_));
    has_normal_.push_back(corner.normal != none);
    any_uv_ = any_uv_ || corner.uv != none;
    return created;
  }

  // Triangles without a material get an added default one, unless no triangle has any; vertex colours require
  // materials that use them.
  void settle_materials() {
    const bool some =
        std::any_of(mesh_.materials.begin(), mesh_.materials.end(), [](int m) { return m >= 0; });
    if (!some && !any_color_) {
      mesh_.materials.clear();
      return;
    }
    const auto added = static_cast<int>(model_.materials.size());
    bool wanted = false;
    for (int& m : mesh_.materials) {
      wanted = wanted || m < 0;
      m = m < 0 ? added : m;
    }
    if (wanted) model_.materials.emplace_back().name = "default";
    if (any_color_)
      for (MaterialDescription& material : model_.materials) material.vertex_color = true;
  }

  TextReader text_;
  const Source& source_;
  Model& model_;
  MaterialLibrary library_;
  int material_ = -1;
  std::vector<dvec3> positions_;  // in the file's order
  std::vector<glm::vec3> normals_, colors_;
  std::vector<glm::vec2> uvs_;
  Mesh mesh_;
  dvec3 origin_{0};
  std::vector<Corner> made_;                   // per mesh vertex: its indices in the file
  std::vector<std::uint32_t> newest_, older_;  // lists: heads by file vertex, links by mesh vertex
  std::vector<std::uint32_t> points_;          // per mesh vertex: the first one of the same file vertex
  std::vector<bool> has_normal_;
  bool any_uv_ = false, any_color_ = false;
  Lost lost_normals_, lost_uvs_, normals_of_no_number_, uvs_of_no_number_;
  std::map<std::size_t, std::size_t> lines_of_no_number_;  // by position: the line that defines it
  std::vector<std::uint32_t> groups_;                      // per triangle
  std::uint32_t group_ = 0;
  bool any_group_ = false;
  std::vector<Corner> corners_;  // of the current face
  std::vector<dvec3> outline_;
  std::vector<glm::vec3> places_;
  std::vector<glm::uvec3> pieces_;
  std::vector<std::uint32_t> vertices_;
};

}  // namespace

// All readers have this signature: NOLINTNEXTLINE(performance-unnecessary-value-param)
Model load_obj(Source source, const ModelOptions& options) {
  Model model;
  model.for_paths = options.for_paths.value_or(true);
  ObjReader reader(source, model);
  reader.read();
  Mesh mesh = reader.take_mesh(options.crease_angle);
  add_mesh(model, std::move(mesh), reader.origin());
  return model;
}

}  // namespace sundog::models
