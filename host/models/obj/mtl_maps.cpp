// Reads a statement's options and file name, and adds its texture to the model.
#include "models/obj/mtl_maps.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/numbers.h"
#include "models/beside.h"

namespace sundog::models {
namespace fs = std::filesystem;
namespace {

bool is_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  return whole_number<double>(word).has_value();
}

/// One to three numbers; missing ones keep their values.
void read_numbers(TextReader& text, glm::dvec3& values) {
  for (int i = 0; i < 3; ++i) {
    TextReader ahead = text;
    if (i > 0 && !is_number(ahead.word())) return;
    values[i] = std::clamp(text.number("a number of the option"), -1e6, 1e6);
  }
}

int channel_of(std::string_view name) {
  constexpr std::string_view names = "rgbm";  // m: the matte, which is alpha
  const auto at = name.size() == 1 ? names.find(name[0]) : names.npos;
  return at == names.npos ? -1 : static_cast<int>(at);
}

/// Reads an option's values; its keyword has been consumed.
void read_option(TextReader& text, std::string_view option, MtlMap& map) {
  glm::dvec3 values(option == "-s" ? 1 : 0);
  if (option == "-o" || option == "-s" || option == "-t") {
    read_numbers(text, values);
    if (option == "-o") map.offset = glm::dvec2(values);
    if (option == "-s") map.scale = glm::dvec2(values);
  } else if (option == "-bm") {
    map.bump = std::clamp(text.number("-bm"), -1e6, 1e6);
    map.has_bump = true;
  } else if (option == "-mm") {
    text.number("-mm"), text.number("-mm");
  } else if (option == "-clamp") {
    map.clamp = text.word() == "on";
  } else if (option == "-imfchan") {
    map.channel = channel_of(text.word());
  } else if (option == "-blendu" || option == "-blendv" || option == "-cc" || option == "-boost" ||
             option == "-texres" || option == "-type" || option == "-colorspace") {
    text.word();
  } else {
    text.fail(fmt::format("'{}' is no option of a texture", option));
  }
}

}  // namespace

std::optional<MtlMap> read_mtl_map(TextReader& text) {
  MtlMap map;
  map.line = text.line();
  for (;;) {
    TextReader ahead = text;
    const std::string_view word = ahead.word();
    if (word.size() < 2 || word[0] != '-' || is_number(word)) break;
    text.word();
    read_option(text, word, map);
  }
  map.file = text.rest();
  if (map.file.empty()) return std::nullopt;
  return map;
}

int MtlTextures::use(const MtlMap& map, bool srgb, const Source& obj, const fs::path& library) {
  const fs::path folder = library.parent_path();
  const std::optional<fs::path> file = find_beside(obj, folder, map.file, model_.warnings);
  if (!file) {
    const std::string text = fmt::format("{}: line {}: the image {}", library.string(), map.line,
                                         why_not_beside(obj, folder, map.file));
    if (std::ranges::count(model_.warnings, text) == 0) model_.warnings.push_back(text);
    return -1;
  }
  const auto [found, added] =
      images_.try_emplace({file->string(), srgb}, static_cast<int>(model_.images.size()));
  if (added) {
    ImageDescription image;
    image.name = file->filename().string();
    image.file = file->string();
    image.of_model = true;
    image.encoded = read_source(*file).bytes;
    image.srgb = srgb;
    model_.images.push_back(std::move(image));
  }
  TextureDescription texture;
  texture.kind = TEXTURE_IMAGE;
  texture.image = found->second;
  if (map.clamp) texture.wrap[0] = texture.wrap[1] = Wrap::clamp;
  texture.uv =
      glm::dmat3(glm::dvec3(map.scale.x, 0, 0), glm::dvec3(0, map.scale.y, 0), glm::dvec3(map.offset, 1));
  texture.channel = map.channel;
  model_.textures.push_back(texture);
  return static_cast<int>(model_.textures.size()) - 1;
}

}  // namespace sundog::models
