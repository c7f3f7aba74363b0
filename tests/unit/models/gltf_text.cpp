// Builds glTF documents and their buffers for tests.
#include "gltf_text.h"

std::string base64(std::string_view bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string quad_bytes() {
  std::string bytes;
  put<std::uint8_t>(bytes, {0, 1, 2, 0, 2, 3, 0, 0});
  put<float>(bytes, {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0});
  put<std::uint8_t>(bytes, {255, 0, 0, 0, 0, 255, 0, 0, 51, 51, 51, 0, 0, 0, 0, 0});
  return bytes;
}

const std::string quad_views =
    R"("bufferViews":[{"buffer":0,"byteLength":6},{"buffer":0,"byteOffset":8,"byteLength":48},
  {"buffer":0,"byteOffset":56,"byteLength":16,"byteStride":4}],
  "accessors":[{"bufferView":0,"componentType":5121,"type":"SCALAR","count":6},
  {"bufferView":1,"componentType":5126,"type":"VEC3","count":4},
  {"bufferView":2,"componentType":5121,"normalized":true,"type":"VEC3","count":4}])";

std::string quad_buffer() {
  return R"("buffers":[{"byteLength":72,"uri":"data:application/octet-stream;base64,)" +
         base64(quad_bytes()) + R"("}])";
}

std::string document(const std::string& members) { return R"({"asset":{"version":"2.0"},)" + members + "}"; }

std::string quad(const std::string& members, const std::string& primitive) {
  return document(quad_buffer() + "," + quad_views +
                  R"(,"meshes":[{"name":"quad","primitives":[{"attributes":{"POSITION":1},"indices":0)" +
                  primitive + "}]}]," + members);
}

const std::string one_node = R"("nodes":[{"mesh":0}])";

std::string glb(std::string json, std::string binary) {
  while (json.size() % 4) json += ' ';
  while (binary.size() % 4) binary += '\0';
  std::string file = "glTF";
  put<std::uint32_t>(file, {2, static_cast<std::uint32_t>(28 + json.size() + binary.size()),
                            static_cast<std::uint32_t>(json.size()), 0x4E4F534A});
  file += json;
  put<std::uint32_t>(file, {static_cast<std::uint32_t>(binary.size()), 0x004E4942});
  return file + binary;
}
