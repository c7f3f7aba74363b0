#include "scene/read/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/error.h"
#include "base/image_io.h"
#include "base/input.h"
#include "base/limits.h"
#include "scene/formula/lower.h"
#include "scene/formula/read_leaf.h"
#include "scene/inside.h"
#include "scene/json/parse.h"
#include "scene/read/parts.h"

namespace sundog {
namespace fs = std::filesystem;
namespace {

/// Kinds that mix two colours.
constexpr std::array<std::string_view, 9> pattern_types{"checker", "stripes", "gradient", "brick",  "noise",
                                                        "cells",   "marble",  "wood",     "formula"};

constexpr std::uintmax_t most_image_bytes = std::uintmax_t{1} << 31;

glm::dvec2 read_pair(const JsonValue& value, const Range& range) {
  if (value.json().is_number()) return glm::dvec2(value.number(range));
  const auto items = value.items("2 numbers");
  if (items.size() != 2) value.wanted("a number or an array of 2 numbers");
  return {items[0].number(range), items[1].number(range)};
}

/// From the mapping's u and v to the texture's. The scene scales, rotates and moves the picture, so
/// coordinates are transformed inversely.
glm::dmat3 read_uv(JsonObject& object) {
  glm::dvec2 offset(0), scale(1);
  if (const auto found = object.find("offset")) offset = read_pair(*found, {.low = -1e6, .high = 1e6});
  const double angle = object.number("rotate", 0, {.low = -1e6, .high = 1e6}) * std::numbers::pi / 180;
  if (const auto found = object.find("scale")) {
    scale = read_pair(*found, {.low = -1e6, .high = 1e6});
    if (std::abs(scale.x) < 1e-6 || std::abs(scale.y) < 1e-6)
      found->wanted("scales of 1e-6 or more, or -1e-6 or less");
  }
  const double c = std::cos(angle), s = std::sin(angle);
  const glm::dmat3 moved(glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(-offset, 1));
  const glm::dmat3 turned(glm::dvec3(c, -s, 0), glm::dvec3(s, c, 0), glm::dvec3(0, 0, 1));
  const glm::dmat3 scaled(glm::dvec3(1 / scale.x, 0, 0), glm::dvec3(0, 1 / scale.y, 0), glm::dvec3(0, 0, 1));
  return scaled * turned * moved;
}

Wrap read_wrap(const JsonValue& value) {
  static constexpr std::array wraps = {NamedValue<Wrap>{"repeat", Wrap::repeat},
                                       NamedValue<Wrap>{"mirror", Wrap::mirror},
                                       NamedValue<Wrap>{"clamp", Wrap::clamp}};
  return value.choose(wraps);
}

void read_wraps(JsonObject& object, TextureDescription& texture) {
  const auto found = object.find("wrap");
  if (!found) return;
  if (!found->json().is_array()) {
    texture.wrap[0] = texture.wrap[1] = read_wrap(*found);
    return;
  }
  const auto items = found->items("2 ways to wrap");
  if (items.size() != 2) found->wanted("\"repeat\", \"mirror\" or \"clamp\", or an array of 2 of them");
  for (std::size_t i = 0; i < 2; ++i) texture.wrap[i] = read_wrap(items[i]);
}

/// An image file named in the scene, relative to the scene's folder.
fs::path find_image(const JsonValue& value) {
  const fs::path scene = value.context().file, file = scene.parent_path() / value.text();
  if (!value.context().outside_files && leads_outside(scene, file))
    value.fail("\"" + value.text() + "\" leads out of the scene's folder: " + outside_hint);
  require_readable(file, scene, value.pointer());
  return file;
}

}  // namespace

void TextureLibrary::read(const JsonValue& value, const std::string& name) {
  static constexpr auto types = [] {
    std::array<std::string_view, pattern_types.size() + 4> all{"image", "vertex_color", "ramp", "product"};
    std::copy(pattern_types.begin(), pattern_types.end(), all.begin() + 4);
    return all;
  }();
  const std::string type = value.member("type", types).choice(types);
  Entry entry = value.object(type + "_texture", [&](JsonObject& object) {
    object.at("type", "");
    if (type == "image") return read_image(object);
    if (type == "vertex_color") return read_vertex_color(object);
    if (type == "ramp") return read_ramp(object);
    if (type == "product") return read_product(object);
    return read_pattern(object, type);
  });
  entry.texture.name = name;
  entries_.emplace(name, std::move(entry));
}

std::string TextureLibrary::refer(const JsonValue& name) {
  references_.push_back(name);
  return name.text();
}

void TextureLibrary::check_names() const {
  for (const JsonValue& name : references_) named(name);
  for (const auto& [name, entry] : entries_) check_depth(name, 0);
}

void TextureLibrary::check_depth(const std::string& name, unsigned depth) const {
  const Entry& entry = entries_.find(name)->second;
  if (depth + 2 > MOST_TEXTURE_STACK)
    throw SceneError(scene_.file.string(), join_pointer("/textures", name),
                     "the texture is made of too many others inside each other, or of itself");
  for (const std::string& of : entry.of)
    if (!of.empty()) check_depth(of, depth + 1);
}

std::string TextureLibrary::named(const JsonValue& name) const {
  NameTable names;
  for (const auto& [key, entry] : entries_)
    if (!entry.made) names.emplace(key, 0);
  find_name(name, names, "texture");
  return name.text();
}

/// Reads a pattern's parameters, such as its octaves.
static void read_parameters(JsonObject& object, const std::string& type, TextureDescription& texture) {
  double* to = texture.parameter;
  if (type == "stripes") to[0] = object.number("share", 0.5, zero_to_one);
  if (type == "brick") {
    to[0] = object.number("mortar", 0.05, zero_to_one);
    to[1] = std::min(1.0, 2 * to[0]);  // bricks are twice as long as high
  }
  if (type != "noise" && type != "marble" && type != "wood") return;
  to[0] = object.integer("octaves", type == "noise" ? 1 : 4, 1, 12);
  to[1] = object.number("gain", 0.5, zero_to_one);
  static constexpr std::string_view kinds[] = {"gradient", "value"};
  if (type == "noise") to[2] = object.choice("kind", "gradient", kinds) == "gradient" ? 1 : 0;
  if (type == "marble") to[2] = object.number("turbulence", 1, {.low = 0, .high = 1e3});
  if (type == "wood") to[2] = object.number("turbulence", 0.3, {.low = 0, .high = 1e3});
}

/// Reads a formula and lowers it as a check. Returns whether it gives colours, which are not mixed.
static bool read_pattern_formula(JsonObject& object, PatternFormula& formula) {
  object.at("formula", "a text of the formula language");
  formula.text = read_text(object, "formula");
  formula.parameters = read_declarations(object, {&formula.text, 1});
  try {
    return lower_pattern(formula).values.size() == 3;
  } catch (const FormulaError& error) {
    FormulaError placed = error;
    placed.section = "formula";
    fail_formula(object.value(), placed);
  }
}

/// Reads a texture's projection and placement.
static void read_mapping(JsonObject& object, Mapping standard, TextureDescription& texture) {
  static constexpr std::array projections = {
      NamedValue<Mapping>{"uv", Mapping::uv}, NamedValue<Mapping>{"object", Mapping::object},
      NamedValue<Mapping>{"spherical", Mapping::spherical},
      NamedValue<Mapping>{"cylindrical", Mapping::cylindrical}, NamedValue<Mapping>{"box", Mapping::box}};
  texture.mapping = object.choose("projection", standard, projections);
  texture.uv_set = object.integer("uv_set", 0, 0, 3);
  if (const auto placed = object.find("transform")) {
    const dmat4 transform = read_transform(*placed);
    check_transform(transform, *placed);
    texture.placement = glm::inverse(transform);
  }
}

TextureLibrary::Entry TextureLibrary::read_pattern(JsonObject& object, const std::string& type) {
  Entry entry;
  TextureDescription& texture = entry.texture;
#define SUNDOG_KIND(constant, name) \
  if (type == #name) texture.kind = TEXTURE_##constant;
  TEXTURES(SUNDOG_KIND)
#undef SUNDOG_KIND
  read_mapping(object, Mapping::object, texture);
  const double size = object.number("size", 1, {.low = 1e-6, .high = 1e6});
  texture.placement = glm::scale(dmat4(1), dvec3(1 / size)) * texture.placement;
  texture.uv = glm::dmat3(glm::dvec3(1 / size, 0, 0), glm::dvec3(0, 1 / size, 0), glm::dvec3(0, 0, 1));
  if (texture.mapping == Mapping::spherical || texture.mapping == Mapping::cylindrical)
    texture.placement = glm::scale(dmat4(1), dvec3(size)) * texture.placement;
  read_parameters(object, type, texture);
  if (type == "brick") {  // courses of bricks that are twice as long as high
    texture.placement = glm::scale(dmat4(1), dvec3(0.5, 1, 1)) * texture.placement;
    texture.uv = glm::dmat3(glm::dvec3(0.5, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)) * texture.uv;
  }
  const bool colored = type == "formula" && read_pattern_formula(object, texture.formula);
  const auto colors = object.find("colors");
  if (!colors) return entry;
  if (colored) colors->fail("the formula gives colours by itself; only a number mixes two");
  const auto items = colors->items("2 colours or names of textures");
  if (items.size() != 2) colors->wanted("an array of 2 colours or names of textures");
  if (!items[0].json().is_string() && !items[1].json().is_string()) {
    const dvec3 a = items[0].color(), b = items[1].color();
    texture.factor = glm::dvec4(b - a, 0);
    texture.offset = glm::dvec4(a, 1);
    return entry;
  }
  for (std::size_t i = 0; i < 2; ++i)
    entry.of[i] = items[i].json().is_string() ? refer(items[i]) : add_color(items[i].color());
  return entry;
}

std::string TextureLibrary::add_color(const dvec3& color) {
  Entry entry;
  entry.texture.offset = glm::dvec4(color, 1);
  entry.made = true;
  const std::string name = fmt::format("\x01{}", entries_.size());  // cannot occur in a scene
  entries_.emplace(name, entry);
  return name;
}

TextureLibrary::Entry TextureLibrary::read_ramp(JsonObject& object) {
  Entry entry;
  entry.texture.kind = TEXTURE_RAMP;
  entry.of[0] = refer(object.at("of", "the name of a texture"));
  const JsonValue stops = object.at("stops", "an array of places and colours");
  for (const JsonValue& item : stops.items("places and colours"))
    item.object("ramp_stop", [&](JsonObject& stop) {
      RampStop made;
      made.at = stop.at("at", "a number from 0 to 1").number(zero_to_one);
      made.color = stop.at("color", "a colour [r, g, b]").color();
      if (!entry.texture.stops.empty() && made.at < entry.texture.stops.back().at)
        item.wanted("places in their order");
      entry.texture.stops.push_back(made);
    });
  if (entry.texture.stops.empty()) stops.wanted("a stop or more");
  return entry;
}

TextureLibrary::Entry TextureLibrary::read_product(JsonObject& object) {
  Entry entry;
  entry.texture.kind = TEXTURE_PRODUCT;
  const JsonValue of = object.at("of", "the names of two textures");
  const auto items = of.items("2 names of textures");
  if (items.size() != 2) of.wanted("an array of 2 names of textures");
  for (std::size_t i = 0; i < 2; ++i) entry.of[i] = refer(items[i]);
  return entry;
}

static int read_channel(JsonObject& object) {
  static constexpr std::array channels = {NamedValue<int>{"red", 0}, NamedValue<int>{"green", 1},
                                          NamedValue<int>{"blue", 2}, NamedValue<int>{"alpha", 3},
                                          NamedValue<int>{"all", -1}};
  return object.choose("channel", -1, channels);
}

TextureLibrary::Entry TextureLibrary::read_vertex_color(JsonObject& object) {
  Entry entry;
  entry.texture.kind = TEXTURE_VERTEX_COLOR;
  entry.texture.channel = read_channel(object);
  return entry;
}

TextureLibrary::Entry TextureLibrary::read_image(JsonObject& object) const {
  using Encoding = Entry::Encoding;
  static constexpr std::array encodings = {NamedValue<Encoding>{"auto", Encoding::by_use},
                                           NamedValue<Encoding>{"srgb", Encoding::srgb},
                                           NamedValue<Encoding>{"linear", Encoding::linear}};
  static constexpr std::array filters = {NamedValue<TextureFilter>{"trilinear", TextureFilter::trilinear},
                                         NamedValue<TextureFilter>{"bilinear", TextureFilter::bilinear},
                                         NamedValue<TextureFilter>{"nearest", TextureFilter::nearest}};
  Entry entry;
  TextureDescription& texture = entry.texture;
  texture.kind = TEXTURE_IMAGE;
  const JsonValue file = object.at("file", "the path of an image");
  entry.file = find_image(file).string();
  entry.place = file.pointer();
  entry.encoding = object.choose("encoding", Encoding::by_use, encodings);
  texture.filter = object.choose("filter", TextureFilter::trilinear, filters);
  read_wraps(object, texture);
  read_mapping(object, Mapping::uv, texture);
  texture.uv = read_uv(object);
  texture.channel = read_channel(object);
  return entry;
}

int TextureLibrary::use(const JsonValue& name, TextureUse use) { return this->use(named(name), use); }

int TextureLibrary::use(const std::string& name, TextureUse use) {
  if (const auto found = used_.find({name, use}); found != used_.end()) return found->second;
  const Entry& entry = entries_.find(name)->second;
  TextureDescription texture = entry.texture;
  for (std::size_t i = 0; i < 2; ++i)
    if (!entry.of[i].empty()) texture.of[i] = this->use(entry.of[i], use);
  if (texture.kind == TEXTURE_IMAGE) {
    if (use == TextureUse::number && texture.channel < 0) texture.channel = 0;
    // An encoding is one of bytes; an EXR's colours have primaries in any case.
    const bool by_use = entry.encoding == Entry::Encoding::by_use || !drops_alpha(entry.file);
    const bool srgb = by_use ? use == TextureUse::color : entry.encoding == Entry::Encoding::srgb;
    texture.image = use_image(entry, srgb);
  }
  const auto index = static_cast<int>(scene_.textures.size());
  scene_.textures.push_back(texture);
  used_.emplace(std::pair(name, use), index);
  return index;
}

void TextureLibrary::add_known_image(const std::string& file, bool srgb) {
  const auto found = std::ranges::find_if(
      *known_, [&](const ImageDescription& image) { return image.file == file && image.srgb == srgb; });
  lacks_images_ |= found == known_->end();
  scene_.images.push_back(found == known_->end() ? ImageDescription{} : *found);
}

int TextureLibrary::use_image(const Entry& entry, bool srgb) {
  const auto [found, added] = images_.try_emplace({entry.file, srgb}, static_cast<int>(scene_.images.size()));
  if (added && known_) {
    add_known_image(entry.file, srgb);
  } else if (added) {
    ImageDescription image;
    image.name = fs::path(entry.file).filename().string();
    image.file = entry.file;
    image.place = fmt::format("named in {}, {}", scene_.file.filename().string(), entry.place);
    image.encoded = read_input(entry.file, most_image_bytes);
    image.srgb = srgb;
    scene_.images.push_back(std::move(image));
  }
  return found->second;
}

}  // namespace sundog
