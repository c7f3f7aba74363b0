// `sundog mix FILE.exr --light NAME=FACTOR,#COLOUR... -o OUT`: rebalances a picture's light groups.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <memory>

#include "app/options/command.h"
#include "app/options/light_balance.h"
#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "app/options/picture_options.h"
#include "app/process/standard_streams.h"
#include "app/render/output_files.h"
#include "base/error.h"
#include "base/names.h"
#include "render/film/group_names.h"

namespace sundog {
namespace {

struct MixCommand : PictureOptions {
  std::string picture;
  std::vector<std::string> lights;  // as typed
};

constexpr std::string_view prefix = "light_";

/// The factor of each of the picture's groups; 1 unless typed.
std::map<std::string, glm::vec3> factors_of(const MixCommand& command, const AovImages& aovs) {
  std::map<std::string, glm::vec3> factors;
  for (const auto& [name, image] : aovs)
    if (is_light_group(name)) factors.emplace(name.substr(prefix.size()), 1);
  if (factors.empty())
    throw UsageError(
        fmt::format("{}: has no light groups: render it with --aov {}", command.picture, light_groups_aov));
  std::vector<std::string> known;
  for (const auto& [name, factor] : factors) known.push_back(name);
  for (const std::string& typed : command.lights) {
    const auto [name, factor] = parse_light(typed);
    const auto found = factors.find(name);
    if (found == factors.end())
      throw UsageError(fmt::format(
          "--light {}: {}", typed,
          did_you_mean(name, known, fmt::format("the picture has {}", fmt::join(known, ", ")), "")));
    found->second = factor;
  }
  return factors;
}

/// The sum of the groups' light, each times its factor; with 4 channels, includes the alpha of `image`.
Image sum_of(const std::map<std::string, glm::vec3>& factors, const AovImages& aovs, const Image& image,
             int channel_count) {
  Image sum(image.width, image.height, channel_count);
  const auto channels = static_cast<std::size_t>(channel_count);
  const std::size_t pixels = sum.data.size() / channels;
  for (const auto& [group, factor] : factors) {
    const Image& light = aovs.at(std::string(prefix) + group);
    for (std::size_t i = 0; i < pixels; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        sum.data[i * channels + c] += factor[static_cast<int>(c)] * light.data[3 * i + c];
  }
  for (std::size_t i = 0; channels == 4 && i < pixels; ++i) sum.data[4 * i + 3] = image.data[4 * i + 3];
  return sum;
}

double total(const Image& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.data.size(); ++i)
    if (i % static_cast<std::size_t>(image.channels) < 3) sum += double(image.data[i]);
  return sum;
}

/// Throws UsageError unless the groups add up to the image: one may be missing, or the colour space another.
void check_sum(const MixCommand& command, const AovImages& aovs, const Image& image) {
  std::map<std::string, glm::vec3> whole;
  for (const auto& [name, light] : aovs)
    if (is_light_group(name)) whole.emplace(name.substr(prefix.size()), 1);
  const double all = total(image), sum = total(sum_of(whole, aovs, image, 3));
  if (!(std::abs(all - sum) <= 0.02 * std::abs(all)))
    throw UsageError(fmt::format(
        "{}: is not the sum of its light groups: render it with --aov {} and the colour space srgb",
        command.picture, light_groups_aov));
}

int mix(const MixCommand& command) {
  check_output_files({command.out}, {command.picture});
  const ToneMap tone_map = parse_tone_map(command);
  check_picture(command, false);
  const Image rendered = read_image(command.picture);
  const AovImages aovs = read_aovs(command.picture);
  const auto factors = factors_of(command, aovs);
  const std::string name = format_name(command);
  check_sum(command, aovs, rendered);
  const Image image =
      shown_in(name, sum_of(factors, aovs, rendered, image_channels(name, command.transparent)), tone_map,
               dithers(command));
  write_output(command.out, encode_image(image, name, {}, file_options(command)), nullptr);
  warn_of_halves(name, image, file_options(command));
  return exit_done;
}

}  // namespace

void add_mix(Arguments& root, Command& chosen) {
  const auto command = std::make_shared<MixCommand>();
  Arguments* app = root.add_subcommand("mix", "Balance the light groups of a rendered picture anew");
  value(app, "FILE", "FILE", command->picture, "an .exr that render --aov light_groups has written")
      ->required();
  values(app, "--light", "NAME=FACTOR,#RRGGBB", command->lights,
         "a group, what its light is multiplied by, and a colour of a web page that tints it; either may be "
         "left out");
  add_picture(app, *command);
  app->add_flag("--transparent", command->transparent, "keep alpha in a .png");
  app->callback([command, &chosen] {
    check_format(*command);
    chosen = {.run = [command] { return mix(*command); }, .in_first_thread = true};
  });
}

}  // namespace sundog
