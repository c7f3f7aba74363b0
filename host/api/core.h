// Includes the host's headers and declares core:: aliases for the types that share a name with a public type
// (core::Image and so on); plain Image is the public type (include/sundog). Each source in this folder
// includes this before any public header, because the host's headers must not see the public ones.
#pragma once
#include <nlohmann/json.hpp>

#include "base/driver_threads.h"
#include "base/environment.h"
#include "base/error.h"
#include "base/file.h"
#include "base/image_io.h"
#include "base/pixels/dither.h"
#include "base/tone_map.h"
#include "compile/compiled_scene.h"
#include "compile/placing/next_shot.h"
#include "device/devices.h"
#include "render/device/tuning.h"
#include "render/device/view_warnings.h"
#include "render/film/cryptomatte.h"
#include "render/film/frame_memory.h"
#include "render/film/motion.h"
#include "render/plan/passes.h"
#include "render/render.h"
#include "render/session/render_session.h"
#include "scene/animate.h"
#include "scene/description.h"
#include "scene/document.h"
#include "scene/json/parse.h"
#include "scene/json/value.h"

namespace sundog::core {

using sundog::Film;
using sundog::Image;
using sundog::LoadOptions;
using sundog::render;
using sundog::RenderOptions;
using sundog::SessionState;
using sundog::Snapshot;
using sundog::ToneMap;
using sundog::WorkGroup;

}  // namespace sundog::core
