// The names of a struct's members, taken from the compiler's text for pointers to them.
#pragma once
#include <array>
#include <boost/pfr.hpp>
#include <string_view>
#include <utility>

namespace sundog {
namespace member_names_detail {

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

#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wundefined-var-template"
#endif
template <class T, std::size_t... I>
consteval std::array<std::string_view, sizeof...(I)> all_names(std::index_sequence<I...>) {
  return {name_of_member<Pointer{&boost::pfr::get<I>(unmade<T>.held)}>()...};
}
#if defined(__clang__)
#pragma clang diagnostic pop
#endif

}  // namespace member_names_detail

/// The names of T's members, in order. T is an aggregate without base classes.
template <class T>
inline constexpr auto member_names =
    member_names_detail::all_names<T>(std::make_index_sequence<boost::pfr::tuple_size_v<T>>());

}  // namespace sundog
