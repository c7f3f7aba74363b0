// The command line's own words: what the layers below say in general, it says with the names of its options.
#pragma once
#include <string>

namespace sundog {

/// The message with an option's name in place of each phrase that stands for one.
std::string with_option_names(std::string message);

}  // namespace sundog
