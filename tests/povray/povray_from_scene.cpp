// Writes camera, lights, materials and objects in POV-Ray's language. POV-Ray's axes are left-handed only by
// its default camera: all its vectors are given here, so that coordinates stay as they are.
#include "povray_from_scene.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "shapes.h"
#include "text.h"

namespace sundog::povray {

namespace {

constexpr double shrink = 1 - 1e-3;  // POV-Ray overlooks surfaces less than about 1e-4 apart

// POV-Ray bends nothing at the far side of an overlap, but without this would reflect there, by a wrong
// index.
constexpr const char* unseen = "texture { pigment { color rgbf 1 } finish { ambient 0 diffuse 0 } }";

std::string texture(const MaterialDescription& m);

const MaterialDescription& material_of(const SceneDescription& scene, const Object& object) {
  if (object.material < 0) throw Unsupported(object.place + ": a mesh with materials of its own");
  return scene.materials.at(static_cast<std::size_t>(object.material));
}

bool is_dielectric(const MaterialDescription& m) { return m.type == MaterialType::dielectric; }

const MediumDescription& medium_of(const SceneDescription& scene, const MaterialDescription& m) {
  if (m.medium < 0) throw Unsupported(m.name + ": a thin dielectric");
  return scene.media.at(static_cast<std::size_t>(m.medium));
}

// A body of the world's own medium is a hole in the others and nothing by itself.
bool is_hole(const SceneDescription& scene, const Object& object) {
  const MaterialDescription& m = material_of(scene, object);
  if (!is_dielectric(m)) return false;
  const MediumDescription& medium = medium_of(scene, m);
  return medium.ior == scene.media[0].ior && medium.absorption == scene.media[0].absorption;
}

std::string camera(const SceneDescription& scene) {
  const Camera& c = scene.camera;
  const dvec3 forward = glm::normalize(c.target - c.position);
  const dvec3 right = glm::normalize(glm::cross(forward, c.up)), up = glm::cross(right, forward);
  const double height = 2 * std::tan(glm::radians(c.fov) / 2);
  const double width = height * scene.image.width / scene.image.height;
  return fmt::format("camera {{ perspective location {} direction {} right {} up {} }}\n", text(c.position),
                     text(forward), text(right * width), text(up * height));
}

std::string background(const SceneDescription& scene) {
  const ImageSettings& image = scene.image;
  if (image.background_bottom == image.background_top)
    return fmt::format("background {{ color {} }}\n", rgb(image.background_top));
  const dvec3 up = glm::normalize(scene.camera.up);
  return fmt::format(
      "sky_sphere {{ pigment {{ function {{ min(0.9999999, 0.5 + 0.5 * ({} * x + {} * y + {} * z)) }} "
      "color_map {{ [0 "
      "color {}] [1 color {}] }} }} }}\n",
      text(up.x), text(up.y), text(up.z), rgb(image.background_bottom), rgb(image.background_top));
}

// 1 / (c + q d^2) in POV-Ray's 2 / (1 + (d / distance)^2).
std::string fading(const LightDescription& light, dvec3& color) {
  if (light.falloff.y == 0 && light.falloff.z == 0) {
    color /= light.falloff.x;
    return "";
  }
  if (light.falloff.y != 0 || light.falloff.x == 0) throw Unsupported("falloff other than 1 / (c + q d^2)");
  color /= 2 * light.falloff.x;
  return fmt::format(" fade_distance {} fade_power 2", text(std::sqrt(light.falloff.x / light.falloff.z)));
}

std::string light_source(const LightDescription& light) {
  dvec3 color = light.color * light.intensity;
  const std::string fade = fading(light, color);
  const dvec3 along = glm::normalize(light.direction);
  switch (light.type) {
    case LightType::point:
      return fmt::format("light_source {{ {} color {}{} }}\n", text(light.position), rgb(color), fade);
    case LightType::directional:
      return fmt::format("light_source {{ {} color {} parallel point_at 0 }}\n", text(along * -1e5),
                         rgb(color));
    case LightType::spot:
      return fmt::format(
          "light_source {{ {} color {}{} spotlight point_at {} radius {} falloff {} tightness 0 }}\n",
          text(light.position), rgb(color), fade, text(light.position + along), text(light.inner_angle),
          text(light.outer_angle));
    case LightType::rectangle:
    case LightType::disk:
    case LightType::sphere:
      throw Unsupported("a light with an extent: POV-Ray's shines without the cosine of its surface");
    case LightType::ambient:
      break;
  }
  return "";
}

std::string lights(const SceneDescription& scene) {
  dvec3 ambient{0};
  std::string out;
  for (const LightDescription& light : scene.lights) {
    if (light.type == LightType::ambient) ambient += light.color * light.intensity;
    out += light_source(light);
  }
  return fmt::format(
             "global_settings {{ assumed_gamma 1.0 max_trace_level {} adc_bailout {} ambient_light {} }}\n",
             scene.render.max_depth, text(scene.render.cutoff), rgb(ambient)) +
         out;
}

double grey(const dvec3& color, const std::string& what) {
  if (color.x != color.y || color.y != color.z) throw Unsupported(what + ": a coloured highlight");
  return color.x;
}

std::string highlight(const MaterialDescription& m) {
  if (m.specular == dvec3(0)) return "";
  if (m.blinn) throw Unsupported(m.name + ": Blinn's highlight");
  return fmt::format(" phong {} phong_size {}", text(grey(m.specular, m.name)), text(m.exponent));
}

// POV-Ray's ambient term is multiplied by the pigment, so it is divided here.
std::string opaque_texture(const MaterialDescription& m, const dvec3& ambient, const dvec3& diffuse) {
  const dvec3 pigment = glm::max(diffuse, dvec3(1e-6));
  return fmt::format(
      "texture {{ pigment {{ color {} }} finish {{ ambient {} diffuse 1{} reflection {{ {} }} }} }}",
      rgb(pigment), rgb(ambient / pigment), highlight(m), rgb(m.reflection));
}

std::string glass_texture(const MaterialDescription& m) {
  if (m.ambient != dvec3(0) || m.diffuse != dvec3(0))
    throw Unsupported(m.name + ": a dielectric with a diffuse term");
  if (m.reflection != dvec3(1)) throw Unsupported(m.name + ": a tinted reflection");
  return fmt::format(
      "texture {{ pigment {{ color rgbf <{},{},{},1> }} finish {{ ambient 0 diffuse 0{} reflection {{ 0, 1 "
      "fresnel on }} "
      "conserve_energy }} }}",
      text(m.transmission.x), text(m.transmission.y), text(m.transmission.z), highlight(m));
}

std::string texture(const MaterialDescription& m) {
  if (is_dielectric(m)) return glass_texture(m);
  if (m.transmission != dvec3(0)) throw Unsupported(m.name + ": constant transmission");
  const std::string even = opaque_texture(m, m.ambient, m.diffuse);
  if (!m.checker) return even;
  return fmt::format("texture {{ checker {} {} scale {} }}", even,
                     opaque_texture(m, m.checker_ambient, m.checker_diffuse), text(m.checker_size));
}

std::string interior(const MediumDescription& medium, Absorption absorption) {
  const dvec3& a = medium.absorption;
  std::string inside;
  if (a != dvec3(0)) {
    if (absorption == Absorption::media) {
      inside = fmt::format(" media {{ absorption {} }}", rgb(a));
    } else {
      const double distance = 1 / std::max({a.x, a.y, a.z});
      inside = fmt::format(" fade_distance {} fade_power 1001 fade_color {}", text(distance),
                           rgb(dvec3(1) - a * distance));
    }
  }
  return fmt::format("interior {{ ior {}{} }}", text(medium.ior), inside);
}

int priority_of(const SceneDescription& scene, const Object& object) {
  return medium_of(scene, material_of(scene, object)).priority;
}

// Whether the bounds lie in a box-shaped hole of higher priority than the object's: there it is not.
bool lies_in_hole(const SceneDescription& scene, const Object& object, const Bounds& bounds) {
  for (const Object& hole : scene.objects) {
    const auto* box = std::get_if<BoxShape>(&hole.shape);
    if (!box || !is_hole(scene, hole) || priority_of(scene, hole) <= priority_of(scene, object)) continue;
    const dmat4 to_box = glm::inverse(hole.world_from_object);
    bool inside = true;
    for (int corner = 0; corner < 8 && inside; corner++) {
      const dvec3 at{corner & 1 ? bounds.lower.x : bounds.upper.x,
                     corner & 2 ? bounds.lower.y : bounds.upper.y,
                     corner & 4 ? bounds.lower.z : bounds.upper.z};
      const dvec3 beyond = glm::abs(dvec3(to_box * glm::dvec4(at, 1))) - box->half;
      inside = beyond.x < 0 && beyond.y < 0 && beyond.z < 0;
    }
    if (inside) return true;
  }
  return false;
}

// The exact transmitting solids that reach into this one, of higher or of lower priority than its own.
enum class Rank { higher, lower };
std::vector<const Object*> overlapping(const SceneDescription& scene, const Object& object, Rank rank) {
  std::vector<const Object*> found;
  if (std::holds_alternative<MeshShape>(object.shape)) return found;
  const Bounds bounds = world_bounds(scene, object);
  for (const Object& other : scene.objects) {
    if (!is_dielectric(material_of(scene, other)) || std::holds_alternative<MeshShape>(other.shape)) continue;
    const int difference = priority_of(scene, other) - priority_of(scene, object);
    if (rank == Rank::higher ? difference <= 0 : difference >= 0) continue;
    const Bounds others = world_bounds(scene, other);
    if (!bounds.overlaps(others)) continue;
    if (rank == Rank::higher ? lies_in_hole(scene, object, others) : lies_in_hole(scene, other, bounds))
      continue;
    found.push_back(&other);
  }
  return found;
}

// The object's shape less what overrules it, in world space, open for modifiers. Light that goes from this
// solid into the one that overrules it meets that one's surface first, and then the cut, which must not be
// seen a second time.
std::string open_region(const SceneDescription& scene, const Object& object) {
  const std::string own = open_shape(scene, object.shape) + matrix(object.world_from_object) + ' ';
  std::string cuts;
  for (const Object* other : overlapping(scene, object, Rank::higher)) {
    cuts += open_shape(scene, other->shape);
    if (!is_hole(scene, *other))
      cuts +=
          fmt::format("{} interior_{} scale {} ", texture(material_of(scene, object)), unseen, text(shrink));
    cuts += matrix(other->world_from_object) + " } ";
  }
  return cuts.empty() ? own : "difference { " + own + "} " + cuts;
}

// The other way, light meets the cut first, and then this solid's own surface, where that lies in the solid
// it overrules.
std::string inner_texture(const SceneDescription& scene, const Object& object) {
  std::string around;
  for (const Object* other : overlapping(scene, object, Rank::lower))
    if (!is_hole(scene, *other)) around += open_region(scene, *other) + "} ";
  if (around.empty()) return "";
  return fmt::format(" interior_texture {{ object {{ union {{ {}}} {} {} }} }}", around,
                     texture(material_of(scene, object)), unseen);
}

std::string write_object(const SceneDescription& scene, const Object& object, Absorption absorption) {
  const MaterialDescription& m = material_of(scene, object);
  if (is_hole(scene, object)) return "";
  if (!is_dielectric(m))  // a pattern moves with its object
    return open_shape(scene, object.shape) + texture(m) + ' ' + matrix(object.world_from_object) + " }\n";
  std::string out = open_region(scene, object) + texture(m) + inner_texture(scene, object) + ' ' +
                    interior(medium_of(scene, m), absorption) + " hollow";
  if (!m.shadow_opaque) return out + " }\n";
  return out + " no_shadow }\n" + open_shape(scene, object.shape) + matrix(object.world_from_object) +
         " pigment { color rgb 0 } no_image no_reflection }\n";
}

}  // namespace

std::string from_scene(const SceneDescription& scene, Absorption absorption) {
  std::string out = "#version 3.7;\n" + lights(scene) + camera(scene) + background(scene);
  std::set<int> meshes;
  for (const Object& object : scene.objects)
    if (const auto* mesh = std::get_if<MeshShape>(&object.shape))
      if (meshes.insert(mesh->mesh).second) out += declare_mesh(scene, mesh->mesh);
  for (const Object& object : scene.objects) out += write_object(scene, object, absorption);
  return out;
}

}  // namespace sundog::povray
