// Which values vary: expressions, what is assigned, calls.
#include <fmt/format.h>

#include <algorithm>

#include "lanes/specialisation.h"

namespace sundog::spmd {
namespace {

using Kind = Expression::Kind;

bool any_of(const std::vector<bool>& all) { return std::ranges::find(all, true) != all.end(); }

}  // namespace

Specialisation::Root Specialisation::root_of(const Expression& e) const {
  switch (e.kind) {
    case Kind::variable:
      return {e.variable, false};
    case Kind::member:
      return {root_of(*e.of[0]).variable, e.arrow || root_of(*e.of[0]).through};
    case Kind::component:
      return root_of(*e.of[0]);
    case Kind::index:
      return {root_of(*e.of[0]).variable, e.of[0]->type.is(Type::Kind::pointer) || root_of(*e.of[0]).through};
    case Kind::unary:
      if (e.text == "*") return {root_of(*e.of[0]).variable, true};
      if (e.text == "&") return root_of(*e.of[0]);
      break;
    case Kind::binary:  // a table and an index
      return root_of(*e.of[0]);
    default:
      break;
  }
  fail(e.place, "this is no place to write to, or to point to");
}

void Specialisation::assign(const Expression& to, bool value_varies, const Frames& frames) {
  const auto [root, through] = root_of(to);
  const Expression* place = &to;
  while (place->kind == Kind::member || place->kind == Kind::component) place = place->of[0].get();
  const bool scatters = place->kind == Kind::index && varies(*place->of[1], frames);
  masked |= scatters;
  const bool parted = divergent_return || std::ranges::any_of(frames, &Frame::divergent);
  for (const Expression* at = &to; at->kind == Kind::member; at = at->of[0].get()) {
    const Type& whole = at->arrow ? *at->of[0]->type.of : at->of[0]->type;
    if (whole.structure->member(at->text)->uniform && (value_varies || parted))
      fail(at->place, fmt::format("'{}' is uniform, but is set a lane at a time", at->text));
  }
  const bool has_uniform =
      to.type.is(Type::Kind::structure) && std::ranges::any_of(to.type.structure->members, &Member::uniform);
  if (has_uniform && (through || !between(root, frames).empty()))
    fail(to.place, fmt::format("a {} has uniform members, but is set a lane at a time", to.type.name));
  if (through) {
    if (root->type.is_table()) fail(to.place, "tables are only read");
    if (root->uniform) {
      writes_uniform = true;
      if (value_varies || scatters || parted)
        fail(to.place, fmt::format("'{}' is uniform, but is written a lane at a time", root->name));
      return;
    }
    masked = true;
    if (value_varies || scatters || parted) make_vary(root, to.place, "what is written there varies");
    return;
  }
  if (value_varies || scatters) make_vary(root, to.place, "what it is set to varies");
  if (!between(root, frames).empty()) make_vary(root, to.place, "it is set where lanes part");
}

bool Specialisation::pointee_varies(const Expression& e) const {
  return varying_.contains(root_of(e).variable);
}

bool Specialisation::varies(const Expression& e, const Frames& frames) {
  cost += cost_of(e);
  switch (e.kind) {
    case Kind::number:
    case Kind::constant:
      return false;
    case Kind::variable:
      return varying_.contains(e.variable);
    case Kind::member: {
      bool v = varies(*e.of[0], frames);
      const Type& base = e.of[0]->type;
      if (e.arrow && base.is_own_pointer()) v = pointee_varies(*e.of[0]);
      const Type& whole = e.arrow ? *base.of : base;
      if (v && whole.structure->member(e.text)->uniform) return false;
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
    case Kind::unary:
      if (e.text == "++" || e.text == "--") {
        const bool v = varies(*e.of[0], frames);
        assign(*e.of[0], v, frames);
        return v;
      }
      if (e.text == "*" && e.of[0]->type.is_own_pointer()) return pointee_varies(*e.of[0]);
      return varies(*e.of[0], frames);
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
      bool v = is_by_hand(e.type);
      for (const auto& part : e.of) v |= varies(*part, frames);
      return v;
    }
  }
}

/// Whether the operands vary. Operands right of a varying &&, || or ? are inside a divergent branch.
bool Specialisation::parts_vary(const Expression& e, const Frames& frames) {
  const bool first = varies(*e.of[0], frames);
  bool v = first || is_by_hand(e.type);
  Frames inner = frames;
  if (first && (e.kind == Kind::choose || joins(e.text)))
    inner.push_back({Frame::Kind::branch, nullptr, 0, true, ""});
  for (std::size_t i = 1; i < e.of.size(); ++i) {
    const bool part = varies(*e.of[i], inner);
    masked |= part && i == 1 && (e.text == "/" || e.text == "%") && e.type.is_whole();
    v |= part;
  }
  return v;
}

std::vector<bool> Specialisation::arguments_of(const Expression& call, const Frames& frames) {
  std::vector<bool> vary;
  for (const auto& argument : call.of) vary.push_back(varies(*argument, frames));
  const auto parameters = taken(*call.function);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (is_own_pointer(parameters[i])) vary[i] = varying_.contains(root_of(*call.of[i]).variable);
  if (any_of(vary))  // what is written through pointers varies together with the rest
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (is_own_pointer(parameters[i])) vary[i] = true;
  return vary;
}

bool Specialisation::hand_written_varies(const Expression& e, const std::vector<bool>& vary, const Frames&) {
  const Function& f = *e.function;
  masked |= f.takes_mask;
  const auto parameters = taken(f);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i]->uniform && vary[i] && !parameters[i]->type.is_own_pointer())
      fail(e.of[i]->place,
           fmt::format("{}: '{}' is uniform, but is given what varies", f.name, parameters[i]->name));
    if (is_own_pointer(parameters[i]) && f.uniform && vary[i])
      fail(e.of[i]->place, fmt::format("{} takes what is uniform", f.name));
    if (is_own_pointer(parameters[i]) && !f.uniform && !varies(root_of(*e.of[i]).variable))
      make_vary(root_of(*e.of[i]).variable, e.place, fmt::format("{} takes it a lane each", f.name));
  }
  if (f.uniform && any_of(vary) && std::ranges::none_of(parameters, &Variable::uniform) && !f.takes_mask)
    fail(e.place, fmt::format("{} takes what is uniform", f.name));
  return !f.uniform && !f.result.is(Type::Kind::nothing);
}

bool Specialisation::call_varies(const Expression& e, const Frames& frames) {
  if (!e.function) {
    bool v = false;
    for (const auto& argument : e.of) v |= varies(*argument, frames);
    return v;
  }
  const Function& f = *e.function;
  if (!f.body) {
    std::vector<bool> vary;
    for (const auto& argument : e.of) vary.push_back(varies(*argument, frames));
    cost += 15;
    return hand_written_varies(e, vary, frames);
  }
  std::vector<bool> vary = arguments_of(e, frames);
  const auto parameters = taken(f);
  const bool parted = std::ranges::any_of(frames, &Frame::divergent);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (vary[i] && parameters[i]->uniform && !parameters[i]->type.is_own_pointer())
      fail(e.of[i]->place,
           fmt::format("{}: '{}' is uniform, but is given what varies", f.name, parameters[i]->name));
    if (!is_own_pointer(parameters[i]) || parameters[i]->type.constant) continue;
    // The callee's output varies if an argument varies or the lanes have diverged.
    if (any_of(vary) || parted) {
      make_vary(root_of(*e.of[i]).variable, e.place, fmt::format("{} writes to it", f.name));
      vary[i] = true;
    }
  }
  vary = arguments_of(e, frames);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (is_own_pointer(parameters[i]) && vary[i] && !varies(root_of(*e.of[i]).variable))
      make_vary(root_of(*e.of[i]).variable, e.place, fmt::format("{} takes it with what varies", f.name));
  const Specialisation& called = all_.of(f, vary);
  if (parted && called.writes_uniform)
    fail(e.place, fmt::format("{} writes what is uniform, but is called a lane at a time", f.name));
  writes_uniform |= called.writes_uniform;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (is_own_pointer(parameters[i]) && called.varies(parameters[i]))
      make_vary(root_of(*e.of[i]).variable, e.place, fmt::format("{} writes what varies to it", f.name));
  cost += called.cost;
  masked |= called.masked;
  return called.result_varies;
}

}  // namespace sundog::spmd
