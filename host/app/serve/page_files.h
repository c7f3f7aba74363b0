// The files of the viewer's page, which the build embeds (cmake/EmbedFiles.cmake): HTML, CSS, modules,
// pictures of the surfaces, and the scene's schema.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "app/serve/web_server.h"

namespace sundog {

struct PageFile {
  std::string_view path;  // "/app.js"
  std::string_view bytes;
};

/// All embedded files of the page.
std::span<const PageFile> page_files();

/// The embedded file at this path; "/" is index.html. Other paths get a 404, never a file on disk. With
/// SUNDOG_PAGE_DIR set, reads files of the same names from that folder instead, for work on the page.
WebAnswer page_answer(std::string_view path);

/// scenes/scene.schema.json, as embedded by the build.
std::string scene_schema();

}  // namespace sundog
