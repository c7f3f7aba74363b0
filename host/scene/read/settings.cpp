// Reads the image, the render settings, the camera and the fog.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/integrators.h"
#include "scene/json/members.h"
#include "scene/kinds.h"
#include "scene/read/parts.h"

namespace sundog {

namespace {

void check_view(JsonObject& object, const Camera& camera) {
  const dvec3 view = camera.target - camera.position;
  if (!(glm::length(view) > 1e-12))
    object.value().fail("wanted a \"target\" away from \"position\", found the same point");
  if (!(glm::length(glm::cross(glm::normalize(view), camera.up)) > 1e-6))
    object.value().fail("wanted an \"up\" that is not along the view from \"position\" to \"target\"");
}

/// `focal_length`: in scene units, if given.
Lens read_lens(JsonObject& object, std::optional<double> focal_length) {
  Lens lens;
  read_members(object, lens);
  if (const auto f_number = object.find("f_number")) {
    if (!focal_length) f_number->fail("wanted a camera with a \"focal_length\", or the lens's \"radius\"");
    lens.radius = *focal_length / (2 * f_number->number());
  }
  return lens;
}

/// Sets the field of view by the focal length in millimetres and returns that, if it is given.
std::optional<double> read_focal_length(JsonObject& object, const ImageSettings& image, Camera& camera) {
  std::optional<double> focal_length;
  double film_width = 0;
  object.read("focal_length", focal_length, "film_width", film_width);
  if (focal_length)
    camera.fov = glm::degrees(2 * std::atan(film_width * image.height / image.width / (2 * *focal_length)));
  return focal_length;
}

View read_view(JsonObject& object, const Camera& camera) {
  View view{camera.position, camera.target};
  read_members(object, view);
  return view;
}

void check_filter(JsonObject& object, const RenderSettings& render) {
  constexpr int least = 8;  // with fewer samples, all may lie in the negative lobes
  if (render.filter == Filter::mitchell && render.samples < least)
    object.value().fail(fmt::format("wanted at least {} \"samples\" with the filter mitchell, found {}",
                                    least, render.samples));
}

void read_path(JsonObject& object, RenderSettings& render) {
  read_members(object, render);
  object.read("lights", render.light_strategy, light_strategies);
  const auto guides = object.find("guides");
  if (!guides) return;
  for (const JsonValue& ball : guides->items("balls"))
    ball.object("guide", [&](JsonObject& inner) { read_members(inner, render.guides.emplace_back()); });
}

void read_sampling(JsonObject& object, RenderSettings& render) {
  Sampling& sampling = render.sampling;
  if (const auto adaptive = object.find("adaptive"))
    adaptive->object("adaptive", [&](JsonObject& inner) { read_members(inner, sampling); });
  if (const auto subsample = object.find("subsample"))
    subsample->object("subsample", [&](JsonObject& inner) {
      inner.read("on", sampling.subsample, "contrast", sampling.subsample_contrast);
    });
  sampling.first_samples = std::max(sampling.first_samples, integrator_of(render.integrator).least_samples);
  object.read("progressive", sampling.progressive);
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

/// `position` and `target` must both be given or both be missing; `placed` returns whether they are given.
/// Focal lengths are in millimetres, so `unit` is needed: metres per scene unit.
static Camera read_camera(const JsonValue& value, const ImageSettings& image, double unit, bool& placed) {
  return value.object("camera", [&](JsonObject& object) {
    Camera camera;
    placed = object.has("position") || object.has("target");
    if (placed) {
      camera.position = object.at("position").vec3();
      camera.target = object.at("target").vec3();
    }
    if (const auto up = object.find("up")) camera.up = up->direction();
    read_members(object, camera, {"position", "target", "up"});
    const std::optional<double> focal_length = read_focal_length(object, image, camera);
    if (camera.far <= camera.near)
      object.at("far").wanted(fmt::format("a number above the \"near\" of {}", camera.near));
    if (placed) check_view(object, camera);
    if (const auto lens = object.find("lens"))
      camera.lens = lens->object("lens", [&](JsonObject& inner) {
        return read_lens(inner, focal_length ? std::optional(*focal_length / 1000 / unit) : std::nullopt);
      });
    object.check("shutter_steps");
    if (const auto moves = object.find("moves_to")) {
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
    read_members(object, map, {"exposure"});
    const auto exposure = object.find("exposure");
    map.automatic = exposure && exposure->json() == "auto";
    if (exposure && !map.automatic) exposure->get(map.exposure);
    return map;
  });
}

static ImageSettings read_image_settings(const JsonValue& value) {
  return value.object("image", [](JsonObject& object) {
    ImageSettings image;
    read_members(object, image);
    if (const auto tone_map = object.find("tone_map")) image.tone_map = read_tone_map(*tone_map);
    const auto background = object.find("background");
    if (!background) return image;
    if (background->json().is_array()) {
      image.background_bottom = image.background_top = background->vec3();
    } else {
      background->object("gradient", [&](JsonObject& gradient) {
        gradient.read("bottom", image.background_bottom, "top", image.background_top);
      });
    }
    return image;
  });
}

static RenderSettings read_render(const JsonValue& value) {
  return value.object("render", [](JsonObject& object) {
    RenderSettings render;
    read_members(object, render, {"max_depth", "sampler", "seed"});
    const Integrator& integrator = integrator_of(render.integrator);
    render.max_depth = object.integer("max_depth", integrator.depth, 1, integrator.most_depth);
    if (const auto path = object.find("path"))
      path->object("path", [&](JsonObject& inner) { read_path(inner, render); });
    object.read("sampler", render.sampler, samplers);
    if (const auto seed = object.find("seed"); seed && seed->json() != "frame") seed->get(render.seed);
    check_filter(object, render);
    read_sampling(object, render);
    return render;
  });
}

FogDescription read_fog(const JsonValue& value) {
  return value.object("fog", [](JsonObject& object) {
    FogDescription fog;
    read_members(object, fog);
    return fog;
  });
}

bool read_view_sections(const FindSection& find, SceneDescription& scene) {
  bool placed = false;
  const auto image = find("image"), render = find("render"), camera = find("camera"), lights = find("lights");
  scene.image = image ? read_image_settings(*image) : ImageSettings{};
  scene.render = render ? read_render(*render) : RenderSettings{};
  scene.camera = camera ? read_camera(*camera, scene.image, scene.unit, placed) : Camera{};
  scene.lights.clear();
  if (lights)
    for (const JsonValue& light : lights->items("lights"))
      scene.lights.push_back(read_light(light, scene.unit));
  return placed;
}

}  // namespace sundog
