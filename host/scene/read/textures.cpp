// Keeps entries by name; each use by a material adds a texture to the scene, once as colour, number or data.
#include "scene/read/textures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/error.h"
#include "base/image_io.h"
#include "base/input.h"
#include "base/limits.h"
#include "formula/lower.h"
#include "scene/json/parse.h"
#include "scene/read/field_formulas.h"
#include "scene/read/parts.h"

namespace sundog {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t most_image_bytes = std::uintmax_t{1} << 31;

/// Reads the transform from the mapping's u and v to the texture's. The scene scales, rotates and moves the
/// picture, so coordinates get the inverse transform.
glm::dmat3 read_uv(JsonObject& object) {
  glm::dvec2 offset(0), scale(1);
  double degrees = 0;
  object.read("offset", offset, "scale", scale, "rotate", degrees);
  if (std::abs(scale.x) < 1e-6 || std::abs(scale.y) < 1e-6)
    object.at("scale").wanted("scales of 1e-6 or more, or -1e-6 or less");
  const double angle = degrees * std::numbers::pi / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  const glm::dmat3 moved(glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(-offset, 1));
  const glm::dmat3 turned(glm::dvec3(c, -s, 0), glm::dvec3(s, c, 0), glm::dvec3(0, 0, 1));
  const glm::dmat3 scaled(glm::dvec3(1 / scale.x, 0, 0), glm::dvec3(0, 1 / scale.y, 0), glm::dvec3(0, 0, 1));
  return scaled * turned * moved;
}

void read_wraps(JsonObject& object, TextureDescription& texture) {
  const auto found = object.find("wrap");
  if (!found) return;
  if (!found->json().is_array()) {
    found->get(texture.wrap[0]);
    texture.wrap[1] = texture.wrap[0];
    return;
  }
  const auto items = found->items("ways to wrap");
  for (std::size_t i = 0; i < 2; ++i) items[i].get(texture.wrap[i]);
}

}  // namespace

void TextureLibrary::read(const JsonValue& value, const std::string& name) {
  const std::string type = value.type();
  Entry entry = value.object("texture", [&](JsonObject& object) {
    if (type == "image") return read_image_texture(object);
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
  for (const auto& [name, entry] : entries_) check_depth(name, {});
}

/// `inside`: the textures that contain this one, outermost first.
void TextureLibrary::check_depth(const std::string& name, std::vector<std::string> inside) const {
  const auto fail = [&](const std::string& what) {
    throw SceneError(scene_.file.string(), join_pointer("/textures", name), what);
  };
  const bool circle = std::ranges::count(inside, name) > 0;
  inside.push_back(name);
  if (circle) fail(fmt::format("the texture is made of itself: {}", fmt::join(inside, " of ")));
  if (inside.size() + 1 > MOST_TEXTURE_STACK)
    fail(fmt::format("the texture is inside {} others; wanted at most {}", inside.size() - 1,
                     MOST_TEXTURE_STACK - 2));
  for (const std::string& of : entries_.find(name)->second.of)
    if (!of.empty()) check_depth(of, inside);
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
  auto& to = texture.parameter;
  if (type == "stripes") object.read("share", to[0]);
  if (type == "brick") {
    object.read("mortar", to[0]);
    to[1] = std::min(1.0, 2 * to[0]);  // bricks are twice as long as high
  }
  if (!object.knows("octaves")) return;
  object.read("octaves", to[0], "gain", to[1]);
  if (object.knows("turbulence")) object.read("turbulence", to[2]);
  if (type != "noise") return;
  std::string kind;
  object.read("kind", kind);
  to[2] = kind == "gradient" ? 1 : 0;
}

/// Reads a formula and lowers it as a check. Returns whether it yields colours, which cannot mix others.
static bool read_pattern_formula(JsonObject& object, TextureDescription& texture) {
  PatternFormula formula;
  object.at("formula");
  formula.text = read_text(object, "formula");
  formula.parameters = read_declarations(object, {&formula.text, 1});
  texture.formula = std::make_shared<PatternFormula>(formula);
  try {
    return lower_pattern(formula).values.size() == 3;
  } catch (const FormulaError& error) {
    FormulaError placed = error;
    placed.section = "formula";
    fail_formula(object.value(), placed);
  }
}

/// Reads a texture's projection and placement.
static void read_mapping(JsonObject& object, TextureDescription& texture) {
  object.read("projection", texture.mapping, "uv_set", texture.uv_set);
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
  read_mapping(object, texture);
  double size = 0;
  object.read("size", size);
  texture.placement = glm::scale(dmat4(1), dvec3(1 / size)) * texture.placement;
  texture.uv = glm::dmat3(glm::dvec3(1 / size, 0, 0), glm::dvec3(0, 1 / size, 0), glm::dvec3(0, 0, 1));
  if (texture.mapping == Mapping::spherical || texture.mapping == Mapping::cylindrical)
    texture.placement = glm::scale(dmat4(1), dvec3(size)) * texture.placement;
  read_parameters(object, type, texture);
  if (type == "brick") {  // bricks are twice as long as high
    texture.placement = glm::scale(dmat4(1), dvec3(0.5, 1, 1)) * texture.placement;
    texture.uv = glm::dmat3(glm::dvec3(0.5, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)) * texture.uv;
  }
  const bool colored = type == "formula" && read_pattern_formula(object, texture);
  const auto colors = object.find("colors");
  if (!colors) return entry;
  if (colored) colors->fail("the formula gives colours by itself; only a number mixes two");
  const auto items = colors->items("colours or names of textures");
  if (!items[0].json().is_string() && !items[1].json().is_string()) {
    const dvec3 a = items[0].vec3(), b = items[1].vec3();
    texture.factor = glm::dvec4(b - a, 0);
    texture.offset = glm::dvec4(a, 1);
    return entry;
  }
  for (std::size_t i = 0; i < 2; ++i)
    entry.of[i] = items[i].json().is_string() ? refer(items[i]) : add_color(items[i].vec3());
  return entry;
}

std::string TextureLibrary::add_color(const dvec3& color) {
  Entry entry;
  entry.texture.offset = glm::dvec4(color, 1);
  entry.made = true;
  const std::string name = fmt::format("\x01{}", entries_.size());  // cannot occur in a scene file
  entries_.emplace(name, entry);
  return name;
}

TextureLibrary::Entry TextureLibrary::read_ramp(JsonObject& object) {
  Entry entry;
  entry.texture.kind = TEXTURE_RAMP;
  entry.of[0] = refer(object.at("of"));
  for (const JsonValue& item : object.at("stops").items("places and colours"))
    item.object("ramp_stop", [&](JsonObject& stop) {
      RampStop made;
      stop.read("at", made.at, "color", made.color);
      if (!entry.texture.stops.empty() && made.at < entry.texture.stops.back().at)
        stop.at("at").wanted(
            fmt::format("{} or more, the place of the stop before", entry.texture.stops.back().at));
      entry.texture.stops.push_back(made);
    });
  return entry;
}

TextureLibrary::Entry TextureLibrary::read_product(JsonObject& object) {
  Entry entry;
  entry.texture.kind = TEXTURE_PRODUCT;
  const auto items = object.at("of").items("names of textures");
  for (std::size_t i = 0; i < 2; ++i) entry.of[i] = refer(items[i]);
  return entry;
}

static int read_channel(JsonObject& object) {
  enum class Channel { red, green, blue, alpha, all } channel{};
  object.read("channel", channel);
  return channel == Channel::all ? -1 : static_cast<int>(channel);
}

TextureLibrary::Entry TextureLibrary::read_vertex_color(JsonObject& object) {
  Entry entry;
  entry.texture.kind = TEXTURE_VERTEX_COLOR;
  entry.texture.channel = read_channel(object);
  return entry;
}

TextureLibrary::Entry TextureLibrary::read_image_texture(JsonObject& object) const {
  Entry entry;
  TextureDescription& texture = entry.texture;
  texture.kind = TEXTURE_IMAGE;
  const JsonValue file = object.at("file");
  entry.file = find_file(file).string();
  entry.place = file.pointer();
  object.read("encoding", entry.encoding, "filter", texture.filter);
  read_wraps(object, texture);
  read_mapping(object, texture);
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
    // An encoding applies only to bytes; an EXR's use decides, because its colours always have primaries.
    const bool by_use = entry.encoding == ImageEncoding::automatic || !drops_alpha(entry.file);
    const bool srgb = by_use ? use == TextureUse::color : entry.encoding == ImageEncoding::srgb;
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
