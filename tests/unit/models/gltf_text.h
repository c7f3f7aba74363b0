// Small glTF files for tests, as text.
#pragma once
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <string_view>

/// Appends the values' bytes.
template <class Value>
void put(std::string& bytes, std::initializer_list<Value> values) {
  for (const Value value : values) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof raw);
    bytes.append(raw, sizeof raw);
  }
}

std::string base64(std::string_view bytes);

/// A quad in z = 0 of size 2, split along 0-2: indices 0 1 2 0 2 3 as bytes, then positions, then colours.
std::string quad_bytes();
/// Its buffer views and accessors: indices, positions, colours.
extern const std::string quad_views;
/// Its buffer, as a data URI.
std::string quad_buffer();

std::string document(const std::string& members);

/// A document with the quad as mesh 0, and `members` beside it.
std::string quad(const std::string& members, const std::string& primitive = "");

/// The quad's node, for quad().
extern const std::string one_node;

std::string glb(std::string json, std::string binary);
