// See specialisation.h.
#include "lanes/specialisation.h"

#include <fmt/format.h>

#include <algorithm>

namespace sundog::spmd {
using Kind = Expression::Kind;

double cost_of(const Expression& e) {
  static const std::map<std::string, double> costly{
      {"pow", 40},  {"sin", 30}, {"cos", 30},   {"exp", 20},   {"log", 20},  {"atan2", 30}, {"acos", 30},
      {"asin", 30}, {"sqrt", 6}, {"cospi", 30}, {"sinpi", 30}, {"fmod", 30}, {"cbrt", 40},  {"tan", 40}};
  switch (e.kind) {
    case Kind::number:
    case Kind::constant:
    case Kind::variable:
    case Kind::member:
    case Kind::component:
      return 0;
    case Kind::call: {
      const auto found = costly.find(e.text);
      return found == costly.end() ? 1 : found->second;
    }
    case Kind::binary:
      if (e.text == "/" || e.text == "%") return e.type.is_whole() ? 30 : 6;
      return 1;
    case Kind::assign:
    case Kind::choose:
    case Kind::index:
      return 2;
    default:
      return 1;
  }
}

Specialisation::Specialisation(Specialisations& all, const Function& f, std::vector<bool> varying)
    : function(f), given(std::move(varying)), all_(all) {
  name = f.name;
  const auto parameters = taken(f);
  bool differs = false;
  std::string letters;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Variable* p = parameters[i];
    if (given[i]) varying_.insert(p);
    declared_in_[p] = {};
    const bool may_vary = !p->uniform && !p->type.is_table();
    differs |= may_vary && !given[i];
    if (may_vary) letters += given[i] ? 'v' : 'u';
  }
  if (differs) name += "_" + letters;
  masked = f.is_entry && !f.uniform;
  result_varies = f.is_entry && !f.uniform && !f.result.is(Type::Kind::nothing);
  int at = 0;
  number(*f.body, at);
  find_only_result();
}

void Specialisation::number(const Expression& e, int& at) {
  ++at;
  if (e.variable) uses_.last[e.variable] = at;
  for (const auto& part : e.of) number(*part, at);
}

void Specialisation::number(const Statement& s, int& at) {
  ++at;
  for (const auto& e : s.expressions)
    if (e) number(*e, at);
  for (const auto& inner : s.body)
    if (inner) number(*inner, at);
  if (s.kind == Statement::Kind::loop || s.kind == Statement::Kind::do_loop) uses_.end[&s] = at;
}

void Specialisation::find_only_result() {
  std::set<const Variable*> all;
  const auto visit = [&](const auto& self, const Statement& s) -> void {
    if (s.kind == Statement::Kind::give)
      all.insert(s.expressions.empty() ? nullptr : s.expressions[0]->variable);
    for (const auto& inner : s.body)
      if (inner) self(self, *inner);
  };
  visit(visit, *function.body);
  if (all.size() != 1) return;
  for (const auto& part : function.body->body)  // in a block within, its name would not be known at the end
    if (std::ranges::find(part->variables, *all.begin()) != part->variables.end() &&
        part->kind == Statement::Kind::declare)
      only_result = *all.begin();
}

void Specialisation::analyse() {
  for (;;) {
    const auto before =
        std::tuple(varying_, result_varies, masked, divergent_break, divergent_continue, divergent_return);
    cost = 0;
    Frames frames;
    statement(*function.body, frames);
    if (divergent_return && only_result)
      make_vary(only_result, only_result->place, "lanes return it one after the other");
    if (before ==
        std::tuple(varying_, result_varies, masked, divergent_break, divergent_continue, divergent_return))
      break;
  }
  if (function.is_entry && function.uniform && result_varies)
    fail(function.place, fmt::format("the result of {} is UNIFORM, but varies", function.name));
}

void Specialisation::make_vary(const Variable* v, const Place& place, const std::string& what) {
  if (v->uniform) fail(place, fmt::format("'{}' is uniform, but {}", v->name, what));
  if (varying_.insert(v).second) why[v] = fmt::format("line {}: {}", place.line, what);
}

void Specialisation::declare(const Variable* v, const Frames& frames) {
  auto& where = declared_in_[v];
  where.clear();
  for (const Frame& f : frames) where.emplace_back(f.node, f.part + 2 * static_cast<int>(f.kind));
  if (is_by_hand(v->type)) varying_.insert(v);
}

bool Specialisation::is_dead_after(const Variable* v, const Statement* loop, const Frames& frames,
                                   std::size_t from) const {
  for (std::size_t k = from; k < frames.size(); ++k)
    if (frames[k].kind == Frame::Kind::loop) {
      if (frames[k].node != loop) return false;  // an outer loop comes back
      break;
    }
  const auto last = uses_.last.find(v);
  return last == uses_.last.end() || last->second <= uses_.end.at(loop);
}

std::vector<const Frame*> Specialisation::between(const Variable* v, const Frames& frames) const {
  const auto found = declared_in_.find(v);
  std::size_t k = 0;
  if (found != declared_in_.end())
    while (k < found->second.size() && k < frames.size() &&
           found->second[k] ==
               std::pair(frames[k].node, frames[k].part + 2 * static_cast<int>(frames[k].kind)))
      ++k;
  std::vector<const Frame*> out;
  for (std::size_t i = k; i < frames.size(); ++i)
    if (frames[i].divergent &&
        !(frames[i].kind == Frame::Kind::loop && is_dead_after(v, frames[i].node, frames, k)))
      out.push_back(&frames[i]);
  return out;
}

void Specialisation::inside(const Statement& s, const Frame& frame, Frames& frames) {
  frames.push_back(frame);
  statement(s, frames);
  frames.pop_back();
}

void Specialisation::statement(const Statement& s, Frames& frames) {
  switch (s.kind) {
    case Statement::Kind::block:
      for (const auto& inner : s.body) statement(*inner, frames);
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
      masked |= divergent;
      for (std::size_t i = 0; i < s.body.size(); ++i)
        inside(*s.body[i], {Frame::Kind::branch, &s, static_cast<int>(i), divergent, ""}, frames);
      return;
    }
    case Statement::Kind::loop:
    case Statement::Kind::do_loop:
      return loop(s, frames);
    case Statement::Kind::each_alike: {
      const bool divergent = varies(*s.expressions[0], frames);
      masked |= divergent;
      frames.push_back({Frame::Kind::alike, &s, 0, divergent, ""});
      declare(s.variables[0], frames);
      statement(*s.body[0], frames);
      frames.pop_back();
      return;
    }
    case Statement::Kind::leave_loop:
    case Statement::Kind::next_round:
      return leave(s, frames);
    case Statement::Kind::give: {
      const bool divergent = std::ranges::any_of(frames, &Frame::divergent);
      divergent_return |= divergent;
      masked |= divergent;
      if (s.expressions.empty()) return;
      const bool value_varies = varies(*s.expressions[0], frames);
      result_varies |= value_varies || divergent || is_by_hand(function.result);
      return;
    }
    case Statement::Kind::compute:
      varies(*s.expressions[0], frames);
  }
}

void Specialisation::loop(const Statement& s, Frames& frames) {
  frames.push_back({Frame::Kind::loop, &s, 0, divergent_break.contains(&s), ""});
  const auto ask = [&] {
    if (s.expressions[0] && varies(*s.expressions[0], frames)) {
      divergent_break.insert(&s);
      frames.back().divergent = true;
    }
  };
  if (s.body[0]) statement(*s.body[0], frames);
  ask();
  inside(*s.body[1], {Frame::Kind::round, &s, 0, divergent_continue.contains(&s), ""}, frames);
  if (s.expressions[1]) varies(*s.expressions[1], frames);
  masked |= divergent_break.contains(&s) || divergent_continue.contains(&s);
  frames.pop_back();
}

void Specialisation::leave(const Statement& s, const Frames& frames) {
  bool divergent = false;
  for (auto f = frames.rbegin(); f != frames.rend(); ++f) {
    if (f->kind == Frame::Kind::alike) fail(s.place, "break or continue out of EACH_ALIKE");
    divergent |= f->divergent && (f->kind == Frame::Kind::branch ||
                                  (f->kind == Frame::Kind::round && s.kind == Statement::Kind::leave_loop));
    if (f->kind != Frame::Kind::loop) continue;
    if (divergent)
      (s.kind == Statement::Kind::leave_loop ? divergent_break : divergent_continue).insert(f->node);
    return;
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
