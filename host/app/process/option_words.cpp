// See option_words.h. A test holds that each phrase stands in a source below `app`, and no option's name
// does.
#include "app/process/option_words.h"

#include <string_view>

namespace sundog {
namespace {

struct Phrase {
  std::string_view below, here;
};

constexpr Phrase phrases[] = {
    {"the setting ", "--set "},
    {"the device spec ", "--device "},
    {"several are chosen by several specs; ",
     "several are chosen by several --device (commas are for SUNDOG_DEVICE); "},
    {"the fixed split ", "--split "},
    {"leave the part out", "leave --tiles out"},
    {"choose another device,", "choose another device (--device),"},
    {"allow files outside of it", "give --allow-outside-files"},
    {"allow native code", "allow it with --allow-native-code"},
    {"an .exr name or no AOV", "an .exr name or no --aov"},
    {" as part ", " with --tiles "},
    {"a render of one part writes them", "`sundog render --tiles` writes them"},
    {"the folder of kernel texts", "SUNDOG_DUMP_KERNELS"},
    {"the folder of kernel files", "SUNDOG_KERNEL_DIR"},
    {"the folder of build logs", "SUNDOG_BUILD_LOG"},
    {"the build options '", "SUNDOG_BUILD_OPTIONS '"},
    {"faults on demand: ", "SUNDOG_FAULTS: "},
    {"as tunings are exported", "as `sundog tune --export` writes it"},
};

}  // namespace

std::string with_option_names(std::string message) {
  for (const auto& [below, here] : phrases)
    for (std::size_t at = message.find(below); at != std::string::npos;
         at = message.find(below, at + here.size()))
      message.replace(at, below.size(), here);
  return message;
}

}  // namespace sundog
