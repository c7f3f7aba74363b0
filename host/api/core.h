// Aliases for the host's types that the public interface wraps (core::Image and so on), since Image alone
// means the public one (include/sundog). Each source in this folder includes this before any public header,
// because the host's headers must not see those.
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

using sundog::aov_names;
using sundog::AovImages;
using sundog::apply;
using sundog::apply_animation;
using sundog::BuildError;
using sundog::change_scene;
using sundog::compile;
using sundog::CompiledScene;
using sundog::DeviceError;
using sundog::DeviceInfo;
using sundog::DriverThreads;
using sundog::encode_image;
using sundog::enumerate_devices;
using sundog::EnvironmentPtr;
using sundog::Film;
using sundog::Image;
using sundog::IoError;
using sundog::JsonContext;
using sundog::load_scene_document;
using sundog::LoadOptions;
using sundog::Mesh;
using sundog::NamedMeshes;
using sundog::Picked;
using sundog::read_image;
using sundog::read_scene_document;
using sundog::render;
using sundog::RenderOptions;
using sundog::RenderProgress;
using sundog::RenderResult;
using sundog::RenderSession;
using sundog::SceneDescription;
using sundog::SceneError;
using sundog::select_devices;
using sundog::SessionSettings;
using sundog::SessionState;
using sundog::Snapshot;
using sundog::ToneCurve;
using sundog::ToneMap;
using sundog::UsageError;
using sundog::WorkGroup;
using sundog::write_image;

}  // namespace sundog::core
