// Loads small model files from text; measures their meshes.
#include "model_files.h"

#include <zlib.h>

#include "base/error.h"

namespace fs = std::filesystem;
using namespace sundog;

Model load_text(const std::string& name, std::string_view bytes, const ModelOptions& options) {
  const TemporaryFolder folder;
  return load_model(folder.write(name, bytes), options);
}

std::string load_error(const fs::path& path) {
  try {
    load_model(path);
    return "";
  } catch (const SceneError& error) {
    return path.filename().string() + ": " + error.place + ": " + error.reason;
  }
}

std::string load_error(const std::string& name, std::string_view bytes) {
  const TemporaryFolder folder;
  return load_error(folder.write(name, bytes));
}

std::string gzipped(std::string_view bytes) {
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, bytes.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

double area_of(const Mesh& mesh) {
  double area = 0;
  for (const glm::uvec3 t : mesh.triangles) {
    const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    area += glm::length(glm::cross(b - a, c - a)) / 2;
  }
  return area;
}
