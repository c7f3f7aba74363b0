// Parses the values of options. Errors are UsageErrors that name the option, what was wanted and what was
// found.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/options/options.h"
#include "base/tone_map.h"
#include "render/render.h"
#include "scene/json/schema.h"

namespace sundog {

/// A whole number from `low` to `high`.
int parse_number(const char* option, const std::string& text, int low, int high);

/// The schema's limits for a number under `key` in a kind of object.
Range limits_of(const char* kind, const char* key);

/// A whole number as an override of the scene's render section, within the schema's limits of that key.
std::string render_setting(const char* option, const char* key, const std::string& text);

/// "64", "8x8", "auto" or "driver".
WorkGroup parse_work_group(const std::string& text, const char* option = "--work-group");

/// "i/N", i from 1 to N.
PartOfFrame parse_part(const std::string& text);

/// "X,Y,WxH": a rectangle of pixels, its upper left corner and its size.
Tile parse_region(const std::string& text);

/// "dynamic", "static", or shares such as "3,1".
Split parse_split(const std::string& text);

/// A number from `low` to `high`.
double parse_real(const char* option, const std::string& text, double low, double high);

/// A finite number, 0 or more.
double parse_tolerance(const std::string& text);

/// A number above 0 and at most `most`.
double parse_amount(const char* option, const std::string& text, double most = 1e9);

/// "WxH", each from 1 to the greatest edge, as overrides of a scene's image size.
std::vector<std::string> parse_image_size(const std::string& text);

/// The options for a picture's colours, as overrides of a scene.
std::vector<std::string> tone_map_overrides(const PictureOptions& picture);
/// The options for a picture's colours, for a picture without a scene.
ToneMap parse_tone_map(const PictureOptions& picture);

/// The AOVs that a frame renders: the requested ones, and those that the denoiser needs.
std::vector<std::string> made_aovs(const RenderCommand& command);

/// Throws UsageError unless the setting has the form JSON_POINTER=VALUE.
void check_override(const std::string& setting);

/// Quotes a word for a shell if necessary.
std::string shell_word(std::string_view word);

}  // namespace sundog
