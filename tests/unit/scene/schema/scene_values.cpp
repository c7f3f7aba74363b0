// A description as text, by reflection: all members of all structs, in their order.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <boost/pfr.hpp>
#include <variant>

#include "scene_text.h"

using namespace sundog;

namespace {

template <class T>
concept Pointer = requires(const T& value) {
  *value;
  static_cast<bool>(value);
};

template <class T>
void write(std::string& out, const T& value) {
  if constexpr (std::is_convertible_v<const T&, std::string_view>) {
    fmt::format_to(std::back_inserter(out), "\"{}\" ", std::string_view(value));
  } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
    return;  // of temporary folders
  } else if constexpr (std::is_same_v<T, Image>) {
    write(out, value.data);
  } else if constexpr (std::is_enum_v<T>) {
    write(out, static_cast<int>(value));
  } else if constexpr (std::is_arithmetic_v<T>) {
    fmt::format_to(std::back_inserter(out), "{} ", value + T{});  // -0 as 0
  } else if constexpr (Pointer<T>) {
    out += value ? "some " : "none ";
    if (value) write(out, *value);
  } else if constexpr (requires { value.valueless_by_exception(); }) {
    write(out, value.index());
    std::visit([&](const auto& option) { write(out, option); }, value);
  } else if constexpr (requires { T::length(); }) {  // vectors and matrices
    for (int i = 0; i < T::length(); ++i) write(out, value[i]);
  } else if constexpr (requires { value.begin() != value.end(); }) {
    write(out, value.size());
    for (const auto& row : value) write(out, row);
  } else {
    boost::pfr::for_each_field(value, [&](const auto& member) { write(out, member); });
    out += '\n';
  }
}

}  // namespace

std::string all_values(const SceneDescription& scene) {
  std::string out;
  write(out, scene);
  return out;
}
