// Computes sizes and offsets by OpenCL C's rules, and lists built-in functions with their costs.
#include "lanes/tree.h"

namespace sundog::spmd {

std::string VectorForm::function(const std::string& operation) const {
  return prefix.empty() ? fmt::format("{}{}", operation, parts) : prefix + "_" + operation;
}

Type pointer_to(const Type& type) {
  return {.kind = Type::Kind::pointer,
          .of = std::make_shared<const Type>(type),
          .constant = type.constant,
          .global = type.global};
}

bool Type::fits(const Type& wanted) const {
  if (wanted.is_pointer() && (is_array() || is_pointer()))
    return of->fits(*wanted.of) && (is_array() || global == wanted.global);
  return kind == wanted.kind && form == wanted.form && structure == wanted.structure;
}

bool Type::is_by_hand() const {
  if (is_array()) return of->is_by_hand();
  return is_vector() ? !form->prefix.empty() : is_structure() && structure->by_hand;
}

bool Type::joins() const { return is_structure() && !structure->join.empty(); }

std::string name_of(const Type& type) {
  if (type.is_pointer()) return "a pointer to " + name_of(*type.of);
  if (type.is_array()) return "an array of " + name_of(*type.of);
  return type.is_nothing() ? "nothing" : type.name;
}

const Member* Structure::member(const std::string& wanted) const {
  const auto found = std::ranges::find(members, wanted, &Member::name);
  return found == members.end() ? nullptr : &*found;
}

bool is_own_pointer(const Variable* v) { return v->type.is_own_pointer() && !v->uniform; }

namespace {

int up_to(int at, int alignment) { return (at + alignment - 1) / alignment * alignment; }

std::map<std::string, BuiltIn> built_ins() {
  using enum Type::Kind;
  std::map<std::string, BuiltIn> all{{"as_int", {1, nothing, integer, "AS_MASK"}},
                                     {"as_uint", {1, nothing, natural, "AS_UINTS"}},
                                     {"as_float", {1, nothing, real, "AS_REAL"}},
                                     {"min", {2, integer, integer}},
                                     {"max", {2, integer, integer}}};
  for (const char* name : {"fma", "mad", "mix", "clamp"}) all[name] = {3, real, real};
  for (const char* name : {"atan2", "pow", "fmin", "fmax", "fmod", "copysign", "step"})
    all[name] = {2, real, real};
  for (const char* name : {"sqrt", "rsqrt", "fabs",  "floor", "ceil", "trunc", "round", "rint", "sin",
                           "cos",  "tan",   "asin",  "acos",  "atan", "exp",   "exp2",  "log",  "log2",
                           "cbrt", "sign",  "sinpi", "cospi", "cosh", "sinh",  "tanh"})
    all[name] = {1, real, real};
  for (const char* name : {"sin", "cos", "sinpi", "cospi", "asin", "acos", "atan2", "fmod"})
    all[name].cost = 30;
  for (const char* name : {"pow", "cbrt", "tan"}) all[name].cost = 40;
  for (const char* name : {"exp", "log"}) all[name].cost = 20;
  all["sqrt"].cost = 6;
  return all;
}

}  // namespace

int size_of(const Type& type) {
  if (type.is_vector()) return 4 * (type.form->parts == 3 ? 4 : type.form->parts);
  if (type.is_array()) return type.length * size_of(*type.of);
  return type.is_structure() ? up_to(offset_of(*type.structure, "the end"), alignment_of(type)) : 4;
}

int alignment_of(const Type& type) {
  if (type.is_array()) return alignment_of(*type.of);
  if (!type.is_structure()) return size_of(type);
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

bool compares(std::string_view sign) {
  return sign == "<" || sign == ">" || sign == "<=" || sign == ">=" || sign == "==" || sign == "!=";
}
bool joins(std::string_view sign) { return sign == "&&" || sign == "||"; }

const BuiltIn* built_in_of(const std::string& name) {
  static const auto& all = *new const std::map<std::string, BuiltIn>(built_ins());
  const auto found = all.find(name);
  return found == all.end() ? nullptr : &found->second;
}

}  // namespace sundog::spmd
