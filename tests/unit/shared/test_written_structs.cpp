// A rule of kernels/README.md that no compiler checks: functions write to no struct that they are given by
// value.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "base/file.h"
#include "catch.h"

namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

struct Function {
  std::string name, parameters, body;
};

/// Code without comments and preprocessor lines.
std::string plain_code(const std::string& text) {
  const std::string uncommented = std::regex_replace(text, std::regex(R"(//[^\n]*)"), "");
  return std::regex_replace(uncommented, std::regex(R"((^|\n)[ \t]*#([^\n]*\\\n)*[^\n]*)"), "$1");
}

Names structs_in(const std::string& code) {
  const std::regex pattern(R"(typedef struct (\w+))");
  Names names;
  for (std::sregex_iterator it(code.begin(), code.end(), pattern), end; it != end; ++it)
    names.insert((*it)[1]);
  return names;
}

/// The place of the bracket that closes the one at `from`.
std::size_t closing(const std::string& code, std::size_t from, char open, char close) {
  int depth = 0;
  for (std::size_t i = from; i < code.size(); ++i) {
    if (code[i] == open) ++depth;
    if (code[i] == close && --depth == 0) return i;
  }
  return code.size();
}

std::vector<Function> functions_in(const std::string& code) {
  const std::regex head(R"((\w+)\(([^(){};]*)\)\s*\{)");
  std::vector<Function> functions;
  std::smatch match;
  for (std::size_t at = 0;
       std::regex_search(code.begin() + static_cast<std::ptrdiff_t>(at), code.end(), match, head);) {
    const std::size_t brace = at + static_cast<std::size_t>(match.position() + match.length()) - 1;
    const std::size_t end = closing(code, brace, '{', '}');
    functions.push_back({match[1], match[2], code.substr(brace, end - brace)});
    at = std::min(end, code.size());
  }
  return functions;
}

struct Parameter {
  std::string type, name;
};

/// The parameters of `function` that are structs of `structs` by value.
std::vector<Parameter> by_value(const Function& function, const Names& structs) {
  const std::regex pattern(R"((?:^|,)\s*(?:const\s+)?(\w+)\s+(\w+)\s*(?=,|$))");
  std::vector<Parameter> found;
  const std::string& text = function.parameters;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it)
    if (structs.contains((*it)[1])) found.push_back({(*it)[1], (*it)[2]});
  return found;
}

/// The parameters of all the project's functions of a name.
using Signatures = std::map<std::string, std::string>;

void add_signatures(const std::string& code, Signatures& known) {
  for (const Function& function : functions_in(code)) known[function.name] += function.parameters + ",";
}

/// The function in whose call the place `at` lies; nothing outside of calls.
std::string called_at(const std::string& body, std::size_t at) {
  int depth = 0;
  for (std::size_t i = at; i-- > 0;) {
    if (body[i] == ')') ++depth;
    if (body[i] != '(' || depth-- > 0) continue;
    std::size_t from = i;
    while (from > 0 && (std::isalnum(static_cast<unsigned char>(body[from - 1])) || body[from - 1] == '_'))
      --from;
    return body.substr(from, i - from);
  }
  return "";
}

/// Whether `body` hands the address of `of` to a function that may write there.
bool hands_on(const std::string& body, const Parameter& of, const Signatures& known) {
  const std::regex address("&" + of.name + R"(\b)"), writable(R"((?:^|,)\s*)" + of.type + R"(\s*\*)");
  for (std::sregex_iterator it(body.begin(), body.end(), address), end; it != end; ++it) {
    const auto callee = known.find(called_at(body, static_cast<std::size_t>(it->position())));
    if (callee == known.end() || std::regex_search(callee->second, writable)) return true;
  }
  return false;
}

/// Whether `body` assigns to the struct `name` or to part of it.
bool assigns(const std::string& body, const std::string& name) {
  const std::string before = R"((?:^|[^\w.>]))", part = R"((?:\.\w+|\[[^\]]*\])*)",
                    assigned = R"(\s*(?:[-+*/%|&^]|<<|>>)?=(?!=))";
  return std::regex_search(body, std::regex(before + name + part + assigned)) ||
         std::regex_search(body, std::regex(before + name + part + R"(\s*(?:\+\+|--))")) ||
         std::regex_search(body, std::regex(R"(_LANE\()" + name + part + R"(,[^;{}]*?\))" + assigned));
}

/// "function: parameter" for each struct that a function of `code` is given by value and writes to.
std::vector<std::string> written_copies(const std::string& code, const Names& structs,
                                        const Signatures& known) {
  std::vector<std::string> found;
  for (const Function& function : functions_in(code))
    for (const Parameter& parameter : by_value(function, structs))
      if (assigns(function.body, parameter.name) || hands_on(function.body, parameter, known))
        found.push_back(function.name + ": " + parameter.name);
  return found;
}

std::vector<std::string> kernel_files() {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(SUNDOG_SOURCE_DIR) / "kernels")) {
    const auto extension = entry.path().extension();
    if (extension == ".cl" || extension == ".h") files.push_back(entry.path().string());
  }
  return files;
}

std::string code_of(const std::string& path) { return plain_code(sundog::read_file(path)); }

}  // namespace

TEST_CASE("kernel functions do not write to structs that they are given by value") {
  Names structs;
  Signatures known;
  for (const std::string& path : kernel_files()) {
    const std::string code = code_of(path);
    for (const std::string& name : structs_in(code))
      structs.insert({name, name + "s"});  // a path's, in lanes
    add_signatures(code, known);
  }
  REQUIRE(structs.contains("REAL3"));
  REQUIRE(structs.contains("Bsdfs"));
  for (const std::string& path : kernel_files()) {
    INFO(path);
    CHECK(written_copies(code_of(path), structs, known) == std::vector<std::string>{});
  }
  CHECK(known.size() > 500);
}

TEST_CASE("a write to a struct given by value is noticed in each of its forms") {
  const Names structs{"Ray", "REAL3"};
  const Signatures known{{"set3", "REAL3* a, u32 i, float3 v,"}, {"get3", "const REAL3* a, u32 i,"}};
  const auto found = [&](const std::string& body) {
    return !written_copies(
                plain_code("static REAL f(u32 i, const Ray* far, Ray ray, REAL3 p) {\n" + body + "\n}\n"),
                structs, known)
                .empty();
  };
  for (const std::string body : {"ray = *far;", "ray.t = 0.0f;", "ray.o.x += 1.0f;", "  p.x *= p.y;",
                                 "REAL_LANE(p.x, i) = 1.0f;", "set3(&p, i, q);", "ray.hits[i]++;",
                                 "#if A\n  ray.t = 0;\n#endif", "if (x) ray.t = 1;", "ray.bits <<= 1;"}) {
    INFO(body);
    CHECK(found(body));
  }
  for (const std::string body :
       {"return ray.t == p.x;", "far->t = ray.t;", "q = get3(&p, i);", "other.ray = 1;",
        "MASK m = REAL_LANE(p.x, i) == 1.0f;", "// ray.t = 0;", "lanes & p.x;"}) {
    INFO(body);
    CHECK_FALSE(found(body));
  }
}
