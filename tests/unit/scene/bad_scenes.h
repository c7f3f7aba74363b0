// Scene files that are refused, in tables.
#pragma once
#include <string>
#include <vector>

namespace bad_scenes {

/// A bad scene, the place that its error names, and words that the error says. `schema` is false where the
/// fault is beyond a JSON Schema: a name that leads nowhere, one number against another.
struct Bad {
  std::string text, place;
  std::vector<std::string> words;
  bool schema = true;
};

void check(const std::vector<Bad>& table);

/// A scene of that object; `place` counts from it.
Bad object(const std::string& text, const std::string& place, std::vector<std::string> words,
           bool schema = true);
/// A sphere with these members besides.
Bad sphere(const std::string& members, const std::string& place, std::vector<std::string> words,
           bool schema = true);

}  // namespace bad_scenes
