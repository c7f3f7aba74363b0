// Generates random plain programs: statements, expressions and calls by depth.
#include "random_program.h"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

namespace sundog {
namespace {

/// splitmix64: the same numbers everywhere.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 1) {}
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  double real() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  int below(int n) { return static_cast<int>(next() % static_cast<std::uint64_t>(n)); }
  template <class T>
  const T& one_of(const std::vector<T>& all) {
    return all[static_cast<std::size_t>(below(static_cast<int>(all.size())))];
  }

 private:
  std::uint64_t state_;
};

/// The type of a name in the text.
enum class Sort { real, whole, fixed, truth, vector, array, pair };  // fixed: counts, and is not set

class Generator {
 public:
  Generator(Numbers& numbers, std::vector<int> callees, int number)
      : r_(numbers), callees_(std::move(callees)), number_(number) {}

  std::string function() {
    names_ = {{"x", Sort::real}, {"y", Sort::real},  {"k", Sort::whole}, {"n", Sort::fixed},
              {"r", Sort::real}, {"a", Sort::array}, {"s", Sort::pair}};
    for (int i = 4 + r_.below(6); i > 0; --i) statement();
    std::string out = fmt::format(
        "ENTRY static inline float f{}(float x, float y, int k, UNIFORM int n, UNIFORM __global const float* "
        "q, float* "
        "o) {{\n  float r = x;\n  float a[4] = {{x, y, 1.0f, -0.5f}};\n  Pair s = pair_of(x, k);\n",
        number_);
    for (const std::string& line : lines_) out += line + "\n";
    return out + "  return r + a[1] + s.a + *o;\n}\n";
  }

 private:
  std::vector<std::string> named(std::initializer_list<Sort> sorts) const {
    std::vector<std::string> all;
    for (const auto& [name, sort] : names_)
      for (const Sort s : sorts)
        if (s == sort) all.push_back(name);
    return all;
  }
  std::string fresh() { return fmt::format("v{}", ++count_); }
  void put(const std::string& line) {
    lines_.push_back(std::string(2 * static_cast<std::size_t>(depth_ + 1), ' ') + line);
  }

  std::string real(int d = 0) {
    const double c = r_.real();
    const auto vectors = named({Sort::vector}), arrays = named({Sort::array}), pairs = named({Sort::pair});
    if (d > 2 || c < 0.3) {
      auto all = named({Sort::real});
      all.push_back(fmt::format("{:.3f}f", 4 * r_.real() - 2));
      all.push_back(fmt::format("q[{}]", r_.below(4)));
      const std::string one = r_.one_of(all);
      return one.starts_with('-') ? "(" + one + ")" : one;
    }
    if (c < 0.55)
      return fmt::format("({} {} {})", real(d + 1), std::string(1, "+-*"[r_.below(3)]), real(d + 1));
    if (c < 0.62) return fmt::format("fma({}, {}, {})", real(d + 1), real(d + 1), real(d + 1));
    if (c < 0.69) return fmt::format("({} ? {} : {})", truth(d + 1), real(d + 1), real(d + 1));
    if (c < 0.74) return fmt::format("(float)({})", whole(d + 1));
    if (c < 0.79) return fmt::format("q[({}) & 7]", whole(d + 1));
    if (c < 0.83) return fmt::format("fabs({})", real(d + 1));
    if (c < 0.87 && !pairs.empty()) return r_.one_of(pairs) + (r_.below(2) ? ".a" : ".v.y");
    if (c < 0.92 && !vectors.empty()) return r_.one_of(vectors) + "." + "xyz"[r_.below(3)];
    if (c < 0.96 && !arrays.empty()) return fmt::format("{}[({}) & 3]", r_.one_of(arrays), whole(d + 1));
    return fmt::format("clamp({}, -1.0f, 1.0f)", real(d + 1));
  }

  std::string whole(int d = 0) {
    const double c = r_.real();
    if (d > 2 || c < 0.5) {
      auto all = named({Sort::whole, Sort::fixed});
      all.push_back(std::to_string(r_.below(7)));
      return r_.one_of(all);
    }
    static const std::vector<std::string> signs{"+", "-", "*", "&", "^"};
    if (c < 0.75) return fmt::format("({} {} {})", whole(d + 1), r_.one_of(signs), whole(d + 1));
    if (c < 0.8) return fmt::format("({} / (({} & 7) + 1))", whole(d + 1), whole(d + 1));
    if (c < 0.85) return fmt::format("({} % (({} & 3) + 1))", whole(d + 1), whole(d + 1));
    // A divisor of zero, where nobody asks.
    if (c < 0.89) return fmt::format("((k & 3) != 0 ? {} / (k & 3) : {})", whole(d + 1), whole(d + 1));
    return fmt::format("({} ? {} : {})", truth(d + 1), whole(d + 1), whole(d + 1));
  }

  std::string truth(int d = 0) {
    const double c = r_.real();
    static const std::vector<std::string> orders{"<", ">", "<=", ">="}, equal{"<", "==", "!="};
    const auto truths = named({Sort::truth});
    if (c < 0.5) return fmt::format("{} {} {}", real(d + 1), r_.one_of(orders), real(d + 1));
    if (c < 0.7) return fmt::format("{} {} {}", whole(d + 1), r_.one_of(equal), whole(d + 1));
    if (c < 0.75)
      return fmt::format("(k >= 0 && k < 8 && q[k] > {})", real(d + 1));  // far outside in other lanes
    if (c < 0.85 && !truths.empty()) return r_.one_of(truths);
    if (d > 2) return "n > 2";
    if (c < 0.95) return fmt::format("({} {} {})", truth(d + 1), r_.below(2) ? "&&" : "||", truth(d + 1));
    return fmt::format("!({})", truth(d + 1));
  }

  std::string vector(int d = 0) {
    const double c = r_.real();
    if (d > 1 || c < 0.4) {
      auto all = named({Sort::vector});
      all.push_back("s.v");
      all.push_back(fmt::format("(float3)({}, {}, {})", real(d + 1), real(d + 1), real(d + 1)));
      return r_.one_of(all);
    }
    if (c < 0.7)
      return fmt::format("({} {} {})", vector(d + 1), std::string(1, "+-*"[r_.below(3)]), vector(d + 1));
    if (c < 0.9) return fmt::format("({} * {})", vector(d + 1), real(d + 1));
    return fmt::format("({} ? {} : {})", truth(d + 1), vector(d + 1), vector(d + 1));
  }

  void block(int most) {
    const auto keep = names_;
    ++depth_;
    for (int i = 1 + r_.below(most); i > 0; --i) statement();
    --depth_;
    names_ = keep;
  }

  void declare() {
    const std::string name = fresh();
    switch (r_.below(5)) {
      case 0:
        put(fmt::format("int {} = {};", name, whole()));
        names_.emplace_back(name, Sort::whole);
        return;
      case 1:
        put(fmt::format("bool {} = {};", name, truth()));
        names_.emplace_back(name, Sort::truth);
        return;
      case 2:
        put(fmt::format("float3 {} = {};", name, vector()));
        names_.emplace_back(name, Sort::vector);
        return;
      default:
        put(fmt::format("float {} = {};", name, real()));
        names_.emplace_back(name, Sort::real);
    }
  }

  void set() {
    std::vector<std::pair<std::string, Sort>> all;
    for (const auto& row : names_)
      if (row.second != Sort::fixed && row.first != "x" && row.first != "y") all.push_back(row);
    const auto [name, sort] = r_.one_of(all);
    static const std::vector<std::string> reals{"=", "+=", "*=", "-="}, wholes{"=", "+=", "^="},
        vectors{"=", "+=", "*="};
    switch (sort) {
      case Sort::real:
        return put(fmt::format("{} {} {};", name, r_.one_of(reals), real()));
      case Sort::whole:
        if (r_.real() < 0.3) return put((r_.below(2) ? "++" : "--") + name + ";");
        return put(fmt::format("{} {} {};", name, r_.one_of(wholes), whole()));
      case Sort::truth:
        return put(fmt::format("{} = {};", name, truth()));
      case Sort::vector:
        if (r_.real() < 0.4) return put(fmt::format("{}.{} = {};", name, "xyz"[r_.below(3)], real()));
        if (r_.real() < 0.2) return put(fmt::format("{} *= {};", name, real()));
        return put(fmt::format("{} {} {};", name, r_.one_of(vectors), vector()));
      case Sort::pair:
        if (r_.real() < 0.3) return put(fmt::format("{} = pair_of({}, {});", name, real(), whole()));
        if (r_.real() < 0.3) return put(fmt::format("move(&{}, {});", name, real()));
        return put(fmt::format("{}.{} = {};", name, r_.below(2) ? "a" : "v.z", real()));
      default:
        if (r_.below(2))
          return put(fmt::format("{}[{}] {} {};", name, r_.below(4), r_.below(2) ? "=" : "+=", real()));
        return put(fmt::format("{}[({}) & 3] {} {};", name, whole(), r_.below(2) ? "=" : "+=", real()));
    }
  }

  void loop() {
    const double c = r_.real();
    const std::string i = fresh();
    const auto keep = names_;
    ++loops_;
    const std::string bound = r_.below(3) == 0 ? "n" : r_.below(2) ? "3" : fmt::format("({} & 3)", whole());
    if (c < 0.4) {
      put(fmt::format("for (int {0} = 0; {0} < {1}; ++{0}) {{", i, bound));
      names_.emplace_back(i, Sort::fixed);
      block(4);
      put("}");
      names_ = keep;
    } else if (c < 0.65) {
      put(fmt::format("int {} = 0;", i));
      names_.emplace_back(i, Sort::fixed);
      put(fmt::format("while ({} < {} && !({})) {{", i, bound, truth()));
      put(fmt::format("  ++{};", i));
      block(4);
      put("}");
    } else if (c < 0.8) {
      put(fmt::format("int {} = 0;", i));
      names_.emplace_back(i, Sort::fixed);
      put("do {");
      put(fmt::format("  ++{};", i));
      block(3);
      put(fmt::format("}} while ({} < {});", i, bound));
    } else if (c < 0.9) {
      // In lanes that do not ask it would never end.
      put(fmt::format("int {} = k;", i));
      put(fmt::format("if (k > 0) while ({0} != 0) {{ {0} = {0} / 2; r += 1.0f; }}", i));
    } else {
      put(fmt::format("EACH_ALIKE(int, {}, ({}) & 3) {{", i, whole()));
      names_.emplace_back(i, Sort::fixed);
      const int loops = loops_;
      loops_ = 0;  // no way out of it but by return
      block(3);
      loops_ = loops;
      put("}");
      names_ = keep;
    }
    --loops_;
  }

  void statement() {
    const double c = r_.real();
    const bool deep = depth_ > 3;
    if (c < 0.2) return declare();
    if (c < 0.56) return set();
    if (c < 0.62 && !callees_.empty()) {
      const std::string name = fresh();
      put(fmt::format("float {} = f{}({}, {}, {}, n, q, o);", name, r_.one_of(callees_), real(), real(),
                      whole()));
      names_.emplace_back(name, Sort::real);
      return;
    }
    if (c < 0.78 && !deep) {
      put(fmt::format("if ({}) {{", truth()));
      block(3);
      if (r_.real() < 0.4) {
        put("} else {");
        block(3);
      }
      return put("}");
    }
    if (c < 0.88 && !deep && loops_ < 2) return loop();
    if (c < 0.94 && loops_ > 0)
      return put(fmt::format("if ({}) {};", truth(), r_.below(2) ? "break" : "continue"));
    if (c < 0.97) return put(fmt::format("if ({}) return {};", truth(), real()));
    put(fmt::format("*o = {};", real()));
  }

  Numbers& r_;
  std::vector<int> callees_;
  int number_, depth_ = 0, loops_ = 0, count_ = 0;
  std::vector<std::pair<std::string, Sort>> names_;
  std::vector<std::string> lines_;
};

}  // namespace

std::string random_program(unsigned seed, int count) {
  Numbers numbers(seed);
  std::string out = R"(typedef struct Pair {
  float a;
  float3 v;
  int k;
} Pair;
static inline Pair pair_of(float x, int k) {
  Pair s;
  s.a = x * 0.5f;
  s.v = (float3)(x, 1.0f, -x);
  s.k = k;
  if (k > 2) return s;
  s.v.z = 2.0f;
  return s;
}
static inline void move(Pair* s, float by) {
  if (by < 0.0f) return;
  s->v *= by;
  s->k += 1;
  s->a = s->k > 3 ? by : s->a;
}
)";
  for (int i = 0; i < count; ++i) {
    std::vector<int> callees;
    for (int k = std::max(0, i - 3); k < i && i % 4 != 0; ++k) callees.push_back(k);
    out += "\n" + Generator(numbers, callees, i).function();
  }
  return out;
}

}  // namespace sundog
