// The page that the build embedded (cmake/EmbedFiles.cmake): HTML, CSS, modules, the sheet of surfaces, and
// the scene's schema.
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

/// All of them; "scene.schema.json" is among them without a path of its own.
std::span<const PageFile> page_files();

/// The file at a path of the page; "/" is index.html. Nothing else is served: paths name what is embedded,
/// never files. With SUNDOG_PAGE_DIR set, the same names are read from that folder instead, for work on the
/// page.
WebAnswer page_answer(std::string_view path);

/// scenes/scene.schema.json as the build had it.
std::string scene_schema();

}  // namespace sundog
