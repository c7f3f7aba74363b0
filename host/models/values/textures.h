// Textures as plain values: images, and nodes that combine them.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "base/pixels/stored_image.h"
#include "shared/textures.h"

namespace sundog {

struct PatternFormula;

/// An image and its pixels. Colour bytes are sRGB; data (`srgb` false) is linear.
struct ImageDescription {
  std::string name;         // the file's name, or its place in a file
  std::string file, place;  // for messages
  std::string encoded;      // the file's bytes until decode_images() has decoded `pixels`
  int file_width = 0, file_height = 0;
  std::uint64_t content = 0;  // hash of the file's bytes; 0: generated
  StoredImage pixels;
  bool srgb = true;
  bool plain = false;     // ignore the file's colour space
  bool of_model = false;  // materials do without it if it cannot be decoded
};

/// Whether two images come from the same file, perhaps one as colours and one as data.
inline bool same_picture(const ImageDescription& a, const ImageDescription& b) {
  return &a == &b || (a.content != 0 && a.content == b.content);
}

enum class Wrap { repeat, mirror, clamp };
enum class TextureFilter { trilinear, bilinear, nearest };
/// The MAPPING_* constants.
enum class Mapping { uv, object, spherical, cylindrical, box };

/// A stop of a colour ramp.
struct RampStop {
  double at = 0;
  glm::dvec3 color{0};
};

/// A node of a texture graph; its value is the kind's value times `factor` plus `offset`. A pattern's number
/// blends two colours: black and white, unless factor and offset or the textures `of` give others.
struct TextureDescription {
  std::string name;
  TextureKind kind = TEXTURE_COLOR;
  std::array<int, 2> of{-1, -1};  // operands: a pattern's colours, a product's factors, a ramp's [0]
  int image = -1;                 // index into the images of the scene or model
  std::array<Wrap, 2> wrap{Wrap::repeat, Wrap::repeat};
  TextureFilter filter = TextureFilter::trilinear;
  int channel = -1;  // 0..3: replicate that channel
  Mapping mapping = Mapping::uv;
  int uv_set = 0;
  glm::dmat3 uv{1};                   // from the mapping's (u, v, 1) to the texture's, v up
  glm::dmat4 placement{1};            // from object units to the mapping's
  std::array<double, 6> parameter{};  // by kind, as in shared/textures.h
  std::vector<RampStop> stops{};
  std::shared_ptr<const PatternFormula> formula{};  // of a formula's pattern
  glm::dvec4 factor{1}, offset{0};
};

/// Indices of a material's textures; -1: none.
struct MaterialTextures {
#define SUNDOG_MAP_MEMBER(constant, name) int name = -1;
  MAP_SLOTS(SUNDOG_MAP_MEMBER)
#undef SUNDOG_MAP_MEMBER
};

/// Metalness and roughness (plain/shade/lowering.h), for materials with textures that change them.
struct MetalRough {
  glm::dvec3 base{1};
  double metalness = 1, roughness = 1, reflectance = 0.04;
};

}  // namespace sundog
