// The translator's text for lanes: where masks stand, what is left to the preprocessor, and the explanation.
#include <set>
#include <sstream>

#include "catch.h"
#include "device/embedded_kernels.h"
#include "device/kernel_source.h"
#include "lanes/lanes.h"
#include "plain_text.h"

using plain_text::function;
using plain_text::in_lanes;
using sundog::spmd::Lanes;

TEST_CASE("what is one value for all lanes stays as it was written") {
  const std::string made =
      in_lanes(function("float s = 0.0f;\nfor (int i = 0; i < n; ++i) s += q[i];\nreturn s * x;"));
  CHECK_THAT(made, ContainsSubstring("float s = 0.0f;"));
  CHECK_THAT(made, ContainsSubstring("for (; (i < n); ++i) {"));
  CHECK_THAT(made, ContainsSubstring("s = (s + q[i]);"));
  CHECK_THAT(made, ContainsSubstring("return (s * x);"));
  CHECK_THAT(made, !ContainsSubstring("select"));
}

TEST_CASE("a variable that only lanes of a branch read is set without a mask") {
  const std::string made =
      in_lanes(function("if (x > 0.0f) {\n  float y = x;\n  y *= 2.0f;\n  *o = y;\n}\nreturn x;"));
  CHECK_THAT(made, ContainsSubstring("y = (y * 2.0f);"));
  CHECK_THAT(made, ContainsSubstring("(*o) = select((*o), y, m_2);"));
}

TEST_CASE("features are the preprocessor's") {
  const std::string made = in_lanes(function(
      "float y = x;\nif (HAS_MEDIA && x > 1.0f) y = 2.0f;\nif (HAS_FOG || !HAS_SKY) y = 3.0f;\nreturn y;"));
  CHECK_THAT(made, ContainsSubstring("#if HAS_MEDIA\n"));
  CHECK_THAT(made, ContainsSubstring("#if (HAS_FOG || !HAS_SKY)\n"));
  const std::string members = in_lanes("typedef struct P { float a; HAVING(HAS_FOG) float b; } P;\n" +
                                       function("P p; p.a = x; return p.a;"));
  CHECK_THAT(members, ContainsSubstring("#if HAS_FOG\n  REAL b;\n#endif"));
  const std::string rest = in_lanes("HAVING(HAS_FOG);\n" + function("return x;"));
  CHECK_THAT(rest, ContainsSubstring("#if HAS_FOG\nNEVER_INLINE REAL f("));
  CHECK_THAT(in_lanes("HAVING(HAS_FOG);\nHAVING(HAS_SKY)\n" + function("return x;")),
             ContainsSubstring("#if HAS_FOG && HAS_SKY\n"));
}

TEST_CASE("constants of headers keep their names, those of plain files are written out") {
  const std::string made = in_lanes("#include \"shared/scene.h\"\n#define HALF 0.5f\n" +
                                    function("return (float)COUNT_SHADOW * HALF * x;"));
  CHECK_THAT(made, ContainsSubstring("COUNT_SHADOW"));
  CHECK_THAT(made, ContainsSubstring("0.5f"));
}

TEST_CASE("a function is made anew for each kind of call") {
  const std::string text = "static inline float twice(float a, float b) { return a + b; }\n" +
                           function("return twice(x, 1.0f) + twice(x, x) + (float)n * twice(1.0f, 2.0f);");
  const std::string made = in_lanes(text);
  CHECK_THAT(made, ContainsSubstring("REAL twice_vu(REAL a, float b)"));
  CHECK_THAT(made, ContainsSubstring("REAL twice(REAL a, REAL b)"));
  CHECK_THAT(made, ContainsSubstring("float twice_uu(float a, float b)"));
}

TEST_CASE("a vector that an interface declares has its own functions, and parts") {
  const std::string made =
      in_lanes("LANE_VECTOR(Hue, Hues, hue, 4);\n" +
               function("Hue a = (Hue)(1.0f);\nif (x > 0.0f) a = a * a * x;\na.w = x;\nreturn a.y;"));
  CHECK_THAT(made, ContainsSubstring("Hues a = hue_all(1.0f);"));
  CHECK_THAT(made, ContainsSubstring("a = hue_select(a, hue_scale(hue_multiply(a, a), x), is_1);"));
  CHECK_THAT(made, ContainsSubstring("a.w = x;"));
  CHECK_THAT(made, ContainsSubstring("return a.y;"));
}

TEST_CASE("what two plain files make is made once a program, and lanes of structures join") {
  const std::string made = in_lanes(
      "typedef struct LANES(Rays, join_rays) { float t; } Ray;\n"
      "typedef struct Walk { Ray ray; float b; } Walk;\n"
      "static inline Walk further(Walk w, float x) { if (x > 0.0f) w.b = x; return w; }\n"
      "ENTRY static Walk walk(Walk w, float x) { if (x > 1.0f) w = further(w, x); return w; }");
  CHECK_THAT(made, ContainsSubstring("#ifndef MADE_Walks\n#define MADE_Walks\ntypedef struct Walks {"));
  CHECK_THAT(made, ContainsSubstring("r.ray = a.ray; join_rays(&r.ray, &b.ray, m);"));
  CHECK_THAT(made, ContainsSubstring("#ifndef MADE_further\n#define MADE_further\n"));
}

TEST_CASE("a loop asks whether lanes are left, unless its first statement does") {
  const std::string rest = "for (int i = 0; i < n; ++i) c += q[i]; }\n";
  const std::string made =
      in_lanes(function("float c = 0.0f;\nwhile (n > 0) { c += x; if (c > 9.0f) break; " + rest +
                        "while (n > 1) { if (c > 9.0f) break; " + rest + "return c;"));
  CHECK_THAT(made, ContainsSubstring("for (; (n > 0) && any_lane(in_1); ) {"));
  CHECK_THAT(made, ContainsSubstring("for (; (n > 1); ) {"));
}

TEST_CASE("lanes that do not ask read no table and divide by one") {
  const std::string made = in_lanes(function("bool b = k >= 0 && q[k] > x;\nreturn b ? (float)(n / k) : x;"));
  CHECK_THAT(made,
             ContainsSubstring("(is_1 & MASK_OF(gather_floats((__global const float*)(q), k, m_2) > x))"));
  CHECK_THAT(made, ContainsSubstring("((MASK)((int)(n)) / select((MASK)(1), k, m_5))"));
}

TEST_CASE("a row of a table is read at a place of each lane: members, parts, elements, by a pointer too") {
  const std::string made = in_lanes(
      "typedef struct Row { float a; u32 k; float3 v; int list[2]; } Row;\n"
      "ENTRY static float f(int k, UNIFORM __global const Row* rows) {\n"
      "  __global const Row* row = &rows[k];\n"
      "  const float3 v = row->v;\n"
      "  return rows[k].a + (float)rows[k].k + (float)row->list[1] + rows[k].v.zy.x + row[1].a * v.x\n"
      "         + (float)row->list[k];\n}\n");
  CHECK_THAT(made, ContainsSubstring("__global const Row* table_1 = rows;\n  const MASK row = k;"));
  CHECK_THAT(made, ContainsSubstring("gather_floats((__global const float*)(rows), k * 12, m_)"));
  CHECK_THAT(made, ContainsSubstring("AS_UINTS(gather_words((__global const u32*)(rows), k * 12 + 1, m_))"));
  CHECK_THAT(made, ContainsSubstring("gather_words((__global const u32*)(table_1), row * 12 + 9, m_)"));
  CHECK_THAT(made,
             ContainsSubstring("gather_words((__global const u32*)(table_1), row * 12 + k * 1 + 8, m_)"));
  CHECK_THAT(made, ContainsSubstring("gather_floats((__global const float*)(rows), k * 12 + 6, m_)"));
  CHECK_THAT(made, ContainsSubstring("(row + (MASK)((int)(1))) * 12, m_)"));
  CHECK_THAT(made, ContainsSubstring(
                       "v = real3(gather_floats((__global const float*)(table_1), row * 12 + 4, m_), "));
}

TEST_CASE("what is set through an OUT pointer is set without a mask, unless lanes have parted") {
  const std::string made = in_lanes(
      "typedef struct Two { float a, b; } Two;\n"
      "static void set(float x, OUT Two* two) {\n  two->a = x;\n  two->b = 0.0f;\n  if (x > 0.0f) two->b = "
      "x;\n}\n"
      "ENTRY static float f(float x) {\n  Two two;\n  set(x, &two);\n  return two.a;\n}\n");
  CHECK_THAT(made, ContainsSubstring("  two->a = x;"));
  CHECK_THAT(made, ContainsSubstring("two->b = select(two->b, x, "));
  CHECK_THAT(made, ContainsSubstring("  Twos two;"));
}

TEST_CASE("lines are those of the plain file, and the explanation names them") {
  const std::string text = function("const float y = x * 2.0f;\nreturn y;");
  CHECK_THAT(in_lanes(text, true), ContainsSubstring("#line 1 \"plain/t.cl\"\nNEVER_INLINE REAL f("));
  const std::string branch = function("if (x > 0.0f)\n  return x;\nreturn 1.0f;");
  CHECK_THAT(in_lanes(branch, true), ContainsSubstring("#line 3 \"plain/t.cl\"\n    m_ &= ~m_2;"));
  const std::string told = Lanes([&](const std::string&) { return text; }).explained("plain/t.cl");
  CHECK_THAT(told, ContainsSubstring("y varies: line 2: its first value varies"));
}

TEST_CASE("an entry with a uniform result takes no mask") {
  const std::string made =
      in_lanes("ENTRY static UNIFORM float twice(UNIFORM float x) { return x * 2.0f; }\n");
  CHECK_THAT(made, ContainsSubstring("float twice(float x) {"));
  const std::string set = in_lanes(
      "static bool put(int* to, int k) { if (k > 0) *to = k; return k > 0; }\n"
      "ENTRY static UNIFORM bool put_one(UNIFORM int* to, UNIFORM int k) { return put(to, k); }\n");
  CHECK_THAT(set, ContainsSubstring("bool put_uu(int* to, int k) {"));
  CHECK_THAT(set, ContainsSubstring("bool put_one(int* to, int k) {"));
}

TEST_CASE("a folder's include has all files of it") {
  const std::string text = sundog::embedded_kernel("plain/light/lights/");
  CHECK_THAT(text, ContainsSubstring("#include \"plain/light/lights/spot.cl\"\n"));
  CHECK_THAT(text, ContainsSubstring("#include \"plain/light/lights/sun.cl\"\n"));
  CHECK(text == sundog::embedded_kernel("plain/light/lights/", SUNDOG_SOURCE_DIR "/kernels"));
  CHECK_THROWS_AS(sundog::embedded_kernel("plain/nowhere/"), sundog::MissingKernelFile);
}

std::multiset<std::string> sorted_lines(const std::string& text) {
  std::istringstream in(text);
  std::multiset<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.insert(line);
  return lines;
}

TEST_CASE("every plain kernel is made, alone as in a program, and expands in its place") {
  std::size_t files = 0;
  const auto read = [](const std::string& wanted) { return sundog::embedded_kernel(wanted); };
  Lanes program(read);
  for (const sundog::EmbeddedKernel& kernel : sundog::embedded_kernels()) {
    const std::string path(kernel.path);
    if (!sundog::spmd::is_plain(path) || !path.ends_with(".cl")) continue;
    ++files;
    const std::string alone = Lanes(read).text(path, false);
    // Halos are a program of their own.
    if (!path.starts_with("plain/halo/"))
      CHECK(sorted_lines(program.text(path, false)) == sorted_lines(alone));
  }
  CHECK(files > 1);
  const std::string source = sundog::KernelText{"entry/render_path.cl", {}}.expanded();
  CHECK_THAT(source, ContainsSubstring("MASK step_path("));
  CHECK_THAT(source, ContainsSubstring("\"plain/pathtracer/bounce.cl\""));
}
