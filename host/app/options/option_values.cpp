// Parses numbers, sizes, splits and work-groups, and checks them against the schema's limits.
#include "app/options/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "app/options/picture_options.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/numbers.h"
#include "render/device/tuning.h"
#include "render/film/film.h"
#include "scene/json/value.h"
#include "scene/read/parts.h"

namespace sundog {
namespace {

using nlohmann::json;

template <class T>
std::optional<T> number(std::string_view text, T low, T high) {
  const auto value = whole_number<T>(text);
  return value && *value >= low && *value <= high ? value : std::nullopt;  // NaN is refused
}

/// Parses "WxH", each from 1 to most_edge; none for other text.
std::optional<std::pair<int, int>> number_pair(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return {};
  const std::optional<int> width = number(text.substr(0, cross), 1, most_edge);
  const std::optional<int> height = number(text.substr(cross + 1), 1, most_edge);
  if (!width || !height) return {};
  return std::pair(*width, *height);
}

/// The options for a picture's colours that were given, as members of /image/tone_map.
json tone_values(const PictureOptions& picture) {
  json values = json::object();
  for (const ToneOption& one : tone_options) {
    const auto typed = picture.tone.find(one.key);
    if (typed == picture.tone.end() || typed->second.empty()) continue;
    const SchemaRule& rule = *schema_rule("tone_map")->keys.at(one.key).rule;
    const SchemaRule *words = rule.as(SchemaRule::Type::string), *numbers = rule.as(SchemaRule::Type::number);
    if (words && std::ranges::count(words->names, typed->second) > 0)
      values[one.key] = typed->second;
    else if (numbers)
      values[one.key] = parse_real(one.option, typed->second, numbers->range.low, numbers->range.high);
    else
      throw UsageError(
          fmt::format("{} {}: wanted one of {}", one.option, typed->second, fmt::join(words->names, ", ")));
  }
  return values;
}

}  // namespace

Range limits_of(const char* kind, const char* key) {
  return schema_rule(kind)->keys.at(key).rule->as(SchemaRule::Type::number)->range;
}

std::vector<std::string> tone_map_overrides(const PictureOptions& picture) {
  std::vector<std::string> all;
  const json values = tone_values(picture);
  for (const auto& [key, value] : values.items())
    all.push_back(fmt::format("/image/tone_map/{}={}", key, value.dump()));
  return all;
}

ToneMap parse_tone_map(const PictureOptions& picture) {
  const json values = tone_values(picture);
  const JsonContext context;
  return read_tone_map(JsonObject::section("image", "tone_map", values, context));
}

int parse_number(const char* option, const std::string& text, int low, int high) {
  const std::optional<int> value = number(text, low, high);
  if (!value)
    throw UsageError(fmt::format("{} {}: wanted a whole number from {} to {}", option, text, low, high));
  return *value;
}

std::string render_setting(const char* option, const char* key, const std::string& text) {
  const Range limits = limits_of("render", key);
  return fmt::format("/render/{}={}", key,
                     parse_number(option, text, static_cast<int>(limits.low), static_cast<int>(limits.high)));
}

WorkGroup parse_work_group(const std::string& text, const char* option) {
  if (const auto group = work_group_of(text)) return *group;
  throw UsageError(
      fmt::format("{} {}: wanted a size (64) or width x height (8x8), each from 1 to {}, auto or driver",
                  option, text, most_edge));
}

PartOfFrame parse_part(const std::string& text) {
  const std::size_t slash = text.find('/');
  const std::string_view all = text;
  if (slash != std::string::npos) {
    const std::optional<int> count = number(all.substr(slash + 1), 1, most_parts);
    const std::optional<int> index = number(all.substr(0, slash), 1, count.value_or(0));
    if (index) return {*index, *count};
  }
  throw UsageError(fmt::format("--tiles {}: wanted I/N, N parts from 1 to {} and I from 1 to N, such as 2/8",
                               text, most_parts));
}

Tile parse_region(const std::string& text) {
  const std::string_view all = text;
  const std::size_t first = text.find(','), second = text.find(',', first + 1);
  if (first != std::string::npos && second != std::string::npos) {
    const std::optional<int> x = number(all.substr(0, first), 0, most_edge),
                             y = number(all.substr(first + 1, second - first - 1), 0, most_edge);
    const auto size = number_pair(text.substr(second + 1));
    if (x && y && size) return {*x, *y, size->first, size->second};
  }
  throw UsageError(fmt::format(
      "--crop {}: wanted X,Y,WxH in pixels, the upper left corner and the size, such as 100,40,320x240",
      text));
}

Split parse_split(const std::string& text) {
  using enum Split::Kind;
  if (text == "dynamic") return {dynamic, {}};
  if (text == "static") return {fixed, {}};
  Split split{fixed, {}};
  double sum = 0;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::optional<double> share = number(std::string_view(text).substr(at, end - at), 0.0, 1e9);
    if (!share)
      throw UsageError(fmt::format("--split {}: wanted dynamic, static, or shares such as 3,1", text));
    split.shares.push_back(*share);
    sum += *share;
    at = end + 1;
  }
  if (sum <= 0) throw UsageError(fmt::format("--split {}: one share at least must be more than 0", text));
  return split;
}

double parse_real(const char* option, const std::string& text, double low, double high) {
  const std::optional<double> value = number(text, low, high);
  if (!value) throw UsageError(fmt::format("{} {}: wanted a number from {} to {}", option, text, low, high));
  return *value;
}

double parse_tolerance(const std::string& text) {
  const std::optional<double> value = number(text, 0.0, 1e300);
  if (!value) throw UsageError(fmt::format("--tolerance {}: wanted a number, 0 or more", text));
  return *value;
}

double parse_amount(const char* option, const std::string& text, double most) {
  const std::optional<double> value = number(text, 0.0, most);
  if (!value || !(*value > 0)) throw UsageError(fmt::format("{} {}: wanted a number above 0", option, text));
  return *value;
}

std::vector<std::string> parse_image_size(const std::string& text) {
  const auto size = number_pair(text);
  if (!size)
    throw UsageError(
        fmt::format("--size {}: wanted WIDTHxHEIGHT, each from 1 to {}, such as 640x480", text, most_edge));
  return {fmt::format("/image/width={}", size->first), fmt::format("/image/height={}", size->second)};
}

std::vector<std::string> made_aovs(const RenderCommand& command) {
  std::vector<std::string> aovs = command.aovs;
  if (command.denoise)
    for (const char* wanted : {feature_albedo, feature_normal})
      if (std::ranges::count(aovs, wanted) == 0) aovs.emplace_back(wanted);
  return aovs;
}

void check_override(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals < 2 || setting[0] != '/')
    throw UsageError(fmt::format("--set {}: wanted JSON_POINTER=VALUE, such as /camera/fov=30", setting));
}

std::string shell_word(std::string_view word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) return std::string(word);
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace sundog
