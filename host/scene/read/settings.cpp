// Reads the camera, the image, the render settings and the lights.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/limits.h"
#include "scene/integrators.h"
#include "scene/kinds.h"
#include "scene/lamps.h"
#include "scene/read/parts.h"
#include "scene/spectra/cie.h"

namespace sundog {

namespace {

void check_view(JsonObject& object, const Camera& camera) {
  const dvec3 view = camera.target - camera.position;
  if (!(glm::length(view) > 1e-12))
    object.value().fail("wanted a \"target\" away from \"position\", found the same point");
  if (!(glm::length(glm::cross(glm::normalize(view), camera.up)) > 1e-6))
    object.value().fail("wanted an \"up\" that is not along the view from \"position\" to \"target\"");
}

Lens read_lens(JsonObject& object) {
  Lens lens;
  lens.radius = object.number("radius", lens.radius, at_least_0);
  if (const auto focus = object.find("focus")) lens.focus = focus->number({.low = 1e-9, .high = 1e15});
  lens.blades = object.integer("blades", lens.blades, 0, 16);
  if (lens.blades == 1 || lens.blades == 2)
    object.find("blades")->wanted("3 or more blades, or 0 for a round aperture");
  lens.rotate = object.number("rotate", lens.rotate, {.low = -360, .high = 360});
  return lens;
}

View read_view(JsonObject& object, const Camera& camera) {
  View view{camera.position, camera.target};
  if (const auto position = object.find("position")) view.position = position->vec3();
  if (const auto target = object.find("target")) view.target = target->vec3();
  return view;
}

dvec3 read_falloff(JsonObject& object) {
  const dvec3 falloff(object.number("constant", 1, at_least_0), object.number("linear", 0, at_least_0),
                      object.number("quadratic", 0, at_least_0));
  if (falloff == dvec3(0))
    object.value().fail("wanted a falloff that is not 0 everywhere: it divides the light");
  return falloff;
}

void read_placed_light(JsonObject& object, LightDescription& light) {
  light.position = object.at("position", "a point [x, y, z]").vec3();
  if (facts_of(light.type).has_extent()) return;
  if (const auto falloff = object.find("falloff")) light.falloff = falloff->object("falloff", read_falloff);
}

void read_sun(const JsonValue& value, EnvironmentDescription& e) {
  value.object("sun", [&](JsonObject& object) {
    e.sun_altitude = object.number("altitude", e.sun_altitude, {.low = 0, .high = 90});
    e.sun_azimuth = object.number("azimuth", e.sun_azimuth, {.low = -360, .high = 360});
    e.sun_size = object.number("size", e.sun_size, {.low = 0, .high = 90});
  });
}

void read_filter(JsonObject& object, RenderSettings& render) {
  render.filter = object.choose("filter", render.filter, filters);
  render.filter_radius = object.number("filter_radius", 0, {.low = 0, .high = 16});
  constexpr int least = 8;  // with fewer, all may lie in the negative lobes
  if (render.filter == Filter::mitchell && render.samples < least)
    object.value().fail(fmt::format("wanted at least {} \"samples\" with the filter mitchell, found {}",
                                    least, render.samples));
}

constexpr std::size_t most_guides = 64;  // each costs time at every surface of a path

Guide read_guide(const JsonValue& value) {
  return value.object("guide", [](JsonObject& object) {
    const dvec3 center = object.at("center", "a point [x, y, z]").vec3();
    return Guide{center, object.at("radius", "a length").number({.low = 1e-15, .high = 1e15})};
  });
}

void read_path(JsonObject& object, RenderSettings& render) {
  render.roulette = object.integer("roulette", render.roulette, 1, 65);
  render.light_strategy = object.choose("lights", render.light_strategy, light_strategies);
  render.photons = object.integer("photons", render.photons, 64, 4'194'304);
  render.photon_radius = object.number("photon_radius", render.photon_radius, {.low = 0, .high = 1e15});
  const auto guides = object.find("guides");
  if (!guides) return;
  const auto balls = guides->items("balls");
  if (balls.size() > most_guides) guides->wanted(fmt::format("at most {} balls", most_guides));
  for (const JsonValue& ball : balls) render.guides.push_back(read_guide(ball));
}

void read_adaptive(JsonObject& object, Sampling& sampling) {
  sampling.threshold = object.number("threshold", 0, {.low = 0, .high = 100});
  sampling.first_samples = object.integer("first_samples", sampling.first_samples, 1, 65536);
  sampling.surfaces = object.boolean("surfaces", sampling.surfaces);
  sampling.contrast = object.number("contrast", sampling.contrast, {.low = 0, .high = 1e6});
  sampling.budget = object.number("budget", 0, {.low = 0, .high = 65536});
}

void read_sampling(JsonObject& object, RenderSettings& render) {
  Sampling& sampling = render.sampling;
  constexpr int least_paths = 4;  // one or two paths often find no light even if there is some
  if (const auto adaptive = object.find("adaptive"))
    adaptive->object("adaptive", [&](JsonObject& inner) {
      read_adaptive(inner, sampling);
      return true;
    });
  if (const auto subsample = object.find("subsample"))
    subsample->object("subsample", [&](JsonObject& inner) {
      sampling.subsample = inner.boolean("on", true);
      sampling.subsample_contrast =
          inner.number("contrast", sampling.subsample_contrast, {.low = 0, .high = 100});
      return true;
    });
  if (render.integrator == "path") sampling.first_samples = std::max(sampling.first_samples, least_paths);
  sampling.progressive = object.boolean("progressive", false);
  const bool grows = sampling.threshold > 0 || sampling.progressive;
  if (sampling.subsample && grows)
    object.value().fail("\"subsample\" goes with neither \"adaptive\" nor \"progressive\": leave one out");
  if (grows && (render.sampler == SAMPLER_STRATIFIED || render.sampler == SAMPLER_REGULAR ||
                render.sampler == SAMPLER_BLUE_NOISE))
    object.value().fail(
        fmt::format("the sampler {} has a fixed number of samples: wanted auto, sobol or "
                    "independent with \"adaptive\" or \"progressive\"",
                    name_of_value(samplers, render.sampler)));
}

}  // namespace

Camera read_camera(const JsonValue& value, bool& placed) {
  return value.object("camera", [&](JsonObject& object) {
    Camera camera;
    placed = object.has("position") || object.has("target");
    if (placed) {
      camera.position = object.at("position", "a point [x, y, z]").vec3();
      camera.target = object.at("target", "a point [x, y, z]").vec3();
    }
    if (const auto up = object.find("up")) camera.up = up->direction();
    camera.fov =
        object.number("fov", camera.fov, {.low = 0, .high = 180, .low_open = true, .high_open = true});
    camera.near = object.number("near", camera.near, at_least_0);
    if (const auto far = object.find("far")) {
      camera.far = far->number({.low = 0, .high = std::numeric_limits<double>::max(), .low_open = true});
      if (camera.far <= camera.near)
        far->wanted(fmt::format("a number above the \"near\" of {}", camera.near));
    }
    if (placed) check_view(object, camera);
    if (const auto lens = object.find("lens")) camera.lens = lens->object("lens", read_lens);
    camera.shutter = object.number("shutter", 0, zero_to_one);
    object.integer("shutter_steps", 16, 2, 1024);
    if (const auto moves = object.find("moves_to")) {
      if (!placed) moves->fail("wanted a camera with \"position\" and \"target\" that it moves from");
      camera.moves_to = moves->object("view", [&](JsonObject& view) {
        Camera closes = camera;
        const View end = read_view(view, camera);
        closes.position = end.position;
        closes.target = end.target;
        check_view(view, closes);
        return end;
      });
    }
    return camera;
  });
}

ToneMap read_tone_map(const JsonValue& value) {
  return value.object("tone_map", [](JsonObject& object) {
    ToneMap map;
    map.curve = object.choose("curve", map.curve, tone_curves);
    map.exposure = object.number("exposure", map.exposure, {.low = -32, .high = 32});
    if (object.find("white_balance"))
      map.white_balance = object.number("white_balance", 0, {.low = least_white, .high = greatest_white});
    return map;
  });
}

ImageSettings read_image(const JsonValue& value) {
  return value.object("image", [](JsonObject& object) {
    ImageSettings image;
    image.width = object.integer("width", image.width, 1, most_edge);
    image.height = object.integer("height", image.height, 1, most_edge);
    image.transparent = object.boolean("transparent", image.transparent);
    image.transparent_glass = object.boolean("transparent_glass", image.transparent_glass);
    if (const auto tone_map = object.find("tone_map")) image.tone_map = read_tone_map(*tone_map);
    const auto background = object.find("background");
    if (!background) return image;
    if (background->json().is_array()) {
      image.background_bottom = image.background_top = background->color();
    } else if (background->json().is_object()) {
      background->object("gradient", [&](JsonObject& gradient) {
        image.background_bottom = gradient.at("bottom", "a colour [r, g, b]").color();
        image.background_top = gradient.at("top", "a colour [r, g, b]").color();
      });
    } else {
      background->wanted("a colour [r, g, b] or {\"bottom\": colour, \"top\": colour}");
    }
    return image;
  });
}

RenderSettings read_render(const JsonValue& value) {
  static constexpr std::array tracers = {NamedValue<Tracer>{"auto", Tracer::automatic},
                                         NamedValue<Tracer>{"wide", Tracer::wide},
                                         NamedValue<Tracer>{"compact", Tracer::compact}};
  return value.object("render", [](JsonObject& object) {
    RenderSettings render;
    render.samples = object.integer("samples", render.samples, 1, 65536);
    render.light_samples = object.integer("light_samples", render.light_samples, 0, 1024);
    render.cutoff = object.number("cutoff", render.cutoff, zero_to_one);
    render.max_component = object.number("max_component", render.max_component, above_0);
    render.integrator = object.choice("integrator", render.integrator, integrator_names);
    const Integrator& integrator = *find_integrator(render.integrator);
    render.max_depth = object.integer("max_depth", integrator.depth, 1, integrator.most_depth);
    if (const auto path = object.find("path"))
      path->object("path", [&](JsonObject& inner) {
        read_path(inner, render);
        return true;
      });
    render.caustics = object.boolean("caustics", render.caustics);
    render.sampler = object.choose("sampler", render.sampler, samplers);
    if (const auto seed = object.find("seed"); seed && seed->json() != "frame")
      render.seed = seed->integer(0, std::numeric_limits<int>::max());
    read_filter(object, render);
    read_sampling(object, render);
    render.tracer = object.choose("tracer", render.tracer, tracers);
    render.texture_memory = object.integer("texture_memory", render.texture_memory, 1, 65536);
    render.spatial_splits = object.boolean("spatial_splits", render.spatial_splits);
    return render;
  });
}

FogDescription read_fog(const JsonValue& value) {
  return value.object("fog", [](JsonObject& object) {
    FogDescription fog;
    fog.color = object.color("color", dvec3(1));
    fog.density = object.at("density", "a number per unit of length").number(at_least_0);
    if (const auto anisotropy = object.find("anisotropy")) fog.anisotropy = anisotropy->number(mean_cosines);
    return fog;
  });
}

HaloCrystals read_crystals(const JsonValue& value) {
  return value.object("crystals", [](JsonObject& object) {
    HaloCrystals crystals;
    crystals.shape = object.at("shape", list_names(names_of(halo_shapes))).choose(halo_shapes);
    crystals.ratio = object.number("ratio", crystals.ratio, {.low = 0.001, .high = 1000});
    crystals.tilt = object.number("tilt", crystals.tilt, {.low = 0, .high = 90});
    crystals.roll = object.number("roll", crystals.roll, {.low = 0, .high = 90});
    crystals.share = object.number("share", crystals.share, {.low = 0, .high = 1e6});
    return crystals;
  });
}

void read_halo(JsonObject& object, HaloDescription& halo) {
  const JsonValue kinds = object.at("crystals", "an array of kinds of crystals");
  double shares = 0;
  for (const JsonValue& kind : kinds.items("kinds of crystals")) {
    halo.crystals.push_back(read_crystals(kind));
    shares += halo.crystals.back().share;
  }
  if (!(shares > 0) || halo.crystals.size() > 64)
    kinds.fail("wanted 1 to 64 kinds of crystals, of a share above 0 in all");
  halo.optical_depth = object.number("optical_depth", halo.optical_depth, {.low = 0, .high = 100});
  if (const auto index = object.find("ior")) halo.index = index->number({.low = 1.01, .high = 2});
  halo.rays = object.integer("rays", halo.rays, 1000, 400'000'000);
  halo.size = object.integer("cells", halo.size, 64, 4096);
}

EnvironmentDescription read_environment(const JsonValue& value,
                                        const std::function<Image(const JsonValue&)>& read_picture) {
  const JsonValue named = value.member("type", names_of(environment_types));
  const EnvironmentType type = named.choose(environment_types);
  return value.object(named.text() + "_environment", [&](JsonObject& object) {
    EnvironmentDescription e;
    e.type = type;
    object.at("type", "");
    e.color = object.color("color", e.color);
    e.intensity = object.number("intensity", e.intensity, at_least_0);
    if (const auto up = object.find("up")) e.up = up->direction();
    e.rotate = object.number("rotate", e.rotate, {.low = -1e6, .high = 1e6});
    read_light_sampling(object, e.samples);
    read_light_visible(object, e.visible, e.hidden);
    if (type == EnvironmentType::image) {
      e.picture = read_picture(object.at("file", "the path of an image"));
    } else if (type == EnvironmentType::gradient) {
      e.bottom = object.color("bottom", e.bottom);
      e.top = object.color("top", e.top);
    } else {
      if (type == EnvironmentType::halo) read_halo(object, e.halo);
      e.turbidity = object.number("turbidity", e.turbidity, {.low = 2, .high = 10});
      e.ground = object.color("ground", e.ground, zero_to_one);
      if (const auto sun = object.find("sun")) read_sun(*sun, e);
    }
    return e;
  });
}

LightDescription read_light(const JsonValue& value) {
  const JsonValue named = value.member("type", names_of(light_types));
  const LightType type = named.choose(light_types);
  return value.object(named.text() + "_light", [&](JsonObject& object) {
    LightDescription light;
    light.type = type;
    object.at("type", "");
    object.text("name", " ");  // for pointers
    light.color = object.color("color", light.color);
    if (const auto kelvin = object.find("temperature"))
      light.color *= black_body_color(kelvin->number({.low = 500, .high = 1e5}));
    light.intensity = object.number("intensity", light.intensity, at_least_0);
    if (facts_of(light.type).placed) read_placed_light(object, light);
    read_light_kind(object, light);
    return light;
  });
}

}  // namespace sundog
