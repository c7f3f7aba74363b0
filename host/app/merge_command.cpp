// `sundog merge PART... -o OUT`: the image from the parts that `render --tiles i/N` wrote.
#include <fmt/format.h>

#include <algorithm>

#include "app/commands.h"
#include "app/output_files.h"
#include "app/save_image.h"
#include "base/error.h"
#include "base/file.h"
#include "render/part.h"

namespace sundog {

int merge_command(const MergeCommand& command) {
  if (command.full_floats && drops_alpha(command.out))
    throw UsageError(fmt::format("{}: --float is for .exr files", command.out));
  check_image_path(command.out, false);
  check_output_files({command.out}, command.parts);
  check_writable(command.out);
  const PartFile whole = merge_parts({command.parts.begin(), command.parts.end()});
  check_image_path(command.out, !whole.aovs.empty());
  const Image image = whole.film.develop();
  AovImages aovs;
  for (const std::string& name : whole.aovs) aovs[name] = whole.film.develop_aov(name);
  save_image({image, aovs, whole.film, whole.key, {}, command.full_floats}, command.out);
  fmt::print("{}: {}x{} from {} parts\n", command.out, image.width, image.height, command.parts.size());
  return exit_done;
}

}  // namespace sundog
