// `sundog merge PART... -o OUT`: joins the parts that `render --tiles I/N` wrote to an image.
#include <fmt/format.h>

#include <memory>

#include "app/options/command.h"
#include "app/options/option_values.h"
#include "app/options/picture_options.h"
#include "app/process/standard_streams.h"
#include "app/render/output_files.h"
#include "app/render/save_image.h"
#include "base/arguments.h"
#include "base/file.h"
#include "render/film/cryptomatte.h"
#include "render/film/group_names.h"
#include "render/film/motion.h"
#include "render/film/part.h"

namespace sundog {
namespace {

struct MergeCommand : PictureOptions {
  std::vector<std::string> parts;
};

int merge(const MergeCommand& command) {
  check_output_files({command.out}, command.parts);
  const ToneMap tone_map = parse_tone_map(command);
  check_picture(command, false);
  if (is_standard_stream(command.out)) claim_standard_output();
  remove_left_over(command.out);
  const PartFile whole = merge_parts({command.parts.begin(), command.parts.end()});
  const std::string name = format_name(command);
  check_image_path(name, !whole.aovs.empty());
  Image image = whole.film.develop(image_channels(name, command.transparent));
  const int width = image.width, height = image.height;
  AovImages aovs;
  for (const std::string& aov : whole.aovs) aovs[aov] = whole.film.develop_aov(aov);
  end_depth(command, aovs);
  find_motion(aovs, whole.shot);
  aovs = without_group_numbers(std::move(aovs));
  FileOptions file = file_options(command);
  file.texts = name_cryptomattes(aovs, whole.names);
  file.shot = whole.shot;
  save_image({.image = std::move(image),
              .aovs = aovs,
              .film = whole.film,
              .key = whole.key,
              .format = command.format,
              .file = file,
              .tone_map = tone_map,
              .dithered = dithers(command)},
             command.out);
  fmt::print("{}: {}x{} from {} parts\n", command.out, width, height, command.parts.size());
  return exit_done;
}

}  // namespace

void add_merge(Arguments& root, Command& chosen) {
  const auto command = std::make_shared<MergeCommand>();
  Arguments* app = root.add_subcommand("merge", "Join the parts that render --tiles has written");
  app->add_option("PART", command->parts, "files that render --tiles has written")
      ->required()
      ->type_name("FILE");
  add_picture(app, *command);
  app->add_flag("--transparent", command->transparent,
                "keep alpha in a .png, of parts that were so rendered");
  app->callback([command, &chosen] {
    check_format(*command);
    chosen = {.run = [command] { return merge(*command); }, .in_first_thread = true};
  });
}

}  // namespace sundog
