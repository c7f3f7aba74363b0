#include <fmt/format.h>
#include <fmt/ranges.h>

#include <boost/pfr.hpp>

#include "scene_text.h"

using namespace sundog;

namespace {

std::string text(const dvec3& v) { return fmt::format("[{} {} {}]", v.x, v.y, v.z); }
std::string text(const dvec2& v) { return fmt::format("[{} {}]", v.x, v.y); }
std::string text(double v) { return fmt::format("{}", v); }
std::string text(const std::string& v) { return v; }

struct ShapeText {
  std::string operator()(const MeshShape& s) const { return fmt::format("mesh {}", s.mesh); }
  std::string operator()(const FieldShape& s) const { return fmt::format("field {}", s.field); }
  std::string operator()(const SphereShape& s) const { return fmt::format("sphere {}", s.radius); }
  std::string operator()(const PlaneShape&) const { return "plane"; }
  std::string operator()(const BoxShape& s) const { return fmt::format("box {}", text(s.half)); }
  std::string operator()(const CylinderShape& s) const {
    return fmt::format("cylinder {} {} {}", s.radius, s.half_height, s.capped);
  }
  std::string operator()(const ConeShape& s) const {
    return fmt::format("cone {} {} {} {}", s.bottom_radius, s.top_radius, s.half_height, s.capped);
  }
  std::string operator()(const DiskShape& s) const {
    return fmt::format("disk {} {}", s.radius, s.inner_radius);
  }
  std::string operator()(const RectangleShape& s) const {
    return fmt::format("rectangle {} {}", s.half.x, s.half.y);
  }
  std::string operator()(const TorusShape& s) const {
    return fmt::format("torus {} {}", s.major_radius, s.minor_radius);
  }
  std::string operator()(const RoundBoxShape& s) const {
    return fmt::format("round_box {} {}", text(s.half), s.radius);
  }
};

std::string settings(const SceneDescription& scene) {
  const Camera& c = scene.camera;
  const ImageSettings& i = scene.image;
  const RenderSettings& r = scene.render;
  const EnvironmentDescription& e = scene.environment;
  const View to = c.moves_to.value_or(View{});
  return fmt::format("camera {} {} {} {} {} {} {} ", text(c.position), text(c.target), text(c.up), c.fov,
                     c.orthographic, c.near, c.far) +
         fmt::format("{} {} {} {} {} {}\n", c.lens.radius, c.lens.focus.value_or(-1), c.lens.blades,
                     c.lens.rotate, text(to.position), text(to.target)) +
         fmt::format("environment {} {} {} {} {} {} {} {} {}", static_cast<int>(e.type), text(e.color),
                     e.intensity, text(e.up), e.rotate, e.samples, e.visible, e.hidden, e.picture.width) +
         fmt::format(" {} {} {} {} {} ", e.halo.optical_depth, e.halo.index, e.halo.rays, e.halo.size,
                     e.halo.crystals.size()) +
         fmt::format("{} {} {} {} {} {} {}\n", text(e.bottom), text(e.top), e.sun_altitude, e.sun_azimuth,
                     e.sun_size, e.turbidity, text(e.ground)) +
         fmt::format("image {} {} {} {}\n", i.width, i.height, text(i.background_bottom),
                     text(i.background_top)) +
         fmt::format("render {} ", r.light_samples) +
         fmt::format("{} {} {} {} {} {}\n", r.max_depth, r.samples, r.cutoff, r.integrator,
                     static_cast<int>(r.tracer), r.sampler) +
         fmt::format("seed {}\n", r.seed);
}

std::string line(const LightDescription& l) {
  std::string out = fmt::format("light {}", static_cast<int>(l.type));
#define SUNDOG_LIGHT_TEXT(type, name, ...) out += " " + text(l.name);
  LIGHT_KEYS(SUNDOG_LIGHT_TEXT)
#undef SUNDOG_LIGHT_TEXT
  return out + "\n";
}

std::string tree(const SdfNode& n) {
  std::string out = fmt::format("({} {} {} {} {} {} {}", static_cast<int>(n.kind), n.smooth, text(n.offset),
                                n.scale, text(n.period), text(n.count), n.amount);
  for (const FormulaStep& step : n.formula.steps)
    out += fmt::format(" {} {} {}", step.definition.name, step.times, fmt::join(step.values, " "));
  for (const SdfNode& child : n.children) out += tree(child);
  return out + ")";
}

std::string line(const SdfDescription& f) {
  return fmt::format("field {} {} {} {} {} {} {} {} {} {} {} {} {} {}\n", tree(f.root), text(f.lower),
                     text(f.upper), f.detail.value_or(-1), f.least, f.greatest, f.step_limit,
                     static_cast<int>(f.coloring.by), f.coloring.scale, f.coloring.offset, f.occlusion,
                     f.soft_shadow, text(f.glow), f.glow_width);
}

std::string line(const MediumDescription& m) {
  return fmt::format("medium {} {} {} {} {} {} {} {}\n", m.name, m.ior, text(m.absorption), m.priority,
                     static_cast<int>(m.dispersion.kind), fmt::join(m.dispersion.coefficients, " "),
                     text(m.scattering), m.anisotropy);
}

std::string line(const OpenPbr& values) {
  std::string out = "layers";
  boost::pfr::for_each_field(values, [&](const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, dvec3>)
      out += " " + text(value);
    else
      out += fmt::format(" {}", value);
  });
  return out + "\n";
}

std::string line(const MaterialDescription& m) {
  return fmt::format("material {} {} {} {} {} {} {} {} ", m.name, static_cast<int>(m.type), text(m.ambient),
                     text(m.diffuse), text(m.specular), text(m.emission), m.exponent, m.blinn) +
         fmt::format("{} {} {} ", m.roughness, m.multiple_scattering, m.wall_ior) +
         fmt::format("{} {} {} {} {} {} {} {} {}\n", text(m.reflection), text(m.transmission), m.medium,
                     m.shadow_opaque, m.checker, text(m.checker_ambient), text(m.checker_diffuse),
                     m.checker_size, m.vertex_color) +
         fmt::format("{} {} {} {} {} {}\n", text(m.emission), m.opacity, m.cutoff, m.textures.diffuse,
                     m.textures.exponent, m.textures.opacity) +
         (m.layers ? line(*m.layers) : std::string()) + (m.by_paths ? line(*m.by_paths) : std::string());
}

std::string line(const TextureDescription& t) {
  return fmt::format("texture {} {} {} {} {} {} {} {} {}\n", t.name, t.image, static_cast<int>(t.wrap[0]),
                     static_cast<int>(t.wrap[1]), static_cast<int>(t.filter), t.channel, t.uv_set,
                     text(t.uv[0]), text(t.uv[2]));
}

std::string line(const Mesh& m) {
  std::string out = fmt::format("mesh {} {} {}", m.name, m.positions.size(), m.triangles.size());
  for (const auto& p : m.positions) out += fmt::format(" {}", text(dvec3(p)));
  return out + '\n';
}

std::string line(const Object& o) {
  std::string out =
      fmt::format("object {} {} {} {}", o.name, std::visit(ShapeText{}, o.shape), o.material, o.place);
  for (int column = 0; column < 4; ++column)
    out += fmt::format(" {}", text(dvec3(o.world_from_object[column])));
  out += " " + text(o.moves_by);
  for (const TurnDescription& turn : o.turns)
    out += fmt::format(" turn {} {} {} {} {} {}", text(turn.frame[0] + turn.frame[1] + turn.frame[2]),
                       text(turn.axis), turn.degrees, text(turn.about), turn.growth, text(turn.moves_by));
  return out + '\n';
}

}  // namespace

std::string all_values(const SceneDescription& scene) {
  std::string out = settings(scene);
  const auto add = [&](const auto& table) {
    for (const auto& entry : table) out += line(entry);
  };
  out += fmt::format("fog {} {} {}\n", text(scene.fog.color), scene.fog.density,
                     scene.fog.anisotropy.value_or(0));
  add(scene.lights), add(scene.media), add(scene.textures), add(scene.materials), add(scene.meshes),
      add(scene.fields), add(scene.objects);
  return out;
}
