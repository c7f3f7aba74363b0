// See specialisation.h.
#include "lanes/specialisation.h"

namespace sundog::spmd {

bool is_parted(const Frames& frames) { return std::ranges::any_of(frames, &Frame::divergent); }

double cost_of(const Expression& e) {
  using Kind = Expression::Kind;
  if (e.kind <= Kind::component) return 0;  // what is read as it stands
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
        if (part.variable) last_use_[part.variable] = at;
        return false;
      });
  for (const StatementPtr& inner : s.body) number(*inner, at);
  if (s.is_loop()) loop_end_[&s] = at;
}

void Specialisation::find_only_result() {
  std::set<const Variable*> all;
  const auto visit = [&](const auto& self, const Statement& s) -> void {
    if (s.is(Statement::Kind::give)) all.insert(s.expressions.empty() ? nullptr : s.expressions[0]->variable);
    for (const StatementPtr& inner : s.body) self(self, *inner);
  };
  visit(visit, *function.body);
  if (all.size() != 1) return;
  for (const StatementPtr& part :
       function.body->body)  // in a block within, its name would not be known at the end
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
  declared_in_[v] = frames;
  if (v->type.is_by_hand()) varying.insert(v);
}

bool Specialisation::is_dead_after(const Variable* v, const Statement* loop, const Frames& frames,
                                   std::size_t from) const {
  for (std::size_t k = from; k < frames.size(); ++k)
    if (frames[k].kind == Frame::Kind::loop) {
      if (frames[k].node != loop) return false;  // an outer loop comes back
      break;
    }
  const auto last = last_use_.find(v);
  return last == last_use_.end() || last->second <= loop_end_.at(loop);
}

std::vector<const Frame*> Specialisation::between(const Variable* v, const Frames& frames) {
  const Frames& outer = declared_in_[v];
  std::size_t k = 0;
  while (k < outer.size() && k < frames.size() && outer[k].is_same(frames[k])) ++k;
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
  using Kind = Statement::Kind;
  switch (s.kind) {
    case Kind::block:
      for (const StatementPtr& inner : s.body) statement(*inner, frames);
      return;
    case Kind::declare:
      for (std::size_t i = 0; i < s.variables.size(); ++i) {
        const Variable* v = s.variables[i];
        declare(v, frames);
        if (s.expressions[i] && varies(*s.expressions[i], frames))
          make_vary(v, v->place, "its first value varies");
      }
      return;
    case Kind::branch: {
      const bool divergent = s.feature.empty() && varies(*s.expressions[0], frames);
      for (std::size_t i = 0; i < s.body.size(); ++i)
        inside(*s.body[i], {Frame::Kind::branch, &s, divergent, i}, frames);
      return;
    }
    case Kind::loop:
    case Kind::do_loop:
      return loop(s, frames);
    case Kind::each_alike:
      return inside(*s.body[0], {Frame::Kind::alike, &s, varies(*s.expressions[0], frames)}, frames);
    case Kind::leave_loop:
    case Kind::next_round: {
      const auto [left, divergent] = left_loop(s, frames);
      if (divergent) (s.is(Kind::leave_loop) ? divergent_break : divergent_continue).insert(left);
      return;
    }
    case Kind::give: {
      const bool divergent = is_parted(frames);
      divergent_return |= divergent;
      masked |= divergent;
      if (s.expressions.empty()) return;
      const bool value_varies = varies(*s.expressions[0], frames);
      result_varies |= value_varies || divergent || function.result.is_by_hand();
      return;
    }
    case Kind::compute:
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

}  // namespace sundog::spmd
