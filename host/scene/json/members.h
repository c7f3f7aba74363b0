// Reads the keys of a JSON object that have the names of a struct's members, so that a plain key of a scene
// is written twice only: as a member, and with its limits, default and description in
// scenes/scene.schema.json.
#pragma once
#include <boost/pfr.hpp>
#include <initializer_list>

#include "base/code_names.h"
#include "scene/json/value.h"

namespace sundog {

/// Types that JsonValue::get() reads.
template <class T>
inline constexpr bool reads_plainly =
    std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, std::string>;
template <class T>
inline constexpr bool reads_plainly<std::optional<T>> = reads_plainly<T>;
template <glm::length_t N>
inline constexpr bool reads_plainly<glm::vec<N, double>> = true;

/// Reads each plain member of `to` that the schema knows as a key of this object, except those in `special`,
/// which the caller reads.
template <class T>
void read_members(JsonObject& object, T& to, std::initializer_list<std::string_view> special = {}) {
  boost::pfr::for_each_field(to, [&]<class M>(M& member, std::size_t index) {
    if constexpr (reads_plainly<M>) {
      const std::string_view key = member_names<T>[index];
      if (object.knows(key) && std::ranges::find(special, key) == special.end()) object.read(key, member);
    }
  });
}

}  // namespace sundog
