// Puts the schema's values into words, for docs/reference/scene-reference.md.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// "round box" for "round_box".
std::string spaced(std::string name);

/// A link to the section of a kind: "[round box](#round-box)".
std::string link_to(const std::string& kind);

/// True for a rule that says which keys an object has.
bool has_keys(const nlohmann::ordered_json& kind);

/// The rules of a schema in words.
class SchemaWords {
 public:
  /// `kinds`: the schema's "$defs", kept by reference.
  explicit SchemaWords(const nlohmann::ordered_json& kinds) : kinds_(kinds) {}

  /// "number, 0 to 1". Throws std::runtime_error for a type that has no words.
  std::string type(const nlohmann::ordered_json& rule) const;
  /// The choices of a rule that names them alone.
  std::vector<std::string> names(const nlohmann::ordered_json& rule) const;
  /// The rule that a "$ref" leads to.
  const nlohmann::ordered_json& target(const nlohmann::ordered_json& rule) const;
  /// The rule's description, or that of what it refers to; empty when there is none.
  std::string meaning(const nlohmann::ordered_json& rule) const;
  /// The default as code, empty when there is none.
  std::string default_value(const nlohmann::ordered_json& rule) const;

 private:
  std::string reference(const std::string& name) const;
  std::string options(const nlohmann::ordered_json& all) const;
  std::string array(const nlohmann::ordered_json& rule) const;

  const nlohmann::ordered_json& kinds_;
};
