// Plain text that cannot be made into lanes, or that nobody should write: refused with file, line and column.
#include "catch.h"
#include "plain_text.h"

using plain_text::function;
using plain_text::refused;

TEST_CASE("plain text that has no lanes is refused at its place") {
  struct Case {
    std::string text, message;
  };
  const Case cases[] = {
      {function("goto end;"), "plain/t.cl:2:1: 'goto' has no lanes: use if"},
      {function("switch (k) {}"), "2:1: 'switch' has no lanes"},
      {function("int2 j; return x;"), "2:1: 'int2' is no type"},
      {function("return 1.0 * x;"), "2:8: 1.0 is a double: write 1.0f"},
      {function("return y;"), "2:8: 'y' is not known"},
      {function("return far(x);"), "2:8: there is no function 'far' for lanes"},
      {function("return f(x, k, n, q, o);"), "2:8: 'f' calls itself"},
      {function("return fma(x, x);"), "2:8: 'fma' takes 3 arguments, found 2"},
      {function("float x = 1.0f; return x;"), "2:7: 'x' hides another one"},
      {function("return x.y;"), "2:10: float has no members"},
      {function("return ((float2)(x, x)).z;"), "2:25: a float2 has no 'z'"},
      {function("return (float3)(x, x);"), "2:8: a float3 of 2 parts"},
      {function("q[k] = x; return x;"), "2:2: tables are only read"},
      {function("n = k; return x;"), "'n' is uniform, but what it is set to varies"},
      {function("if (x > 0.0f) n = 2; return x;"), "'n' is uniform, but it is set where lanes part"},
      {function("__global const float* p = x > 0.0f ? q : q + 1; return *p;"),
       "2:36: a pointer that varies is a table and an index"},
      {function("EACH_ALIKE(int, j, k) break; return x;"), "2:23: break or continue out of EACH_ALIKE"},
      {function("break; return x;"), "2:1: there is no loop about it"},
      {"ENTRY static UNIFORM float f(float x) { return x; }\n", "the result of f is UNIFORM, but varies"},
      {function("return;"), "2:7: 'f' gives float"},
      {function("float a = x = 1.0f; return a;"), "wanted ';', found '='"},
      {function("double d = 1.0f; d += x; return x;"), "2:1: 'double' is no type"},
      {function("int j = n; if (j++ > 2) return x; return 1.0f;"), "2:17: '++' within an expression"},
      {function("int j = n; if ((j = k) > 2) return x; return 1.0f;"), "2:19: wanted ')', found '='"},
      {function("bool b = true; b++; return x;"), "'++' of bool"},
      {function("int j = 0; int* p = &j; *p = 5; return x;"),
       "a pointer to what may be set is a parameter alone"},
      {function("float is_3 = x; return is_3;"), "names that end in _ and a number are the translator's"},
      {"static void g(float* p) { *p = 1.0f; }\n" +
           function("float a[4] = {x, x, x, x}; g(&a[k & 3]); return a[0];"),
       "a pointer to an element that varies"},
      {function("return q;"), "wanted float, found a pointer to float"},
      {"ENTRY static float f(float x) {\n  if (x > 0.0f {\n", "plain/t.cl:2:16: wanted ')', found '{'"},
      {"float f(float x", "wanted ',', found ''"},
      {"#if HAS_FOG\nint f();\n#endif\n",
       "plain/t.cl:1:1: a plain file is read once, and asks for features by if (HAS_...)"},
      {"#define F(a) (a)\n" + function("return F(x;"),
       "plain/t.cl:3:9: the arguments of a macro have no ')'"},
      {"#include \"plain/missing.h\"\n", "plain/t.cl:1:1: plain/missing.h: there is no such kernel file"},
      {"typedef struct A { float a; } A;\ntypedef struct A { float a; } A;\n", "there is a type 'A' already"},
      {"static float g(UNIFORM int i, float x) { return x * (float)i; }\n" + function("return g(k, x);"),
       "3:10: g: 'i' is uniform, but is given what varies"},
      {"float by_hand(UNIFORM int i, HERE);\n" + function("return by_hand(k);"),
       "by_hand: 'i' is uniform, but is given what varies"},
      {"typedef struct LANES(Rays) { float t; } Ray;\nRay ray_of(float t);\n" +
           function("Ray r = ray_of(x); if (x > 0.0f) r = ray_of(2.0f); return r.t;"),
       "a Ray is set where lanes part, and nothing joins two"},
      {"LANE_VECTOR(Hue, Hues, hue, 4);\n" + function("const Hue h = (Hue)(x); return h.x;"),
       "a Hue of one number that varies"},
      {"LANE_VECTOR(Hue, Hues, hue, 4);\n" + function("const Hue h = (Hue)(x, x, x, x); return h.x;"),
       "3:15: a Hue of 4 parts"},
      {"#include \"shared/lights.h\"\n" +
           function("const Light l = ((__global const Light*)q)[k]; return x;"),
       "a cast of a pointer to float to a pointer to Light"},
  };
  for (const Case& c : cases) {
    INFO(c.text);
    CHECK_THAT(refused(c.text), ContainsSubstring(c.message));
  }
}
