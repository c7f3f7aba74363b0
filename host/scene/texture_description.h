// Textures as plain values: images, and nodes that take their colours or numbers from them.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "base/pixels/stored_image.h"
#include "scene/formula/definition.h"
#include "shared/textures.h"

namespace sundog {

/// An image with all its pixels. Bytes of colours are sRGB, bytes and words of data (`srgb` false) linear.
struct ImageDescription {
  std::string name;         // the file's, or where it lies in a file
  std::string file, place;  // for messages
  std::string encoded;      // the file's bytes, until decode_images() has made `pixels` of them
  int file_width = 0, file_height = 0;
  std::uint64_t content = 0;  // a hash of the file's bytes; 0: made, not read
  StoredImage pixels;
  bool srgb = true;
  bool plain = false;     // what the file says of its colour space is left aside
  bool of_model = false;  // where it cannot be decoded, materials go without it
};

/// Whether two images show the same file, perhaps one as colours and one as data.
inline bool same_picture(const ImageDescription& a, const ImageDescription& b) {
  return &a == &b || (a.content != 0 && a.content == b.content);
}

enum class Wrap { repeat, mirror, clamp };
enum class TextureFilter { trilinear, bilinear, nearest };
/// The constants MAPPING_*.
enum class Mapping { uv, object, spherical, cylindrical, box };

/// A place of a ramp and its colour.
struct RampStop {
  double at = 0;
  glm::dvec3 color{0};
};

/// A node of a texture's graph, whose value is what its kind gives, times `factor`, plus `offset`. A
/// pattern's number mixes two colours: black and white, unless factor and offset hold others or `of` names
/// two textures.
struct TextureDescription {
  std::string name;
  TextureKind kind = TEXTURE_COLOR;
  int of[2] = {-1, -1};  // textures that it works on: a pattern's colours, a product's factors, a ramp's [0]
  int image = -1;        // index into SceneDescription::images
  Wrap wrap[2] = {Wrap::repeat, Wrap::repeat};
  TextureFilter filter = TextureFilter::trilinear;
  int channel = -1;  // 0..3: all four values become that one
  Mapping mapping = Mapping::uv;
  int uv_set = 0;
  glm::dmat3 uv{1};          // from the mapping's (u, v, 1) to the texture's, v up
  glm::dmat4 placement{1};   // from the object's units to the mapping's
  double parameter[6] = {};  // by kind, as in shared/textures.h
  std::vector<RampStop> stops{};
  PatternFormula formula{};
  glm::dvec4 factor{1}, offset{0};
};

/// Indices into SceneDescription::textures of what a material takes from textures; -1: nothing.
struct MaterialTextures {
#define SUNDOG_MAP_MEMBER(constant, name) int name = -1;
  MAP_SLOTS(SUNDOG_MAP_MEMBER)
#undef SUNDOG_MAP_MEMBER
};

/// A material by metalness and roughness (shared/metal_rough.h), where textures change these.
struct MetalRough {
  glm::dvec3 base{1};
  double metalness = 1, roughness = 1, reflectance = 0.04;
};

}  // namespace sundog
