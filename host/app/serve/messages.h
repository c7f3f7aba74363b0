// Messages from the viewer's server to its pages, as JSON text.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/serve/scene_document.h"
#include "render/session/render_session.h"

namespace sundog {

/// A message as text; replaces bytes that are not UTF-8 (from drivers).
std::string message_text(const nlohmann::json& message);

/// All devices, and which of them draw.
nlohmann::json devices_message(const std::vector<DeviceInfo>& all, const std::vector<DeviceInfo>& picked);

/// The whole document, and the values that the reader resolved.
nlohmann::json scene_message(const SceneDocument& document);

/// Values that the reader chooses if the document leaves them out: the camera, the order of objects, the
/// intervals of fields. Also the light groups whose light can be separated, and warnings.
nlohmann::json resolved_json(const SceneDescription& scene);

nlohmann::json status_message(const Snapshot& now);

nlohmann::json picked_message(const Picked& picked);

}  // namespace sundog
