// Reads NFF, the Standard Procedural Databases' format (E. Haines, "Neutral File Format", version 3.9, 1996).
// Spheres, cones and cylinders stay exact solids (cones and cylinders open, as the format says); the polygons
// and patches of a fill form one mesh. Negative radii, for surfaces visible only from inside, lose their
// sign, because surfaces have two sides here.
#include <fmt/format.h>

#include <cmath>

#include "models/normals.h"
#include "models/polygon.h"
#include "models/readers.h"
#include "models/text.h"

namespace sundog::models {
namespace {

class NffReader {
 public:
  explicit NffReader(const Source& source) : text_(source, {}) {}

  Model read() {
    while (text_.next_line()) read_entity(text_.word());
    finish_fill();
    finish_lights();
    if (model_.objects.empty()) text_.fail("no objects: not an NFF file");
    return std::move(model_);
  }

 private:
  void read_entity(std::string_view key) {
    entity_ = fmt::format("line {}", text_.line());
    if (key == "v") return read_view();
    if (key == "b") return read_background();
    if (key == "l") return read_light();
    if (key == "f") return read_fill();
    if (key == "s") return read_sphere();
    if (key == "c") return read_cone();
    if (key == "p") return read_polygon(false);
    if (key == "pp") return read_polygon(true);
    text_.fail("one of v b l f s c p pp wanted");
  }

  // Values may continue on the next line.
  double number(std::string_view what) {
    if (text_.at_line_end() && !text_.next_line()) text_.fail(fmt::format("the file ends before {}", what));
    return text_.number(what);
  }
  dvec3 vector(std::string_view what) {
    const double x = number(what), y = number(what);
    return {x, y, number(what)};
  }
  glm::vec3 single(std::string_view what) {
    const dvec3 value = vector(what);
    if (!(glm::length(value) < 1e38)) text_.fail(fmt::format("{}: beyond single precision's range", what));
    return glm::vec3(value);
  }

  void read_view() {
    Camera camera;
    ImageSettings image = model_.image.value_or(ImageSettings{});
    for (int i = 0; i < 6; ++i) {
      if (text_.at_line_end() && !text_.next_line()) text_.fail("the file ends within the view");
      const std::string_view key = text_.word();
      if (key == "from") {
        camera.position = vector("from");
      } else if (key == "at") {
        camera.target = vector("at");
      } else if (key == "up") {
        camera.up = vector("up");
      } else if (key == "angle") {
        camera.fov = number("angle");
        if (!(camera.fov > 0 && camera.fov < 180))
          text_.fail(fmt::format("an angle of {}; (0, 180) wanted", camera.fov));
      } else if (key == "hither") {
        camera.near = std::max(number("hither"), 0.0);
      } else if (key == "resolution") {
        image.width = pixels();
        image.height = pixels();
      } else {
        text_.fail("a view wants from, at, up, angle, hither and resolution");
      }
    }
    model_.camera = camera;
    model_.image = image;
  }

  int pixels() {
    const double value = number("resolution");
    if (!(value >= 1 && value <= 1 << 20 && value == std::trunc(value)))
      text_.fail(fmt::format("a resolution of {}", value));
    return static_cast<int>(value);
  }

  void read_background() {
    if (!model_.image) model_.image.emplace();
    model_.image->background_bottom = model_.image->background_top =
        glm::max(vector("the background"), dvec3(0));
  }

  void read_light() {
    LightDescription light;
    light.position = vector("a light's position");
    if (!text_.at_line_end()) light.color = glm::max(vector("a light's colour"), dvec3(0));
    model_.lights.push_back(light);
  }

  // f red green blue Kd Ks Shine T ior. Ks is the coefficient of the highlight and the mirror, as in
  // Whitted's formula.
  void read_fill() {
    finish_fill();
    MaterialDescription fill;
    const dvec3 color = glm::max(vector("a fill's colour"), dvec3(0));
    const double kd = std::max(number("Kd"), 0.0), ks = std::max(number("Ks"), 0.0);
    fill.name = fmt::format("fill {}", model_.materials.size() + 1);
    fill.ambient = fill.diffuse = color * kd;
    fill.specular = dvec3(ks);
    fill.reflection = dvec3(std::min(ks, 1.0));
    fill.exponent = std::max(number("Shine"), 0.0);
    const double transmittance = number("T"), ior = number("the index of refraction");
    if (transmittance > 0) {
      if (!(ior > 0)) text_.fail(fmt::format("an index of refraction of {} for a transmitting fill", ior));
      fill.transmission = dvec3(std::min(transmittance, 1.0));
      fill.medium = static_cast<int>(model_.media.size());
      MediumDescription medium;
      medium.name = fill.name;
      medium.ior = ior;
      model_.media.push_back(medium);
    }
    model_.materials.push_back(fill);
  }

  int fill() {
    if (model_.materials.empty()) model_.materials.emplace_back().name = "default";
    return static_cast<int>(model_.materials.size()) - 1;
  }

  void add(Shape shape, const dmat4& place) {
    Object object;
    object.shape = shape;
    object.material = fill();
    object.world_from_object = place;
    object.place = entity_;
    model_.objects.push_back(std::move(object));
  }

  void read_sphere() {
    const dvec3 center = vector("a sphere's centre");
    const double radius = std::abs(number("a sphere's radius"));
    if (!(radius > 0)) text_.fail("a sphere of radius 0");
    dmat4 place{1};
    place[3] = glm::dvec4(center, 1);
    add(SphereShape{radius}, place);
  }

  void read_cone() {
    const dvec3 base = vector("the base's centre");
    const double base_radius = number("the base's radius");
    const dvec3 apex = vector("the apex's centre");
    const double apex_radius = number("the apex's radius");
    const double length = glm::length(apex - base), bottom = std::abs(base_radius),
                 top = std::abs(apex_radius);
    if (!(length > 0) || !std::isfinite(length)) text_.fail("a cone whose base and apex coincide");
    if (base_radius * apex_radius < 0) text_.fail("a cone's radii of different sign");
    if (!(bottom > 0 || top > 0)) text_.fail("a cone whose radii are both 0");
    const dmat4 place = along(base, apex);
    if (bottom == top) {
      add(CylinderShape{bottom, length / 2, false}, place);
    } else {
      add(ConeShape{bottom, top, length / 2, false}, place);
    }
  }

  // The frame whose y axis points from `base` to `apex`, with its origin halfway.
  static dmat4 along(dvec3 base, dvec3 apex) {
    const dvec3 y = glm::normalize(apex - base);
    const dvec3 x = glm::normalize(glm::cross(y, std::abs(y.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 0, 1)));
    const dvec3 z = glm::cross(x, y);
    return {glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4((base + apex) / 2.0, 1)};
  }

  void read_polygon(bool patch) {
    const double count = number("the number of corners");
    if (!(count >= 3 && count == std::trunc(count)))
      text_.fail(fmt::format("a polygon of {} corners", count));
    const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
    for (double i = 0; i < count; ++i) {
      mesh_.positions.push_back(single("a corner"));
      mesh_.normals.push_back(patch ? single("a normal") : glm::vec3(0));
      has_normal_.push_back(patch);
    }
    pieces_.clear();
    if (!triangulate(std::span(mesh_.positions).subspan(first), pieces_))
      text_.fail(fmt::format("a concave polygon of {} corners; at most {} are triangulated", count,
                             most_concave_corners));
    for (const glm::uvec3 t : pieces_) mesh_.triangles.push_back(t + first);
  }

  // A fill's polygons end at the next fill.
  void finish_fill() {
    if (mesh_.triangles.empty()) return;
    const int material = fill();
    mesh_.name = model_.materials.back().name;
    mesh_.source_vertex_count = mesh_.positions.size();
    complete_normals(mesh_, std::move(has_normal_), 0);
    mesh_.materials.assign(mesh_.triangles.size(), material);
    add_mesh(model_, std::move(mesh_));
    mesh_ = {};
    has_normal_.clear();
  }

  // SPD's relative intensity, for each light and the ambient one.
  void finish_lights() {
    const auto count = static_cast<double>(model_.lights.size());
    if (model_.lights.empty()) return;
    LightDescription ambient;
    ambient.type = LightType::ambient;
    model_.lights.push_back(ambient);
    for (LightDescription& light : model_.lights) light.intensity = std::sqrt(count) / (2 * count);
  }

  TextReader text_;
  std::string entity_;  // the current entity's place
  Model model_;
  Mesh mesh_;  // of the current fill
  std::vector<bool> has_normal_;
  std::vector<glm::uvec3> pieces_;
};

}  // namespace

Model load_nff(Source source, const ModelOptions&) { return NffReader(source).read(); }

}  // namespace sundog::models
