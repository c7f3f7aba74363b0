// Tables of enumeration values and their names in files and options, independent of the enumeration's order.
#pragma once
#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace sundog {

template <class Value>
struct NamedValue {
  std::string_view name;
  Value value;
};

/// The names in table order. Rows may be of any type with a `name`.
template <class Row, std::size_t N>
constexpr std::array<std::string_view, N> names_of(const std::array<Row, N>& table) {
  std::array<std::string_view, N> names{};
  std::ranges::transform(table, names.begin(), &Row::name);
  return names;
}

template <class Row>
std::vector<std::string> names_of(const std::vector<Row>& rows) {
  std::vector<std::string> names;
  for (const Row& row : rows) names.push_back(row.name);
  return names;
}

/// The name of a value. Throws std::logic_error if it is missing.
template <class Value, std::size_t N>
constexpr std::string_view name_of_value(const std::array<NamedValue<Value>, N>& table, Value value) {
  const auto row = std::ranges::find(table, value, &NamedValue<Value>::value);
  if (row == table.end()) throw std::logic_error("a value without a name");
  return row->name;
}

}  // namespace sundog
