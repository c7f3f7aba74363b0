// Squares of a glTF file's materials, side by side.
#pragma once
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "base/image_io.h"
#include "temporary_folder.h"

namespace sundog {

/// One square in y = 0 that faces up, placed once a tile. Texture 0 is white, texture 1 black.
class GltfTiles {
 public:
  void add(double x, double z, double depth, const nlohmann::json& material) {
    const auto index = nodes_.size();
    nodes_.push_back({{"mesh", index}, {"translation", {x, 0, z}}, {"scale", {1, 1, depth}}});
    meshes_.push_back(
        {{"primitives",
          {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"indices", 2}, {"material", index}}}}});
    materials_.push_back(material);
  }
  void write(const TemporaryFolder& folder) const {
    const std::array<float, 20> corners = {-0.5f, 0,     -0.5f, -0.5f, 0, 0.5f, 0.5f, 0, 0.5f, 0.5f,
                                           0,     -0.5f, 0,     0,     0, 1,    1,    1, 1,    0};
    const std::array<std::uint16_t, 6> order = {0, 1, 2, 0, 2, 3};
    std::string bytes(reinterpret_cast<const char*>(corners.data()), sizeof corners);
    bytes.append(reinterpret_cast<const char*>(order.data()), sizeof order);
    folder.write("tiles.bin", bytes);
    write_pixel(folder, "white.png", 1);
    write_pixel(folder, "black.png", 0);
    std::vector<std::size_t> all(nodes_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    const auto view = [](int from, int size) {
      return nlohmann::json{{"buffer", 0}, {"byteOffset", from}, {"byteLength", size}};
    };
    const auto values = [](int of, int type, int count, const char* shape) {
      return nlohmann::json{{"bufferView", of}, {"componentType", type}, {"count", count}, {"type", shape}};
    };
    nlohmann::json positions = values(0, 5126, 4, "VEC3");
    positions["min"] = {-0.5, 0, -0.5}, positions["max"] = {0.5, 0, 0.5};
    const nlohmann::json document = {
        {"asset", {{"version", "2.0"}}},
        {"scene", 0},
        {"scenes", {{{"nodes", all}}}},
        {"nodes", nodes_},
        {"meshes", meshes_},
        {"materials", materials_},
        {"images", {{{"uri", "white.png"}}, {{"uri", "black.png"}}}},
        {"textures", {{{"source", 0}}, {{"source", 1}}}},
        {"accessors", {positions, values(1, 5126, 4, "VEC2"), values(2, 5123, 6, "SCALAR")}},
        {"bufferViews", {view(0, 48), view(48, 32), view(80, 12)}},
        {"buffers", {{{"byteLength", 92}, {"uri", "tiles.bin"}}}}};
    folder.write("tiles.gltf", document.dump());
  }

 private:
  static void write_pixel(const TemporaryFolder& folder, const char* name, float value) {
    Image image;
    image.width = image.height = 1;
    image.data = {value, value, value, 1};
    write_image(image, folder / name);
  }

  nlohmann::json nodes_ = nlohmann::json::array(), meshes_ = nlohmann::json::array(),
                 materials_ = nlohmann::json::array();
};

}  // namespace sundog
