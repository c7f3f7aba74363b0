// Writes functions and their statements: declarations, masked stores and branches.
#include "lanes/writer.h"

namespace sundog::spmd {
namespace {

using StatementKind = Statement::Kind;

constexpr double cheap = 12;      // operations up to which a branch is computed rather than skipped
constexpr double long_rest = 24;  // remaining operations above which testing for active lanes pays

/// The type of a variable that is set later on.
Type settable(Type type) {
  if (!type.is_pointer()) type.constant = false;
  return type;
}

}  // namespace

Exits exits_of(const Statement& s) {
  Exits out{s.is(StatementKind::leave_loop), s.is(StatementKind::next_round), s.is(StatementKind::give),
            s.is(StatementKind::loop)};
  for (const StatementPtr& part : s.body) {
    const Exits inner = exits_of(*part);
    out.gives |= inner.gives;
    out.loops |= inner.loops;
    out.leaves |= inner.leaves && !s.is(StatementKind::loop);
    out.next |= inner.next && !s.is(StatementKind::loop);
  }
  return out;
}

Writer::Writer(Specialisations& all, Specialisation& made)
    : all_(all), s_(made), mask_(made.masked ? "m_" : "ALL_LANES"), place_(made.function.place) {}

double Writer::weight(const Expression& e) {
  double all = cost_of(e);
  if (e.function) all = e.function->body ? all_.of(*e.function, s_.arguments_of(e, frames_)).cost : 15;
  for (const ExpressionPtr& part : e.of) all += weight(*part);
  return all;
}

double Writer::weight(const Statement& s) {
  double all = 0;
  each_within(s, [&](const Statement& part) {
    if (part.is(StatementKind::give)) ++all;
    for (const ExpressionPtr& e : part.expressions)
      if (e) all += weight(*e);
  });
  return all;
}

/// Whether it pays to test if any lane is left before the statements from `from` on.
bool Writer::is_long(const std::vector<StatementPtr>& all, std::size_t from) {
  double rest = 0;
  bool loops = false;
  for (std::size_t i = from; i < all.size(); ++i) {
    rest += weight(*all[i]);
    loops |= exits_of(*all[i]).loops;
  }
  return rest > long_rest || loops;
}

std::vector<Line> Writer::function() {
  const Function& f = s_.function;
  const bool gives = !f.result.is_nothing(), keeps = s_.divergent_return && gives;
  std::string parameters = joined(f.parameters, [&](const Variable* p) {
    return type_text(settable(p->type), s_.varies(p)) + " " + p->name;
  });
  if (s_.masked) parameters += parameters.empty() ? "MASK m_" : ", MASK m_";
  const std::string type = type_text(f.result, s_.result_varies);
  depth_ = 0;
  line("{} {} {}({}) {{", f.is_inline ? "static inline" : "NEVER_INLINE", type, s_.name,
       parameters.empty() ? "void" : parameters);
  depth_ = 1;
  if (keeps && !s_.only_result) line("{} result_ = {};", type, nothing(f.result));
  const std::string result = s_.only_result ? s_.only_result->name : "result_";
  const std::vector<StatementPtr>& body = f.body->body;
  for (std::size_t i = 0; i < body.size(); ++i) {
    statement(*body[i]);
    if (s_.divergent_return && i + 1 < body.size() && exits_of(*body[i]).gives && is_long(body, i + 1))
      line("if (!any_lane(m_)) return{};", gives ? " " + result : "");
  }
  if (keeps && (body.empty() || !body.back()->is(StatementKind::give))) line("return {};", result);
  depth_ = 0;
  line("}");
  return std::move(out_);
}

void Writer::statement(const Statement& s) {
  place_ = s.place;
  switch (s.kind) {
    case StatementKind::block:
      if (s.body.empty()) return;
      line("{");
      ++depth_;
      block(s.body, false);
      --depth_;
      return line("}");
    case StatementKind::declare:
      for (std::size_t i = 0; i < s.variables.size(); ++i)
        declaration(*s.variables[i], s.expressions[i].get());
      return;
    case StatementKind::branch:
      return branch(s);
    case StatementKind::loop:
      return loop(s);
    case StatementKind::each_alike:
      return each_alike(s);
    case StatementKind::leave_loop:
    case StatementKind::next_round:
      return leave(s);
    case StatementKind::give:
      return give(s);
    case StatementKind::compute:
      return line(computed(*s.expressions[0]) + ";");
  }
}

/// `in_loop`: the block is the body of the innermost loop.
void Writer::block(const std::vector<StatementPtr>& all, bool in_loop) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Statement& s = *all[i];
    statement(s);
    const bool leaves = in_loop && loops_.back().masked && s.is(StatementKind::branch) && exits_of(s).any() &&
                        s.feature.empty() && varies(*s.expressions[0]);
    if (!leaves || !is_long(all, i + 1)) continue;
    Loop& l = loops_.back();
    line("if (!any_lane({})) {}", l.going, l.going == l.lanes ? "break;" : "continue;");
    if (i == 0 && l.going == l.lanes) l.checked = true;  // the loop itself need not test
  }
}

/// Whether control may reach this place several times.
bool Writer::comes_again() const {
  return !loops_.empty() || std::ranges::any_of(frames_, [](const Frame& f) {
    return f.kind == Frame::Kind::alike && f.divergent;
  });
}

std::string Writer::nothing(const Type& type) {
  if (type.is_truth()) return "NO_LANES";
  return type.is_number() ? fmt::format("({})(0)", type_text(type, true)) : "{0}";
}

void Writer::declaration(const Variable& v, const Expression* first) {
  const bool vary = s_.varies(&v);
  s_.declare(&v, frames_);
  if (vary && v.type.is_table()) {
    if (!first) fail(v.place, "a pointer without a place");
    const auto [table, index] = table_and_index(*first);
    const std::string kept = fresh("table");
    line("{} {} = {};", type_text(v.type, false), kept, table);
    if (index.empty()) fail(v.place, "a pointer that varies is a table and an index from the beginning");
    tables_[&v] = kept;
    return line("const MASK {} = {};", v.name, index);
  }
  const Type type = settable(v.type);
  const bool is_array = type.is_array(), constant = v.type.constant && !type.is_pointer() && first;
  // Initialises every variable: passing an undefined value to select() would be undefined behaviour, for
  // which LLVM drops a kernel.
  std::string start;
  if (first)
    start = " = " + (vary ? lanes(*first) : value(*first));
  else if (vary && !(type.is_structure() && (type.is_by_hand() || s_.set_by_call.contains(&v))))
    start = " = " + nothing(type);
  line("{}{} {}{}{};", constant ? "const " : "", type_text(is_array ? *type.of : type, vary), v.name,
       is_array ? fmt::format("[{}]", type.length) : "", start);
}

/// Writes an expression for its effect.
std::string Writer::computed(const Expression& e) {
  if (e.kind != Expression::Kind::assign && !e.steps()) return value(e);
  const Expression& to = *e.of[0];
  const bool scatters = to.kind == Expression::Kind::index && varies(*to.of[1]);
  if (!varies(to) && !scatters) return value(e);
  if (e.kind == Expression::Kind::assign) {
    const std::string value = lanes(*e.of[1]);
    return scatters ? scatter(to, value) : store(to, value);
  }
  if (scatters) return scatter(to, fmt::format("({} {} 1)", lanes(to), e.text[0]));
  const std::string place = value(to);
  const auto [root, through] = s_.root_of(to);
  if (to.type.is(Type::Kind::integer) && (through || !s_.between(root, frames_).empty()))
    return fmt::format("{} {}= {}", place, e.text == "++" ? '-' : '+', mask_);
  return store(to, fmt::format("{} {} 1", place, e.text[0]));
}

/// Writes `to = value`, under a mask unless inactive lanes never read the variable again.
std::string Writer::store(const Expression& to, const std::string& what) {
  const auto [root, through] = s_.root_of(to);
  const std::string place = value(to);
  const std::vector<const Frame*> divergent = s_.between(root, frames_);
  std::string mask = mask_;
  const bool is_result = root == s_.only_result && s_.divergent_return && (returned_ || comes_again());
  const bool is_out = root->out && divergent.empty() && !returned_ && !comes_again();
  if (is_out) return fmt::format("{} = {}", place, what);
  if (!through && !is_result) {
    if (divergent.empty()) return fmt::format("{} = {}", place, what);
    if (divergent.size() == 1 && divergent[0] == &frames_.back() && !divergent[0]->only.empty())
      mask = divergent[0]->only;
  }
  if (!to.type.joins()) return fmt::format("{} = {}", place, selected(to.type, place, what, mask, to.place));
  const std::string name = fresh("other");
  line("const {} {} = {};", type_text(to.type, true), name, what);
  return fmt::format("{}(&{}, &{}, {})", to.type.structure->join, place, name, mask);
}

bool mentions(const std::string& text, const std::string& name) {
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1))
    if (at + name.size() == text.size() || !std::isdigit(static_cast<unsigned char>(text[at + name.size()])))
      return true;
  return false;
}

/// Removes the line that declares the mask `name`, unless a later line uses it.
void Writer::drop_unused(std::size_t line_at, const std::string& name) {
  const auto place = out_.begin() + static_cast<std::ptrdiff_t>(line_at);
  if (std::none_of(place + 1, out_.end(), [&](const Line& l) { return mentions(l.text, name); }))
    out_.erase(place);
}

void Writer::inside(const Frame& frame, std::string mask, const Statement& s) {
  std::swap(mask, mask_);
  frames_.push_back(frame);
  if (frame.kind == Frame::Kind::alike) s_.declare(frame.node->variables[0], frames_);
  ++depth_;
  if (s.is(StatementKind::block))
    block(s.body, frame.kind == Frame::Kind::round);
  else
    statement(s);
  --depth_;
  frames_.pop_back();
  mask_ = mask;
}

void Writer::branch(const Statement& s) {
  if (!s.feature.empty()) {
    for (std::size_t i = 0; i < s.body.size(); ++i) {
      directive(i == 0 ? "#if " + s.feature : "#else");
      line("{");
      inside({Frame::Kind::branch, &s, false}, mask_, *s.body[i]);
      line("}");
    }
    return directive("#endif");
  }
  if (!varies(*s.expressions[0])) {
    for (std::size_t i = 0; i < s.body.size(); ++i) {
      line(i == 0 ? fmt::format("if ({}) {{", value(*s.expressions[0])) : "} else {");
      inside({Frame::Kind::branch, &s, false}, mask_, *s.body[i]);
    }
    return line("}");
  }
  const std::string is = fresh("is");
  line("const MASK {} = {};", is, mask_of(*s.expressions[0]));
  for (std::size_t i = 0; i < s.body.size(); ++i) {
    const Statement& part = *s.body[i];
    const Exits exits = exits_of(part);
    const std::string mask = fresh("m"), name = i == 0 ? is : "~" + is, only = exits.any() ? "" : name;
    const std::size_t at = out_.size();
    line("{}MASK {} = {} & {};", exits.any() ? "" : "const ", mask, mask_, name);
    line(weight(part) > cheap || exits.loops ? fmt::format("if (any_lane({})) {{", mask) : "{");
    inside({Frame::Kind::branch, &s, true, only}, mask, part);
    line("}");
    drop_unused(at, mask);
  }
  if (exits_of(s).any() && alive() != mask_) line("{} &= {};", mask_, alive());
}

}  // namespace sundog::spmd
