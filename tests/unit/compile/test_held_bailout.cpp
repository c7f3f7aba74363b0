// How far an orbit may go before floats end.
#include "catch.h"
#include "compile/fields/held_bailout.h"
#include "default_field.h"

using namespace sundog;

namespace {

double held(const char* name, double bailout, double power = 0) {
  const FormulaDefinition* definition = find_formula(name);
  REQUIRE(definition != nullptr);
  FormulaField field = default_field(*definition).root.formula;
  field.bailout = bailout;
  if (power > 0) field.steps[0].values[0] = power;
  return held_bailout(field);
}

}  // namespace

TEST_CASE("a bailout is lowered to where a power of it has room in a float, and no other is") {
  CHECK(held("mandelbulb", 16) == 16);
  CHECK(held("mandelbulb", 100) == 100);
  CHECK(held("quaternion_mandelbrot", 1000) == 1000);
  CHECK(held("mandelbox", 1e9) == 1e9);
  CHECK(held("menger", 0) == 0);
  for (const char* name : {"mandelbulb", "juliabulb", "julia", "quaternion_mandelbrot", "tricorn"}) {
    INFO(name);
    CHECK(held(name, 16, 16) == Approx(12.8).epsilon(0.05));
    CHECK(held(name, 1e9, 16) == Approx(12.8).epsilon(0.05));
    CHECK(held(name, 1e9, 8) == Approx(164).epsilon(0.05));
  }
}
