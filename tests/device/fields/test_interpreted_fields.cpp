// Fields by the interpreter of programs (lib/sdf/interpret.cl) and by their own code: the same bits.
#include "device/choice.h"
#include "sdf_values.h"

using namespace sundog;
using glm::dvec3;

namespace {

SdfNode joint(SdfNode::Kind kind, double smooth, std::vector<SdfNode> children) {
  SdfNode node;
  node.kind = kind;
  node.smooth = smooth;
  node.children = std::move(children);
  return node;
}

SdfNode leaf(const std::string& name) { return listed_field(name).root; }

SdfNode hybrid() {
  SdfNode node = leaf("mandelbulb");
  node.formula.iterations = 9;
  node.formula.steps[0].times = 2;
  node.formula.steps.push_back(leaf("mandelbox").formula.steps[0]);
  return node;
}

SdfNode moved(SdfNode child) {
  SdfNode node = joint(SdfNode::Kind::transform, 0, {std::move(child)});
  node.offset = {0.2, -0.1, 0.3};
  node.rotation = {{0.8, 0.6, 0}, {-0.6, 0.8, 0}, {0, 0, 1}};
  node.scale = 0.7;
  return node;
}

SdfNode repeated(SdfNode child, const dvec3& period) {
  SdfNode node = joint(SdfNode::Kind::repeat, 0, {std::move(child)});
  node.period = period;
  node.count = {1, 0, 0};
  return node;
}

SdfNode with_amount(SdfNode::Kind kind, SdfNode child) {
  SdfNode node = joint(kind, 0, {std::move(child)});
  node.amount = 0.1;
  return node;
}

/// Conditions that are known, or chosen, beside those of the point.
SdfNode conditions() {
  SdfNode node = leaf("sphere");
  FormulaDefinition& d = node.formula.steps[0].definition;
  d.distance =
      "known = 1 < 2 && p.x > 0 || 2 < 1\n"
      "length(p) - ((known ? p.y > 0 : p.z > 0) ? 1 : 1.1)";
  return node;
}

SdfDescription named(const std::string& name, SdfNode root) {
  SdfDescription field;
  field.name = name;
  field.root = std::move(root);
  return field;
}

std::vector<SdfDescription> composed_fields() {
  using Kind = SdfNode::Kind;
  return {
      named("hybrid", hybrid()),
      named("conditions", conditions()),
      named("unite", joint(Kind::unite, 0.2, {leaf("torus"), moved(leaf("sphere")), leaf("mandelbulb")})),
      named("subtract", joint(Kind::subtract, 0.1, {leaf("sphere"), moved(leaf("torus"))})),
      named("intersect", joint(Kind::intersect, 0, {leaf("sphere"), moved(moved(leaf("menger")))})),
      named("shell", with_amount(Kind::shell, leaf("torus"))),
      named("thicken", with_amount(Kind::thicken, hybrid())),
      named("repeat", repeated(joint(Kind::unite, 0,
                                     {repeated(moved(leaf("sphere")), {0, 0.5, 0.6}), leaf("mandelbulb")}),
                               {1.5, 0, 1}))};
}

}  // namespace

TEST_CASE("the interpreter of programs gives the bits of the fields' own code") {
  on_every_device([&](const DeviceInfo& info) {
    if (!calls_functions(info)) return;  // no scene's fields are interpreted there
    Device device(info);
    std::vector<SdfDescription> fields = composed_fields();
    if (is_quick(info))
      for (const FormulaDefinition& d : formula_list())
        if (uses_transcendentals(d)) fields.push_back(default_field(d));
    const CompiledFields compiled = compile_fields(fields);
    for (const int lanes : {1, 16}) {
      if (lanes != 1 && !is_quick(info)) continue;
      check_interpreted(device, compiled, fields, lanes, 1024,
                        values_of(device, compiled, fields, lanes, 1024));
    }
  });
}
