// Numbers groups by their place in the scene's list (0: the rest), expands the AOV of all groups, and refuses
// parts of light beside groups.
#include "render/film/group_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "base/names.h"
#include "render/film/film.h"

namespace sundog {
namespace {

constexpr std::string_view prefix = "light_";

std::string numbered(const std::string& aov, std::size_t number) { return fmt::format("{}@{}", aov, number); }

void add(std::vector<std::string>& all, const std::string& aov) {
  if (std::ranges::count(all, aov) == 0) all.push_back(aov);
}

}  // namespace

bool is_light_group(const std::string& aov) { return aov.starts_with(prefix) && aov != "light_parts"; }

bool is_aov(const std::string& name) {
  return std::ranges::count(aov_names(), name) > 0 || (is_light_group(name) && name.find('@') != name.npos);
}

void check_aov(const std::string& name, const std::string& option) {
  if (is_aov(name)) return;
  const std::string list = fmt::format("wanted one of {}", fmt::join(aov_names(), ", "));
  throw UsageError(fmt::format("{}{}: {}", option, name, did_you_mean(name, aov_names(), list, "")));
}

std::size_t number_of_group(const std::string& aov) {
  const std::size_t at = aov.rfind('@');
  if (at == std::string::npos || at + 2 != aov.size()) return 0;
  const auto number = static_cast<std::size_t>(aov.back() - '0');
  return number < LIGHT_PART_COUNT ? number : 0;
}

std::vector<std::string> with_group_numbers(const std::vector<std::string>& aovs,
                                            std::span<const std::string> groups) {
  std::vector<std::string> all;
  bool of_groups = false, of_parts = false;
  for (const std::string& aov : aovs) {
    of_groups |= is_light_group(aov);
    of_parts |= is_light(aov) && !is_light_group(aov);
    const auto group =
        std::ranges::find_if(groups, [&](const auto& name) { return prefix.data() + name == aov; });
    if (!is_light_group(aov)) {
      add(all, aov);
    } else if (aov == light_groups_aov) {
      add(all, numbered(rest_aov, 0));
      for (std::size_t i = 0; i < groups.size(); ++i) add(all, numbered(prefix.data() + groups[i], i + 1));
    } else if (aov == rest_aov || group != groups.end()) {
      add(all, numbered(aov, aov == rest_aov ? 0 : static_cast<std::size_t>(group - groups.begin()) + 1));
    } else {
      throw UsageError(fmt::format(
          "the AOV {}: no light of the scene is in the group {}: it has {}", aov, aov.substr(prefix.size()),
          groups.empty() ? "no groups" : fmt::format("{}", fmt::join(groups, ", "))));
    }
  }
  if (of_groups && of_parts)
    throw UsageError(
        "AOVs of light groups and of parts of light take the same place: render one, then the other");
  return all;
}

AovImages without_group_numbers(AovImages aovs) {
  AovImages all;
  for (auto& [name, image] : aovs)
    all.emplace(is_light_group(name) ? name.substr(0, name.rfind('@')) : name, std::move(image));
  return all;
}

}  // namespace sundog
