// glTF's cameras and lights (KHR_lights_punctual), before nodes place them.
#pragma once
#include "models/gltf/gltf_json.h"
#include "models/values/camera.h"
#include "models/values/light.h"

namespace sundog::models {

struct GltfCamera {
  double fov = 0, height = 0;  // one of them is above 0: radians; of an orthographic camera's picture
  double near = 0, far = 0;    // along the view
  double aspect = 0;           // width over height; 0: not given
};

GltfCamera read_gltf_camera(const JsonAt& at);

/// Candela and lux are divided by pi, which the phong model's kd lacks; point and spot lights fall off with
/// the squared distance. Colour and angles are unchanged.
LightDescription read_gltf_light(const JsonAt& at);

}  // namespace sundog::models
