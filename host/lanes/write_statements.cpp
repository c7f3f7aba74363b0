// Statements: what is stored where lanes have parted, branches, and what is returned.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "lanes/writer.h"

namespace sundog::spmd {
namespace {

using Kind = Expression::Kind;

constexpr double cheap = 12;      // operations up to which a branch is computed rather than jumped over
constexpr double long_rest = 24;  // operations left from which on it pays to ask whether any lane is left

bool is_constant_place(const Statement& s) { return s.kind == Statement::Kind::block && s.body.empty(); }

}  // namespace

std::vector<const Statement*> parts_of_block(const Statement& s) {
  if (s.kind != Statement::Kind::block) return {&s};
  std::vector<const Statement*> all;
  for (const StatementPtr& part : s.body) all.push_back(part.get());
  return all;
}

Exits exits_of(const Statement& s) {
  Exits out;
  out.leaves = s.kind == Statement::Kind::leave_loop;
  out.next = s.kind == Statement::Kind::next_round;
  out.gives = s.kind == Statement::Kind::give;
  const bool is_loop = s.kind == Statement::Kind::loop || s.kind == Statement::Kind::do_loop;
  for (const StatementPtr& part : s.body) {
    if (!part) continue;
    const Exits inner = exits_of(*part);
    out.gives |= inner.gives;
    out.leaves |= inner.leaves && !is_loop;
    out.next |= inner.next && !is_loop;
  }
  return out;
}

bool has_loop(const Statement& s) {
  return s.kind == Statement::Kind::loop || s.kind == Statement::Kind::do_loop ||
         std::ranges::any_of(s.body, [](const StatementPtr& part) { return part && has_loop(*part); });
}

Writer::Writer(Specialisations& all, Specialisation& made)
    : all_(all), s_(made), place_(made.function.place) {
  mask_ = s_.masked ? "m_" : "ALL_LANES";
}

void Writer::line(std::string text) { out_.push_back({depth_, std::move(text), place_}); }
std::string Writer::fresh(const char* stem) { return fmt::format("{}_{}", stem, ++count_); }

double Writer::weight(const Expression& e) {
  double all = cost_of(e);
  if (e.kind == Kind::call && e.function)
    all = e.function->body ? all_.of(*e.function, s_.arguments_of(e, frames_)).cost : 15;
  for (const ExpressionPtr& part : e.of) all += weight(*part);
  return all;
}

double Writer::weight(const Statement& s) {
  double all = s.kind == Statement::Kind::give ? 1 : 0;
  for (const ExpressionPtr& e : s.expressions)
    if (e) all += weight(*e);
  for (const StatementPtr& part : s.body)
    if (part) all += weight(*part);
  return all;
}

/// Whether it pays to ask if any lane is left before what stands from `from` on.
bool Writer::is_long(const std::vector<const Statement*>& all, std::size_t from) {
  double rest = 0;
  bool loops = false;
  for (std::size_t i = from; i < all.size(); ++i) {
    rest += weight(*all[i]);
    loops |= has_loop(*all[i]);
  }
  return rest > long_rest || loops;
}

std::vector<Line> Writer::function() {
  const Function& f = s_.function;
  const bool gives = !f.result.is(Type::Kind::nothing);
  std::string parameters;
  for (const Variable* p : f.parameters) {
    Type type = p->type;
    if (!type.is(Type::Kind::pointer)) type.constant = false;
    parameters +=
        fmt::format("{}{} {}", parameters.empty() ? "" : ", ", type_text(type, s_.varies(p)), p->name);
  }
  if (s_.masked) parameters += parameters.empty() ? "MASK m_" : ", MASK m_";
  depth_ = 0;
  line(fmt::format("{} {} {}({}) {{", f.is_inline ? "static inline" : "NEVER_INLINE",
                   type_text(f.result, s_.result_varies), s_.name, parameters.empty() ? "void" : parameters));
  depth_ = 1;
  const bool keeps = s_.divergent_return && gives;
  if (keeps && !s_.only_result)
    line(fmt::format("{} result_ = {};", type_text(f.result, s_.result_varies), nothing(f.result)));
  const auto body = parts_of_block(*f.body);
  const std::string result = s_.only_result ? s_.only_result->name : "result_";
  for (std::size_t i = 0; i < body.size(); ++i) {
    statement(*body[i]);
    if (!s_.divergent_return || i + 1 == body.size() || !exits_of(*body[i]).gives) continue;
    if (is_long(body, i + 1)) line(fmt::format("if (!any_lane(m_)) return{};", gives ? " " + result : ""));
  }
  if (keeps && (body.empty() || body.back()->kind != Statement::Kind::give))
    line(fmt::format("return {};", result));
  depth_ = 0;
  line("}");
  return std::move(out_);
}

void Writer::statement(const Statement& s) {
  place_ = s.place;
  switch (s.kind) {
    case Statement::Kind::block: {
      if (is_constant_place(s)) return;
      line("{");
      ++depth_;
      block(parts_of_block(s), false);
      --depth_;
      return line("}");
    }
    case Statement::Kind::declare:
      return declaration(s);
    case Statement::Kind::branch:
      return s.feature.empty() ? branch(s) : feature_branch(s);
    case Statement::Kind::loop:
    case Statement::Kind::do_loop:
      return loop(s);
    case Statement::Kind::each_alike:
      return each_alike(s);
    case Statement::Kind::leave_loop:
    case Statement::Kind::next_round:
      return leave(s);
    case Statement::Kind::give:
      return give(s);
    case Statement::Kind::compute:
      return line(computed(*s.expressions[0]) + ";");
  }
}

/// `in_loop`: the round of the innermost loop.
void Writer::block(const std::vector<const Statement*>& all, bool in_loop) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    statement(*all[i]);
    const bool leaves = in_loop && divergent_loop() && divergent_loop()->node == all_loops_.back().node &&
                        all[i]->kind == Statement::Kind::branch && exits_of(*all[i]).any() &&
                        all[i]->feature.empty() && varies(*all[i]->expressions[0]);
    if (!leaves || !is_long(all, i + 1)) continue;
    const Loop& l = loops_.back();
    line(fmt::format("if (!any_lane({})) {}", l.going, l.going == l.lanes ? "break;" : "continue;"));
    if (i == 0 && l.going == l.lanes) checked_.insert(l.lanes);  // the loop itself need not ask
  }
}

/// Whether this place is reached several times.
bool Writer::comes_again() const {
  return !all_loops_.empty() || std::ranges::any_of(frames_, [](const Frame& f) {
    return f.kind == Frame::Kind::alike && f.divergent;
  });
}

const Writer::Loop* Writer::divergent_loop() const { return loops_.empty() ? nullptr : &loops_.back(); }
std::string Writer::alive() const { return loops_.empty() ? "m_" : loops_.back().going; }

void Writer::declaration(const Statement& s) {
  for (std::size_t i = 0; i < s.variables.size(); ++i) declaration(*s.variables[i], s.expressions[i].get());
}

std::string Writer::nothing(const Type& type) {
  if (type.is(Type::Kind::boolean)) return "NO_LANES";
  if (type.is_number()) return fmt::format("({})(0)", type_text(type, true));
  return "{0}";
}

void Writer::declaration(const Variable& v, const Expression* first) {
  const bool vary = s_.varies(&v);
  s_.declare(&v, frames_);
  if (vary && v.type.is_table()) {
    if (!first) fail(v.place, "a pointer without a place");
    const auto [table, index] = table_and_index(*first);
    const std::string kept = fresh("table");
    line(fmt::format("{} {} = {};", type_text(v.type, false), kept, table));
    if (index.empty()) fail(v.place, "a pointer that varies is a table and an index from the beginning");
    tables_[&v] = kept;
    return line(fmt::format("const MASK {} = {};", v.name, index));
  }
  const bool constant = v.type.constant && !v.type.is(Type::Kind::pointer) && first;
  Type type = v.type;
  if (!type.is(Type::Kind::pointer)) type.constant = false;
  if (type.is(Type::Kind::array)) {
    const std::string value = first ? " = " + (vary ? varying(*first) : plain(*first)) : vary ? " = {0}" : "";
    return line(fmt::format("{}{} {}[{}]{};", constant ? "const " : "", type_text(*type.of, vary), v.name,
                            type.length, value));
  }
  // Nothing stays undefined: to hand that to select() would be undefined behaviour, for which LLVM drops a
  // kernel.
  const bool by_hand = type.is(Type::Kind::structure) && type.structure->by_hand;
  std::string value;
  if (first)
    value = vary ? lanes(*first) : plain(*first);
  else if (vary && !by_hand)
    value = nothing(type);
  line(fmt::format("{}{} {}{};", constant ? "const " : "", type_text(type, vary), v.name,
                   value.empty() ? "" : " = " + value));
}

/// An expression for what it does.
std::string Writer::computed(const Expression& e) {
  if (e.kind == Kind::assign) return assigned(e);
  if (e.kind == Kind::unary && (e.text == "++" || e.text == "--")) return stepped(e);
  return value(e);
}

std::string Writer::assigned(const Expression& e) {
  const Expression &to = *e.of[0], &of = *e.of[1];
  const bool scatters = to.kind == Kind::index && varies(*to.of[1]);
  if (!varies(to) && !scatters) return plain(e);
  const std::string value = lanes(of);
  return scatters ? scatter(to, value) : store(to, value);
}

std::string Writer::stepped(const Expression& e) {
  const Expression& of = *e.of[0];
  if (!varies(of) && !(of.kind == Kind::index && varies(*of.of[1]))) return plain(e);
  if (of.kind == Kind::index && varies(*of.of[1]))
    return scatter(of, fmt::format("({} {} 1)", lanes(of), e.text[0]));
  const std::string place = place_of(of);
  const auto [root, through] = s_.root_of(of);
  if (of.type.is(Type::Kind::integer) && (through || !s_.between(root, frames_).empty()))
    return fmt::format("{} {}= {}", place, e.text == "++" ? '-' : '+', mask_);
  return store(of, fmt::format("{} {} 1", place, e.text[0]));
}

/// `to = value` in the lanes that are there, and that the variable still matters to.
std::string Writer::store(const Expression& to, const std::string& value) {
  const auto [root, through] = s_.root_of(to);
  const std::string place = place_of(to);
  std::vector<const Frame*> divergent = s_.between(root, frames_);
  std::string mask = mask_;
  const bool is_result = root == s_.only_result && s_.divergent_return && (returned_ || comes_again());
  if (!through && !is_result) {
    if (divergent.empty()) return fmt::format("{} = {}", place, value);
    if (divergent.size() == 1 && divergent[0] == &frames_.back() && !divergent[0]->only.empty())
      mask = divergent[0]->only;
  }
  const Type& type = to.type;
  if (type.is(Type::Kind::structure) && type.structure->by_hand && !type.structure->join.empty()) {
    const std::string name = fresh("other");
    line(fmt::format("const {} {} = {};", type_text(type, true), name, value));
    return fmt::format("{}(&{}, &{}, {})", type.structure->join, place, name, mask);
  }
  return fmt::format("{} = {}", place, selected(type, place, value, mask, to.place));
}

/// A place of an array that differs from lane to lane.
std::string Writer::scatter(const Expression& to, const std::string& value) {
  if (!to.type.is(Type::Kind::real) && !to.type.is(Type::Kind::integer))
    fail(to.place, fmt::format("an element that varies of an array of {}", name_of(to.type)));
  const std::string name = fresh("value"), lane = fresh("lane"), index = simple(*to.of[1]);
  const char* part = to.type.is(Type::Kind::real) ? "REAL_LANE" : "MASK_LANE";
  line(fmt::format("const {} {} = {};", type_text(to.type, true), name, value));
  line(fmt::format("EACH_LANE({3}, {5}) {0}({1}[MASK_LANE({2}, {3})], {3}) = {0}({4}, {3});", part,
                   place_of(*to.of[0]), index, lane, name, mask_));
  return "";
}

bool mentions(const std::string& text, const std::string& name) {
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1))
    if (at + name.size() == text.size() || !std::isdigit(static_cast<unsigned char>(text[at + name.size()])))
      return true;
  return false;
}

/// Takes the line out that declares the mask `name`, unless a line behind it uses that.
void Writer::drop_unused(std::size_t line_at, const std::string& name) {
  const auto place = out_.begin() + static_cast<std::ptrdiff_t>(line_at);
  if (std::none_of(place + 1, out_.end(), [&](const Line& l) { return mentions(l.text, name); }))
    out_.erase(place);
}

void Writer::inside(Frame frame, const std::string& mask, const Statement& s) {
  const std::string outer = mask_;
  const bool is_round = frame.kind == Frame::Kind::round;
  mask_ = mask;
  frames_.push_back(std::move(frame));
  ++depth_;
  block(parts_of_block(s), is_round);
  --depth_;
  frames_.pop_back();
  mask_ = outer;
}

void Writer::feature_branch(const Statement& s) {
  const int depth = depth_;
  const auto directive = [&](std::string text) { out_.push_back({0, std::move(text), {}}); };
  directive("#if " + s.feature);
  for (std::size_t i = 0; i < s.body.size(); ++i) {
    if (i == 1) directive("#else");
    depth_ = depth;
    line("{");
    inside({Frame::Kind::branch, &s, static_cast<int>(i), false, ""}, mask_, *s.body[i]);
    line("}");
  }
  directive("#endif");
}

void Writer::branch(const Statement& s) {
  const Expression& asked = *s.expressions[0];
  if (!varies(asked)) {
    line(fmt::format("if ({}) {{", plain(asked)));
    inside({Frame::Kind::branch, &s, 0, false, ""}, mask_, *s.body[0]);
    if (s.body.size() > 1) {
      line("} else {");
      inside({Frame::Kind::branch, &s, 1, false, ""}, mask_, *s.body[1]);
    }
    return line("}");
  }
  const std::string is = fresh("is");
  line(fmt::format("const MASK {} = {};", is, mask_of(asked)));
  for (std::size_t i = 0; i < s.body.size(); ++i) {
    const Statement& part = *s.body[i];
    const std::string name = i == 0 ? is : "~" + is;
    const bool leaves = exits_of(part).any();
    const std::string mask = fresh("m");
    const std::size_t at = out_.size();
    line(fmt::format("{}MASK {} = {} & {};", leaves ? "" : "const ", mask, mask_, name));
    line(weight(part) > cheap || has_loop(part) ? fmt::format("if (any_lane({})) {{", mask) : "{");
    inside({Frame::Kind::branch, &s, static_cast<int>(i), true, leaves ? "" : name}, mask, part);
    line("}");
    drop_unused(at, mask);
  }
  if (exits_of(s).any() && alive() != mask_) line(fmt::format("{} &= {};", mask_, alive()));
}

}  // namespace sundog::spmd
