// glTF's containers: GLB files and URIs of buffers and images.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "models/gltf/gltf_json.h"

namespace sundog::models {

struct GltfContainer {
  std::string_view json;
  std::optional<std::string_view> binary;  // a GLB's BIN chunk
};

/// A .glb's chunks, or a .gltf's text as JSON. Views into `source`.
GltfContainer open_container(const Source& source);

/// Notes all files that images and buffers name, used or not (note_file()).
void note_files(const Source& source, const JsonAt& root);

/// Reads a buffer's URI: a data URI, or a file beside `source`. nullopt for a URI with a scheme, which is not
/// fetched. Throws SceneError at `uri`.
std::optional<std::string> read_buffer_uri(const Source& source, const JsonAt& uri);

/// Reads an image's URI (find_beside()). Throws SceneError at `uri` if the file is missing.
std::string read_image_uri(const Source& source, const JsonAt& uri, std::vector<std::string>& warnings);

}  // namespace sundog::models
