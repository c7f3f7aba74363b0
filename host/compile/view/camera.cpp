// Compiles the view: the camera's frame and pixel vectors, the background, the filter and the settings.
#include "compile/steps.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/limits.h"
#include "compile/view/filter.h"
#include "compile/view/local_origin.h"
#include "scene/integrators.h"
#include "scene/pack.h"

namespace sundog {
namespace {

/// A camera's axes and the vectors from pixel to pixel.
struct Frame {
  dvec3 forward, up, corner, dx, dy;
};

Frame frame_of(const ViewInputs& in, const View& view) {
  const ImageSettings& image = in.image;
  const auto unit_vector = [](const dvec3& vector) { return vector / glm::length(vector); };
  Frame frame;
  frame.forward = unit_vector(view.target - view.position);
  frame.up = unit_vector(in.camera.up);
  const dvec3 side = glm::cross(frame.forward, frame.up);
  const dvec3 right = glm::normalize(side), screen_up = glm::cross(right, frame.forward);
  const bool parallel = in.camera.orthographic > 0;
  const double height =
      parallel ? in.camera.orthographic : 2 * std::tan(in.camera.fov * std::numbers::pi / 360);
  const double pixel = height / image.height;
  frame.corner = (parallel ? dvec3(0) : frame.forward) - right * (pixel * image.width / 2) +
                 screen_up * (pixel * image.height / 2);
  frame.dx = right * pixel;
  frame.dy = -screen_up * pixel;
  return frame;
}

void set_lens(const Camera& camera, const Frame& frame, SceneInfo& info) {
  const Lens& lens = camera.lens;
  const double angle = lens.rotate * std::numbers::pi / 180;
  const dvec3 right = glm::normalize(frame.dx) * lens.radius, up = -glm::normalize(frame.dy) * lens.radius;
  const double focus = lens.focus ? *lens.focus : glm::length(camera.target - camera.position);
  info.lens_x = pack(std::cos(angle) * right + std::sin(angle) * up, focus);
  info.lens_y = pack(std::cos(angle) * up - std::sin(angle) * right, lens.blades);
}

void set_motion(const Camera& camera, const Frame& opens, const Frame& closes, SceneInfo& info) {
  const dvec3 turned = camera.orthographic > 0 ? closes.forward - opens.forward : dvec3(0);
  info.moved_position = pack(camera.moves_to->position - camera.position, turned.x);
  info.moved_corner = pack(closes.corner - opens.corner, turned.y);
  info.moved_dx = pack(closes.dx - opens.dx, turned.z);
  info.moved_dy = pack(closes.dy - opens.dy);
}

/// Sample counts that grow need a sequence.
u32 sampler_of(const RenderSettings& settings) {
  const bool grows = settings.sampling.threshold > 0 || settings.sampling.progressive;
  return grows && settings.sampler == SAMPLER_AUTO ? SAMPLER_SOBOL : settings.sampler;
}

SceneInfo camera_and_settings(const ViewInputs& in) {
  SceneInfo info{};
  const Camera& camera = in.camera;
  const ImageSettings& image = in.image;
  const Frame frame = frame_of(in, {camera.position, camera.target});
  info.camera_position = pack(camera.position - in.origin);
  const double spread = camera.orthographic > 0 ? 1 / glm::length(camera.target - camera.position) : 0;
  info.camera_corner = pack(frame.corner, spread);
  info.camera_dx = pack(frame.dx);
  info.camera_dy = pack(frame.dy);
  info.camera_forward = pack(frame.forward, camera.near);
  info.background_bottom = pack(image.background_bottom, camera.far);
  if (camera.lens.radius > 0) set_lens(camera, frame, info);
  if (camera.moves_to) set_motion(camera, frame, frame_of(in, *camera.moves_to), info);
  info.background_top = pack(image.background_top);
  info.transparent = image.transparent;
  info.up = pack(frame.up);
  const SplitPoint place = split_point(in.origin);
  info.origin = place.high;
  info.origin_rest = place.low;
  if (!is_frame_size(image.width, image.height))
    throw SceneError(*in.file, "/image",
                     fmt::format("wanted at most {} pixels in all, found {} x {}", most_pixels, image.width,
                                 image.height));
  info.width = static_cast<u32>(image.width);
  info.height = static_cast<u32>(image.height);
  info.max_depth = static_cast<u32>(in.render.max_depth);
  info.samples = static_cast<u32>(in.render.samples);
  info.seed = in.render.seed ? hash_u32(static_cast<u32>(in.render.seed)) & ~3u : 0;
  info.cutoff = static_cast<float>(in.render.cutoff);
  info.max_component = static_cast<float>(in.render.max_component);
  info.roulette_depth = static_cast<u32>(in.render.roulette == 65 ? 65537 : in.render.roulette);
  info.light_strategy = in.render.light_strategy;
  return info;
}

}  // namespace

CompiledView compile_view(const ViewInputs& in) {
  CompiledView view;
  view.info = camera_and_settings(in);
  view.filter = filter_table(in.render);
  if (integrator_of(in.render.integrator).photons && !in.render.caustics)
    for (const Guide& guide : in.render.guides)
      view.guides.push_back(pack(guide.center - in.origin, guide.radius));
  view.features.clear_glass = in.image.transparent_glass;
  view.features.lens = in.camera.lens.radius > 0;
  view.features.orthographic = in.camera.orthographic > 0;
  view.features.camera_motion = in.camera.moves_to.has_value();
  view.features.sampler = sampler_of(in.render);
  view.features.filter = !view.filter.empty();
  view.features.guides = !view.guides.empty();
  return view;
}

}  // namespace sundog
