// Walks the function until no further value varies: variables set in divergent branches or loops vary, and
// each kind of call gets its own specialisation.
#include "lanes/specialisation.h"

namespace sundog::spmd {
namespace {

using Kind = Expression::Kind;

bool any_of(const std::vector<bool>& all) { return std::ranges::find(all, true) != all.end(); }

}  // namespace

bool is_parted(const Frames& frames) { return std::ranges::any_of(frames, &Frame::divergent); }

double cost_of(const Expression& e) {
  if (e.kind <= Kind::component) return 0;  // values read directly
  if (e.divides_whole()) return 30;
  if (e.is_binary("/")) return 6;
  if (e.kind == Kind::assign || e.kind == Kind::choose || e.kind == Kind::index) return 2;
  const BuiltIn* called = e.kind == Kind::call ? built_in_of(e.text) : nullptr;
  return called ? called->cost : 1;
}

Specialisation::Specialisation(Specialisations& all, const Function& f, const std::vector<bool>& given)
    : function(f), name(f.name), all_(all) {
  std::string letters;
  for (std::size_t i = 0; i < f.taken.size(); ++i) {
    const Variable* p = f.taken[i];
    if (given[i]) varying.insert(p);
    if (!p->uniform && !p->type.is_table()) letters += given[i] ? 'v' : 'u';
  }
  if (letters.find('u') != std::string::npos) name += "_" + letters;
  masked = f.is_entry && !f.uniform;
  result_varies = masked && !f.result.is_nothing();
  int at = 0;
  number(*f.body, at);
  find_only_result();
}

void Specialisation::number(const Statement& s, int& at) {
  for (const ExpressionPtr& e : s.expressions)
    if (e)
      any_within(*e, [&](const Expression& part) {
        ++at;
        for (std::size_t i = 0; part.function && i < part.of.size(); ++i)
          if (part.function->taken[i]->out && part.of[i]->is_unary("&") && part.of[i]->of[0]->variable &&
              !last_use_.contains(part.of[i]->of[0]->variable))
            set_by_call.insert(part.of[i]->of[0]->variable);
        if (part.variable) last_use_[part.variable] = at;
        return false;
      });
  for (const StatementPtr& inner : s.body) number(*inner, at);
  if (s.is(Statement::Kind::loop)) loop_end_[&s] = at;
}

void Specialisation::find_only_result() {
  std::set<const Variable*> all;
  each_within(*function.body, [&](const Statement& s) {
    if (s.is(Statement::Kind::give)) all.insert(s.expressions.empty() ? nullptr : s.expressions[0]->variable);
  });
  if (all.size() != 1) return;
  for (const StatementPtr& part :
       function.body->body)  // in an inner block its name would be out of scope at the end
    if (part->is(Statement::Kind::declare) &&
        std::ranges::find(part->variables, *all.begin()) != part->variables.end())
      only_result = *all.begin();
}

void Specialisation::analyse() {
  Findings before;
  do {
    before = *this;
    cost = 0;
    Frames frames;
    statement(*function.body, frames);
    if (divergent_return && only_result)
      make_vary(only_result, only_result->place, "lanes return it one after the other");
  } while (before != *this);
  if (function.is_entry && function.uniform && result_varies)
    fail(function.place, "the result of {} is UNIFORM, but varies", function.name);
}

void Specialisation::make_vary(const Variable* v, const Place& place, const std::string& what) {
  if (v->uniform) fail(place, "'{}' is uniform, but {}", v->name, what);
  if (varying.insert(v).second) why[v] = fmt::format("line {}: {}", place.line, what);
}

void Specialisation::declare(const Variable* v, const Frames& frames) {
  declared_in_[v] = frames.size();
  if (v->type.is_by_hand()) varying.insert(v);
}

bool Specialisation::is_dead_after(const Variable* v, const Statement* loop, const Frames& frames,
                                   std::size_t from) const {
  for (std::size_t k = from; k < frames.size(); ++k)
    if (frames[k].kind == Frame::Kind::loop) {
      if (frames[k].node != loop) return false;  // an outer loop reaches it again
      break;
    }
  const auto last = last_use_.find(v);
  return last == last_use_.end() || last->second <= loop_end_.at(loop);
}

std::vector<const Frame*> Specialisation::between(const Variable* v, const Frames& frames) {
  const std::size_t k = declared_in_[v];
  std::vector<const Frame*> out;
  for (std::size_t i = k; i < frames.size(); ++i)
    if (frames[i].divergent &&
        !(frames[i].kind == Frame::Kind::loop && is_dead_after(v, frames[i].node, frames, k)))
      out.push_back(&frames[i]);
  return out;
}

void Specialisation::inside(const Statement& s, const Frame& frame, Frames& frames) {
  masked |= frame.divergent;
  frames.push_back(frame);
  if (frame.kind == Frame::Kind::alike) declare(frame.node->variables[0], frames);
  statement(s, frames);
  frames.pop_back();
}

void Specialisation::statement(const Statement& s, Frames& frames) {
  switch (s.kind) {
    case Statement::Kind::block:
      for (const StatementPtr& inner : s.body) statement(*inner, frames);
      return;
    case Statement::Kind::declare:
      for (std::size_t i = 0; i < s.variables.size(); ++i) {
        const Variable* v = s.variables[i];
        declare(v, frames);
        if (s.expressions[i] && varies(*s.expressions[i], frames))
          make_vary(v, v->place, "its first value varies");
      }
      return;
    case Statement::Kind::branch: {
      const bool divergent = s.feature.empty() && varies(*s.expressions[0], frames);
      for (const StatementPtr& part : s.body) inside(*part, {Frame::Kind::branch, &s, divergent}, frames);
      return;
    }
    case Statement::Kind::loop:
      return loop(s, frames);
    case Statement::Kind::each_alike:
      return inside(*s.body[0], {Frame::Kind::alike, &s, varies(*s.expressions[0], frames)}, frames);
    case Statement::Kind::leave_loop:
    case Statement::Kind::next_round: {
      const auto [left, divergent] = left_loop(s, frames);
      if (divergent) (s.is(Statement::Kind::leave_loop) ? divergent_break : divergent_continue).insert(left);
      return;
    }
    case Statement::Kind::give: {
      const bool divergent = is_parted(frames);
      divergent_return |= divergent;
      masked |= divergent;
      if (s.expressions.empty()) return;
      const bool value_varies = varies(*s.expressions[0], frames);
      result_varies |= value_varies || divergent || function.result.is_by_hand();
      return;
    }
    case Statement::Kind::compute:
      varies(*s.expressions[0], frames);
  }
}

void Specialisation::loop(const Statement& s, Frames& frames) {
  frames.push_back({Frame::Kind::loop, &s, divergent_break.contains(&s)});
  statement(*s.body[0], frames);
  if (varies(*s.expressions[0], frames)) {
    divergent_break.insert(&s);
    frames.back().divergent = true;
  }
  inside(*s.body[1], {Frame::Kind::round, &s, divergent_continue.contains(&s)}, frames);
  if (s.expressions.size() > 1) varies(*s.expressions[1], frames);
  masked |= divergent_break.contains(&s) || divergent_continue.contains(&s);
  frames.pop_back();
}

std::pair<const Statement*, bool> left_loop(const Statement& s, const Frames& frames) {
  bool divergent = false;
  for (auto f = frames.rbegin(); f != frames.rend(); ++f) {
    if (f->kind == Frame::Kind::alike) fail(s.place, "break or continue out of EACH_ALIKE");
    if (f->kind == Frame::Kind::loop) return {f->node, divergent};
    divergent |= f->divergent && (f->kind == Frame::Kind::branch || s.is(Statement::Kind::leave_loop));
  }
  fail(s.place, "there is no loop about it");
}

Specialisation& Specialisations::of(const Function& f, const std::vector<bool>& varying) {
  auto& made = made_[{&f, varying}];
  if (!made) {
    made = std::make_unique<Specialisation>(*this, f, varying);
    made->analyse();
    done_.push_back(made.get());
  }
  return *made;
}

// ---- which values vary: expressions, assignments, calls

Specialisation::Root Specialisation::root_of(const Expression& e) const {
  if (e.kind == Kind::variable) return {e.variable, false};
  const bool points = e.is_unary("*") || e.is_unary("&"),
             adds = e.kind == Kind::binary;  // a table and an index
  if (!points && !adds && e.kind != Kind::member && e.kind != Kind::component && e.kind != Kind::index)
    fail(e.place, "this is no place to write to, or to point to");
  const auto [variable, through] = root_of(*e.of[0]);
  const bool follows = e.is_unary("*") || (e.kind == Kind::index && e.of[0]->type.is_pointer());
  return {variable, through || e.arrow || follows};
}

void Specialisation::assign(const Expression& to, bool value_varies, const Frames& frames) {
  const auto [root, through] = root_of(to);
  const Expression* place = &to;
  while (place->kind == Kind::member || place->kind == Kind::component) place = place->of[0].get();
  const bool scatters = place->kind == Kind::index && varies(*place->of[1], frames);
  masked |= scatters;
  if (!through) {
    if (value_varies || scatters) make_vary(root, to.place, "what it is set to varies");
    if (!between(root, frames).empty()) make_vary(root, to.place, "it is set where lanes part");
    return;
  }
  if (root->type.is_table()) fail(to.place, "tables are only read");
  const bool by_lanes = value_varies || scatters || divergent_return || is_parted(frames);
  if (root->uniform && by_lanes)
    fail(to.place, "'{}' is uniform, but is written a lane at a time", root->name);
  writes_uniform |= root->uniform;
  if (by_lanes) make_vary(root, to.place, "what is written there varies");
  masked |= varies(root);
}

bool Specialisation::varies(const Expression& e, const Frames& frames) {
  cost += cost_of(e);
  switch (e.kind) {
    case Kind::variable:
      return varies(e.variable);
    case Kind::member: {
      const Type& base = e.of[0]->type;
      bool v = varies(*e.of[0], frames);
      if (base.is_own_pointer()) v = pointee_varies(*e.of[0]);
      masked |= v && base.is_table();
      return v;
    }
    case Kind::index: {
      bool a = varies(*e.of[0], frames);
      const bool b = varies(*e.of[1], frames);
      masked |= b;
      if (e.of[0]->type.is_own_pointer()) a = pointee_varies(*e.of[0]);
      return a || b;
    }
    case Kind::unary: {
      if (e.text == "*" && e.of[0]->type.is_own_pointer()) return pointee_varies(*e.of[0]);
      const bool v = varies(*e.of[0], frames);
      if (e.steps()) assign(*e.of[0], v, frames);
      return v;
    }
    case Kind::assign: {
      const bool v = varies(*e.of[1], frames);
      assign(*e.of[0], v, frames);
      return v;
    }
    case Kind::binary:
    case Kind::choose:
      return parts_vary(e, frames);
    case Kind::call:
      return call_varies(e, frames);
    case Kind::any:
      varies(*e.of[0], frames);
      masked = true;
      return false;
    default: {
      bool v = e.type.is_by_hand() && !e.of.empty();
      for (const ExpressionPtr& part : e.of) v |= varies(*part, frames);
      return v;
    }
  }
}

/// Whether the operands vary. Operands right of a varying &&, || or ? are inside a divergent branch.
bool Specialisation::parts_vary(const Expression& e, const Frames& frames) {
  const bool first = varies(*e.of[0], frames);
  bool v = first || e.type.is_by_hand();
  const bool parted = first && (e.kind == Kind::choose || joins(e.text));
  Frames inner = parted ? frames : Frames{};
  if (parted) inner.push_back({Frame::Kind::branch, nullptr, true});
  for (std::size_t i = 1; i < e.of.size(); ++i) {
    const bool part = varies(*e.of[i], parted ? inner : frames);
    masked |= part && e.divides_whole();
    v |= part;
  }
  return v;
}

std::vector<bool> Specialisation::arguments_of(const Expression& call, const Frames& frames) {
  std::vector<bool> vary;
  for (const ExpressionPtr& argument : call.of) vary.push_back(varies(*argument, frames));
  const std::vector<const Variable*>& parameters = call.function->taken;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (is_own_pointer(parameters[i])) vary[i] = pointee_varies(*call.of[i]);
  if (any_of(vary))  // values written through pointers vary with the other arguments
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (is_own_pointer(parameters[i])) vary[i] = true;
  return vary;
}

void Specialisation::refuse_varying_uniforms(const Expression& call, const std::vector<bool>& vary) const {
  const Function& f = *call.function;
  for (std::size_t i = 0; i < f.taken.size(); ++i)
    if (vary[i] && f.taken[i]->uniform && !f.taken[i]->type.is_own_pointer())
      fail(call.of[i]->place, "{}: '{}' is uniform, but is given what varies", f.name, f.taken[i]->name);
}

bool Specialisation::hand_written_varies(const Expression& e, const std::vector<bool>& vary) {
  const Function& f = *e.function;
  cost += 15;
  masked |= f.takes_mask;
  refuse_varying_uniforms(e, vary);
  for (std::size_t i = 0; i < f.taken.size(); ++i) {
    if (!is_own_pointer(f.taken[i])) continue;
    if (f.uniform && vary[i]) fail(e.of[i]->place, "{} takes what is uniform", f.name);
    if (!f.uniform && !pointee_varies(*e.of[i]))
      make_vary(root_of(*e.of[i]).variable, e.place, f.name + " takes it a lane each");
  }
  if (f.uniform && any_of(vary) && std::ranges::none_of(f.taken, &Variable::uniform) && !f.takes_mask)
    fail(e.place, "{} takes what is uniform", f.name);
  return !f.uniform && !f.result.is_nothing();
}

bool Specialisation::call_varies(const Expression& e, const Frames& frames) {
  if (!e.function || !e.function->body) {
    std::vector<bool> vary;
    for (const ExpressionPtr& argument : e.of) vary.push_back(varies(*argument, frames));
    return e.function ? hand_written_varies(e, vary) : any_of(vary);
  }
  const Function& f = *e.function;
  const auto vary_if = [&](const auto& test, const char* what) {
    for (std::size_t i = 0; i < f.taken.size(); ++i)
      if (is_own_pointer(f.taken[i]) && test(i))
        make_vary(root_of(*e.of[i]).variable, e.place, fmt::format("{} {}", f.name, what));
  };
  std::vector<bool> vary = arguments_of(e, frames);
  refuse_varying_uniforms(e, vary);
  const bool parted = is_parted(frames);
  if (any_of(vary) || parted)
    vary_if([&](std::size_t i) { return !f.taken[i]->type.constant; }, "writes to it");
  vary = arguments_of(e, frames);
  vary_if([&](std::size_t i) { return vary[i] && !pointee_varies(*e.of[i]); }, "takes it with what varies");
  const Specialisation& called = all_.of(f, vary);
  calls.insert(&called);
  if (parted && called.writes_uniform)
    fail(e.place, "{} writes what is uniform, but is called a lane at a time", f.name);
  writes_uniform |= called.writes_uniform;
  vary_if([&](std::size_t i) { return called.varies(f.taken[i]); }, "writes what varies to it");
  cost += called.cost;
  masked |= called.masked;
  return called.result_varies;
}

}  // namespace sundog::spmd
