// Messages from the viewer's server to its pages, as JSON text.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/serve/scene_document.h"
#include "render/session/render_session.h"

namespace sundog {

/// Text of a message; what is not UTF-8 (a driver's words) is replaced.
std::string message_text(const nlohmann::json& message);

/// All devices, with which of them draw.
nlohmann::json devices_message(const std::vector<DeviceInfo>& all, const std::vector<DeviceInfo>& picked);

/// The whole document, and what was made of it.
nlohmann::json scene_message(const SceneDocument& document);

/// Values that a document may leave out and the reader has chosen: the camera's place, the order of objects,
/// the intervals of fields; the light groups whose light can be kept apart.
nlohmann::json resolved_json(const SceneDescription& scene);

nlohmann::json status_message(const Snapshot& now);

nlohmann::json picked_message(const Picked& picked);

}  // namespace sundog
