// Reads samplers, textures and images. Files have v down, so their transforms are flipped before and after.
#include "models/gltf/gltf_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "models/readers.h"

namespace sundog::models {
namespace {

Wrap read_wrap(const JsonAt& at, const char* key) {
  switch (const std::uint64_t mode = at.integer_or(key, 10497)) {
    case 10497:
      return Wrap::repeat;
    case 33648:
      return Wrap::mirror;
    case 33071:
      return Wrap::clamp;
    default:
      at.member(key).fail(fmt::format("wrap mode {}; 10497, 33648 or 33071 wanted", mode));
  }
}

TextureDescription read_sampler(const JsonAt& at) {
  constexpr std::uint64_t nearest = 9728;
  TextureDescription sampled;
  sampled.wrap[0] = read_wrap(at, "wrapS");
  sampled.wrap[1] = read_wrap(at, "wrapT");
  if (at.integer_or("magFilter", 0) == nearest) sampled.filter = TextureFilter::nearest;
  return sampled;
}

/// Converts the file's matrix, for coordinates with v down, to one for coordinates with v up. The file's
/// rotation is clockwise with v down.
glm::dmat3 read_uv_transform(const JsonAt& at) {
  const auto pair = [&](const char* key, double otherwise) {
    const auto found = at.find(key);
    const std::vector<double> values = found ? found->numbers(2) : std::vector<double>(2, otherwise);
    return glm::dvec2(values[0], values[1]);
  };
  const glm::dvec2 offset = pair("offset", 0), scale = pair("scale", 1);
  const double angle = at.number("rotation", 0, {}), c = std::cos(angle), s = std::sin(angle);
  const glm::dmat3 file(glm::dvec3(c * scale.x, -s * scale.x, 0), glm::dvec3(s * scale.y, c * scale.y, 0),
                        glm::dvec3(offset, 1));
  const glm::dmat3 flip(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 1, 1));
  return flip * file * flip;
}

}  // namespace

GltfTextures::GltfTextures(const JsonAt& root, const GltfAccessors& accessors)
    : accessors_(accessors), images_(root.list("images")) {
  for (const JsonAt& at : root.list("samplers")) samplers_.push_back(read_sampler(at));
  for (const JsonAt& at : root.list("textures")) textures_.push_back(read_texture(at));
}

GltfTextures::Entry GltfTextures::read_texture(const JsonAt& at) const {
  Entry entry;
  if (const auto sampler = at.find("sampler"))
    entry.sampled = samplers_[sampler->index(samplers_.size(), "sampler")];
  auto source = at.find("source");
  if (const auto webp = at.extension("EXT_texture_webp"))
    if (const auto better = webp->find("source")) source = better;
  if (source) {
    entry.image = source->index(images_.size(), "image");
    entry.usable = true;
  }
  return entry;
}

TextureDescription GltfTextures::read(const JsonAt& info) const {
  const JsonAt at = info.member("index");
  const Entry& entry = textures_[at.index(textures_.size(), "texture")];
  TextureDescription texture = entry.sampled;
  texture.kind = TEXTURE_IMAGE;
  texture.image = entry.usable ? static_cast<int>(entry.image) : -1;
  std::uint64_t set = info.integer_or("texCoord", 0);
  if (const auto transform = info.extension("KHR_texture_transform")) {
    texture.uv = read_uv_transform(*transform);
    set = transform->integer_or("texCoord", set);
  }
  texture.uv_set = static_cast<int>(std::min(set, most_uv_sets));
  return texture;
}

ImageDescription GltfTextures::load(std::size_t index, std::vector<std::string>& warnings) const {
  const JsonAt& at = images_[index];
  const Source& source = accessors_.source();
  ImageDescription image;
  image.file = source.path.string();
  image.place = at.pointer();
  image.name = at.text("name");
  image.plain = image.of_model = true;  // glTF 2.0, section 3.8.3: ignore colour space information
  const auto uri = at.find("uri"), view = at.find("bufferView");
  if (uri && view) at.fail("an image has either a uri or a bufferView");
  if (view) {
    image.encoded = accessors_.view_bytes(*view);
  } else if (uri) {
    image.encoded = read_image_uri(source, *uri, warnings);
    const std::string text = uri->text();
    if (image.name.empty() && !text.starts_with("data:")) image.name = text;
  } else {
    at.fail("an image needs a uri or a bufferView");
  }
  if (image.name.empty()) image.name = fmt::format("{}#{}", source.path.filename().string(), at.pointer());
  return image;
}

/// An unavailable image causes a warning.
int GltfTextures::use_image(std::size_t index, bool srgb, Model& model) {
  const auto [found, added] = used_.try_emplace({index, srgb}, -1);
  if (!added) return found->second;
  try {
    ImageDescription image = load(index, model.warnings);
    image.srgb = srgb;
    found->second = static_cast<int>(model.images.size());
    model.images.push_back(std::move(image));
  } catch (const SceneError& error) {
    const std::string text = fmt::format("{}: {}", error.place, error.reason);
    if (std::ranges::count(model.warnings, text) == 0) model.warnings.push_back(text);
  }
  return found->second;
}

int GltfTextures::use(const TextureDescription& texture, bool srgb, Model& model) {
  if (texture.image < 0) {
    leave_unread(model, "images of other formats than PNG, JPEG and WebP");
    return -1;
  }
  if (texture.uv_set >= static_cast<int>(most_uv_sets)) {
    leave_unread(model, "textures with coordinates beyond four sets");
    return -1;
  }
  const int image = use_image(static_cast<std::size_t>(texture.image), srgb, model);
  if (image < 0) return -1;
  model.textures.push_back(texture);
  model.textures.back().image = image;
  return static_cast<int>(model.textures.size()) - 1;
}

int GltfTextures::product(int a, int b, Model& model) {
  if (a < 0 || b < 0) return std::max(a, b);
  TextureDescription both;
  both.kind = TEXTURE_PRODUCT;
  both.of[0] = a;
  both.of[1] = b;
  model.textures.push_back(both);
  return static_cast<int>(model.textures.size()) - 1;
}

}  // namespace sundog::models
