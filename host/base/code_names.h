// The names that the code gives to a struct's members and to an enumeration's values, taken from the
// compiler's text for template arguments.
#pragma once
#include <algorithm>
#include <array>
#include <boost/pfr.hpp>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace sundog {
namespace code_names_detail {

template <class T>
struct Holder {
  T held;
};
/// Only pointers into it are formed; it is never defined.
template <class T>
extern const Holder<T> unmade;

/// A template argument by which a pointer appears in the text.
template <class M>
struct Pointer {
  const M* to;
};

/// GCC writes "...(& unmade<T>.Holder<T>::held.T::name)}...", Clang "...&unmade.held.name}...".
template <Pointer pointer>
consteval std::string_view name_of_member() {
  std::string_view text = __PRETTY_FUNCTION__;
  text = text.substr(text.find("unmade"));
  text = text.substr(0, text.find_first_of(")}"));
  return text.substr(text.find_last_of(".:") + 1);
}

/// The text ends in "...value = sundog::Filter::box..." or, for a number without a name, in "(...)7...".
template <auto value>
consteval std::string_view name_of_enumerator() {
  std::string_view text = __PRETTY_FUNCTION__;
  text = text.substr(text.find("value = ") + 8);
  text = text.substr(0, text.find_first_of(";]"));
  return text.starts_with('(') ? std::string_view() : text.substr(text.rfind(':') + 1);
}

#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wundefined-var-template"
#endif
template <class T, std::size_t... I>
consteval std::array<std::string_view, sizeof...(I)> members_of(std::index_sequence<I...>) {
  return {name_of_member<Pointer{&boost::pfr::get<I>(unmade<T>.held)}>()...};
}
#if defined(__clang__)
#pragma clang diagnostic pop
#endif

template <class E, std::size_t... I>
consteval std::array<std::string_view, sizeof...(I)> enumerators_of(std::index_sequence<I...>) {
  return {name_of_enumerator<static_cast<E>(I)>()...};
}

}  // namespace code_names_detail

/// The names of T's members, in order. T is an aggregate without base classes.
template <class T>
inline constexpr auto member_names =
    code_names_detail::members_of<T>(std::make_index_sequence<boost::pfr::tuple_size_v<T>>());

/// The names of E's enumerators 0 to 15, by value; empty where there is none.
template <class E>
inline constexpr auto enumerator_names = code_names_detail::enumerators_of<E>(std::make_index_sequence<16>());

/// The enumerator of that name; "auto", which C++ reserves, is E::automatic. Throws std::logic_error if there
/// is none.
template <class E>
E enumerator_named(std::string_view name) {
  const auto& names = enumerator_names<E>;
  auto found = std::ranges::find(names, name);
  if (found == names.end() && name == "auto") found = std::ranges::find(names, std::string_view("automatic"));
  if (found == names.end() || name.empty()) throw std::logic_error("no enumerator " + std::string(name));
  return static_cast<E>(found - names.begin());
}

}  // namespace sundog
