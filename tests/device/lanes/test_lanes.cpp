// Plain kernels in lanes give the bits of one path: random programs, 4, 8 and 16 lanes and one, on every
// device.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "catch.h"
#include "devices.h"
#include "random_program.h"

using namespace sundog;

namespace {

constexpr u32 paths = 512;

/// Defines that compile plain text for one path, without the translator.
const char* const one_path = R"(
#define UNIFORM
#define ENTRY
#define EACH_ALIKE(type, name, value) for (type name = (value), name##_once = 1; name##_once; name##_once = 0)
)";

/// A kernel that calls all the functions; 0 lanes: the text as it is.
std::string kernel_of(const std::string& program, int functions, int lanes) {
  std::string text = "#include \"lib/core/lanes.h\"\n";
  text += lanes == 0 ? one_path + program : "#include \"plain/random.cl\"\n";
  text +=
      "__kernel void run(__global const float* x, __global const float* y, __global const float* k,\n"
      "                  __global const float* q, __global float* out) {\n";
  const int wide = std::max(lanes, 1);
  text += fmt::format("  const uint i = get_global_id(0) * {};\n", wide);
  const bool one = lanes == 0;
  text += fmt::format("  const {0} a = {1}x[i]{2}, b = {1}y[i]{2};\n", one ? "float" : "REAL",
                      one ? "" : "load_lanes(&", one ? "" : ")");
  text += one ? "  const int c = as_int(k[i]);\n" : "  const MASK c = AS_MASK(load_lanes(&k[i]));\n";
  for (int f = 0; f < functions; ++f) {
    const std::string call = fmt::format("f{}(a, b, c, 3, q, &o{})", f, one ? "" : ", ALL_LANES");
    text += fmt::format("  {{\n    {0} o = b;\n    const {0} v = {1};\n", one ? "float" : "REAL", call);
    const std::string first = fmt::format("out + {} + i", 2 * f * static_cast<int>(paths)),
                      second = fmt::format("out + {} + i", (2 * f + 1) * static_cast<int>(paths));
    text += lanes <= 1 ? fmt::format("    *({}) = v;\n    *({}) = o;\n  }}\n", first, second)
                       : fmt::format("    vstore{0}(v, 0, {1});\n    vstore{0}(o, 0, {2});\n  }}\n", lanes,
                                     first, second);
  }
  return text + "}\n";
}

std::vector<float> inputs(unsigned seed, float low, float high) {
  std::vector<float> all;
  for (u32 i = 0; i < paths; ++i) {
    const u32 mixed = (i + 1) * 2654435761u ^ (seed + 1) * 2246822519u;
    all.push_back(low + (high - low) * static_cast<float>((mixed >> 8) & 0xFFFF) / 65536.0f);
  }
  return all;
}

std::vector<float> run(Device& device, const std::string& program, unsigned seed, int functions, int lanes) {
  KernelDefines defines;
  if (lanes > 0) defines["LANES"] = std::to_string(lanes);
  const GeneratedFiles files{{"plain/random.cl", program}, {"run.cl", kernel_of(program, functions, lanes)}};
  using In = Buffer<float>;
  auto kernel = device.build("run.cl", defines, nullptr, files).kernel<In, In, In, In, In>("run");
  std::vector<float> wholes = inputs(seed + 2, -3, 9);
  for (u32 i = 0; i < paths; ++i)
    wholes[i] = std::bit_cast<float>(i % 37 == 0 ? 1000000000 : static_cast<int>(std::floor(wholes[i])));
  const auto x = device.upload<float>(inputs(seed, -2, 2)), y = device.upload<float>(inputs(seed + 1, -2, 2)),
             k = device.upload<float>(wholes), q = device.upload<float>(inputs(seed + 3, -1.5f, 1.5f)),
             out = device.make<float>(2ul * paths * static_cast<std::size_t>(functions));
  device.run(kernel, {.x = paths / static_cast<u32>(std::max(lanes, 1)), .local_x = 16}, x, y, k, q, out);
  std::vector<float> result(out.count);
  device.read(out, std::span<float>(result));
  return result;
}

/// Bodies that random programs seldom hold, from a review of the translator.
const std::vector<std::string> rare{
    R"(EACH_ALIKE(int, j, k & 3) { return q[j]; } return 0.0f;)",
    R"(float r = 0.0f; if (x > 0.0f) return r; r = 5.0f; return r;)",
    R"(float i = 0.0f; while (i < 9.0f) { if (x < i) return i; i += 1.0f; } return i;)",
    R"(float c = 0.0f; for (int i = 0; i < 5; ++i) { c += 1.0f; if (x > 0.0f) continue; if (i == n) break; c += 10.0f; } return c;)",
    R"(float t = 7.0f; return hit(x, &t) ? t : -t;)",
    R"(int j = 3; bool b = x > 0.0f && next(&j); return b ? (float)j : (float)j + 0.5f;)",
    R"(float a[4] = {x, y, 1.0f, 2.0f}; ++a[k & 3]; if (y > 0.0f) a[k & 3]--; return a[0] + 2.0f * a[1] + a[2] * a[3];)",
    R"(return chosen(x, n > 2) + halves(y, o) * (float)(-(-n));)",
    R"(int d = (k & 3) != 0 ? 100 / (k & 3) : 7; if (k % 5 != 0 && d / (k % 5) > 2) d = 1; return (float)d;)",
    R"(float c = 0.0f; for (int i = 0; i < 5; ++i) { if (x < (float)i - 1.0f) break; c += 1.0f; } return c;)",
    R"(float c = 0.0f, s = 0.0f; for (int j = 0; j < 2; ++j) for (int i = 0; i < 4; ++i) { if (x < (float)i - 1.0f) break; c += 1.0f; s += c; } return s;)",
    R"(float c = 0.0f; for (int i = 0; i < 6; ++i) { if (y > 1.0f) continue; if (x < 0.0f && i == 1) return c; c += 1.0f; *o += c; } return -c;)",
    R"(if (x > 0.0f) { EACH_ALIKE(int, j, k & 3) { if (j > 1) return q[j]; } *o += 1.0f; } return 0.0f;)",
    R"(if (x > -1.0f) { for (int i = 0; i < 4; ++i) if (y < (float)i - 1.0f) return y; *o += 1.0f; } return 2.0f;)",
    R"(if (x > 0.0f) { if (y > 0.0f) return 1.0f; *o += 1.0f; } return 2.0f;)",
    R"(float t = 1.0f; do { t += 1.0f; } while (t < x); return t;)",
    R"(int j = 0; if (x > 0.0f) j++; if (y > 0.5f) --j; return (float)j + side(x);)",
    R"(const bool b = !(x > 0.0f); return (float)b + (float)(y > 0.0f) * 4.0f + x - y * 2.0f - (b ? 1.0f : y);)",
    R"(float t = 0.0f; do { t += 1.0f; if (x > 0.5f) continue; t += 0.25f; } while (t < y + 2.0f); return t;)",
};
std::string rare_program() {
  std::string text = R"(
static inline bool hit(float x, float* t) { *t = x * 2.0f; return x > 0.0f; }
static inline float side(float x) { if (x > 0.0f) return 1.0f; return 2.0f; }
static inline bool next(int* j) { *j += 1; return *j > 3; }
static inline float chosen(float x, bool b) { if (x > 0.0f) b = false; return b ? 1.0f : 2.0f; }
static inline float halves(float x, float* o) { if (x > 0.0f) { *o += 0.5f; return x; } return *o; }
)";
  for (std::size_t i = 0; i < rare.size(); ++i)
    text += fmt::format(
        "ENTRY static inline float f{}(float x, float y, int k, UNIFORM int n, UNIFORM __global const float* "
        "q, "
        "float* o) {{ {} }}\n",
        i, rare[i]);
  return text;
}

bool same(float a, float b) {
  return std::bit_cast<u32>(a) == std::bit_cast<u32>(b) || (std::isnan(a) && std::isnan(b));
}

}  // namespace

TEST_CASE("plain programs, random ones too, give the same bits for one path and for any number of lanes") {
  // More of them once, after a change to the translator.
  const char* wanted = std::getenv("SUNDOG_LANES_SEEDS");
  const unsigned seeds = wanted ? static_cast<unsigned>(std::atoi(wanted)) : 2;
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const bool is_first = info.label() == test_devices().front().label();
    const int functions = is_first ? 4 : 2;  // some drivers compile them for a minute
    const auto compare = [&](const std::string& program, unsigned seed, int count) {
      const std::vector<float> expected = run(device, program, seed, count, 0);
      for (const int lanes : {1, 4, 8, 16}) {
        if (!is_first && lanes > 4) continue;
        const std::vector<float> found = run(device, program, seed, count, lanes);
        std::size_t wrong = 0;
        while (wrong < found.size() && same(found[wrong], expected[wrong])) ++wrong;
        INFO("seed " << seed << ", " << lanes << " lanes: the first wrong value is of f"
                     << wrong / (2 * paths) << ", path " << wrong % paths);
        CHECK(wrong == found.size());
      }
    };
    compare(rare_program(), 0, static_cast<int>(rare.size()));
    for (unsigned seed = 1; seed <= (is_first ? seeds : 1); ++seed)
      compare(random_program(seed, functions), seed, functions);
  });
}
