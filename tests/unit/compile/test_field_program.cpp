// Programs of fields for the kernels' interpreter: which there are, and what they keep to.
#include "compile/fields/field_program.h"

#include <fmt/format.h>

#include "catch.h"
#include "compile/fields/sdf.h"
#include "default_field.h"

using namespace sundog;

namespace {

bool can_be_interpreted(const SdfDescription& field) {
  return have_programs(compile_fields(std::span(&field, 1)).parameters);
}

/// The sum of `count` numbers that are all known before the first is added.
FieldCode sum_of(std::size_t count) {
  FieldCode code;
  Operands numbers;
  for (std::size_t i = 0; i < count; ++i)
    numbers.push_back(code.define("x", FIELD_SINE, {FieldCode::point().coordinate(0)}));
  Operand sum = numbers[0];
  for (std::size_t i = 1; i < count; ++i) sum = code.define("sum", FIELD_ADD, {sum, numbers[i]});
  code.set_result(sum);
  return code;
}

}  // namespace

TEST_CASE("every listed formula has a program") {
  for (const FormulaDefinition& definition : formula_list()) {
    INFO(definition.name);
    CHECK(can_be_interpreted(default_field(definition)));
  }
}

TEST_CASE("native code has no program") {
  SdfDescription field;
  field.root.kind = SdfNode::Kind::native;
  field.root.code = "return p.x;";
  CHECK_FALSE(can_be_interpreted(field));
}

TEST_CASE("a program uses no more registers than there are") {
  // The point takes three; once it has been read, its registers and the lanes' one are free.
  const std::vector<u32> most = field_program(sum_of(FIELD_REGISTERS - 4));
  REQUIRE_FALSE(most.empty());
  for (std::size_t at = 0; at < most.size(); at += 2) {
    CHECK((most[at] >> 8 & 255u) < FIELD_REGISTERS);
    CHECK((most[at] >> 16 & 255u) < FIELD_REGISTERS);
    CHECK(most[at] >> 24 < FIELD_REGISTERS);
  }
  CHECK(field_program(sum_of(FIELD_REGISTERS + 1)).empty());
}

TEST_CASE("a program that is too long is none") {
  FieldCode code;
  Operand x = FieldCode::point().coordinate(0);
  for (std::size_t i = 0; i < max_program; ++i) x = code.define("x", FIELD_NEGATE, {x});
  code.set_result(x);
  CHECK(field_program(code).empty());
  const std::vector<std::vector<FieldCode>> functions{{code}};
  CHECK(field_programs(functions).empty());
}

TEST_CASE("numbers that an iteration uses are loaded before it, unless that takes too many registers") {
  for (const std::size_t count : {10ul, 200ul}) {
    FieldCode code;
    const Operand x = code.declare("x", FIELD_COPY, {Operand::literal(0)});
    code.begin_iterations(0);
    for (std::size_t i = 0; i < count; ++i)
      code.assign(x, FIELD_ADD, {x, Operand::literal(static_cast<double>(i + 1))});
    code.end();
    code.set_result(x);
    const std::vector<u32> words = field_program(code);
    REQUIRE_FALSE(words.empty());
    std::size_t begin = 0;
    while ((words[2 * begin] & 255u) != FIELD_WHILE) ++begin;
    const std::size_t out = words[2 * begin + 1] & 0xFFFFu, inside = out - begin - 2;
    CHECK(inside == (count == 10 ? count : 2 * count));
    CHECK(words[2 * (out - 1) + 1] == begin);  // back to the question whether there is another iteration
  }
}
