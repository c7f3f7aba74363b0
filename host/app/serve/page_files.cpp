// Answers requests with embedded files, or with files from the folder SUNDOG_PAGE_DIR.
#include "app/serve/page_files.h"

#include <algorithm>
#include <cstdlib>

#include "base/file.h"
#include "scene/json/schema.h"

namespace sundog {
namespace {

const char* type_of(std::string_view path) {
  if (path.ends_with(".js")) return "text/javascript; charset=utf-8";
  if (path.ends_with(".css")) return "text/css; charset=utf-8";
  if (path.ends_with(".html")) return "text/html; charset=utf-8";
  if (path.ends_with(".svg")) return "image/svg+xml";
  if (path.ends_with(".jpg")) return "image/jpeg";
  return "application/octet-stream";
}

const PageFile* find_file(std::string_view path) {
  const auto found = std::ranges::find(page_files(), path, &PageFile::path);
  return found == page_files().end() ? nullptr : &*found;
}

}  // namespace

WebAnswer page_answer(std::string_view path) {
  if (path == "/") path = "/index.html";
  const PageFile* file = find_file(path);
  if (!file || !path.starts_with("/"))
    return {404, "text/plain; charset=utf-8", "there is nothing here\n", ""};
  const char* folder = std::getenv("SUNDOG_PAGE_DIR");
  const bool own = folder && !path.starts_with("/vendor/");
  return {200, type_of(path),
          own ? read_file(std::string(folder) + std::string(path)) : std::string(file->bytes), ""};
}

std::string scene_schema() { return std::string(embedded_schema().front().bytes); }

}  // namespace sundog
