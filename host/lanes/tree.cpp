// See tree.h.
#include "lanes/tree.h"

#include <fmt/format.h>

#include <algorithm>

namespace sundog::spmd {

std::string VectorForm::function(const std::string& operation) const {
  return prefix.empty() ? fmt::format("{}{}", operation, parts) : prefix + "_" + operation;
}

const Member* Structure::member(const std::string& wanted) const {
  const auto found = std::ranges::find(members, wanted, &Member::name);
  return found == members.end() ? nullptr : &*found;
}

namespace {

int up_to(int at, int alignment) { return (at + alignment - 1) / alignment * alignment; }

}  // namespace

int size_of(const Type& type) {
  switch (type.kind) {
    case Type::Kind::vector:
      return 4 * (type.form->parts == 3 ? 4 : type.form->parts);
    case Type::Kind::array:
      return type.length * size_of(*type.of);
    case Type::Kind::structure: {
      int at = 0;
      for (const Member& member : type.structure->members)
        at = up_to(at, alignment_of(member.type)) + size_of(member.type);
      return up_to(at, alignment_of(type));
    }
    default:
      return 4;
  }
}

int alignment_of(const Type& type) {
  if (type.is(Type::Kind::array)) return alignment_of(*type.of);
  if (!type.is(Type::Kind::structure)) return size_of(type);
  int most = 4;
  for (const Member& member : type.structure->members) most = std::max(most, alignment_of(member.type));
  return most;
}

int offset_of(const Structure& structure, const std::string& name) {
  int at = 0;
  for (const Member& member : structure.members) {
    at = up_to(at, alignment_of(member.type));
    if (member.name == name) break;
    at += size_of(member.type);
  }
  return at;
}

bool is_own_pointer(const Variable* v) { return v->type.is_own_pointer() && !v->uniform; }

bool is_by_hand(const Type& type) {
  if (type.is(Type::Kind::array)) return is_by_hand(*type.of);
  if (type.is(Type::Kind::vector)) return !type.form->prefix.empty();
  return type.is(Type::Kind::structure) && type.structure->by_hand;
}

std::vector<const Variable*> taken(const Function& f) {
  std::vector<const Variable*> all;
  for (const Variable* p : f.parameters)
    if (!p->here) all.push_back(p);
  return all;
}

bool compares(const std::string& sign) {
  return sign == "<" || sign == ">" || sign == "<=" || sign == ">=" || sign == "==" || sign == "!=";
}
bool joins(const std::string& sign) { return sign == "&&" || sign == "||"; }

ExpressionPtr copy_of(const Expression& e) {
  auto copy = std::make_unique<Expression>();
  static_cast<Node&>(*copy) = e;
  for (const ExpressionPtr& part : e.of) copy->of.push_back(copy_of(*part));
  return copy;
}

std::string name_of(const Type& type) {
  if (type.is(Type::Kind::pointer)) return "a pointer to " + name_of(*type.of);
  if (type.is(Type::Kind::array)) return fmt::format("an array of {}", name_of(*type.of));
  if (type.is(Type::Kind::nothing)) return "nothing";
  return type.name;
}

}  // namespace sundog::spmd
