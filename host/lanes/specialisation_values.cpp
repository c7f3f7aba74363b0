// Which values vary: expressions, what is assigned, calls.
#include "lanes/specialisation.h"

namespace sundog::spmd {
namespace {

using Kind = Expression::Kind;

bool any_of(const std::vector<bool>& all) { return std::ranges::find(all, true) != all.end(); }

}  // namespace

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
  const bool parted = divergent_return || is_parted(frames);
  for (const Expression* at = &to; at->kind == Kind::member; at = at->of[0].get())
    if (at->whole().structure->member(at->text)->uniform && (value_varies || parted))
      fail(at->place, "'{}' is uniform, but is set a lane at a time", at->text);
  const bool has_uniform =
      to.type.is_structure() && std::ranges::any_of(to.type.structure->members, &Member::uniform);
  if (has_uniform && (through || !between(root, frames).empty()))
    fail(to.place, "a {} has uniform members, but is set a lane at a time", to.type.name);
  if (!through) {
    if (value_varies || scatters) make_vary(root, to.place, "what it is set to varies");
    if (!between(root, frames).empty()) make_vary(root, to.place, "it is set where lanes part");
    return;
  }
  if (root->type.is_table()) fail(to.place, "tables are only read");
  const bool by_lanes = value_varies || scatters || parted;
  if (root->uniform && by_lanes)
    fail(to.place, "'{}' is uniform, but is written a lane at a time", root->name);
  writes_uniform |= root->uniform;
  masked |= !root->uniform;
  if (by_lanes) make_vary(root, to.place, "what is written there varies");
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
      if (e.whole().structure->member(e.text)->uniform) return false;
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
  Frames inner = frames;
  if (first && (e.kind == Kind::choose || joins(e.text)))
    inner.push_back({Frame::Kind::branch, nullptr, true});
  for (std::size_t i = 1; i < e.of.size(); ++i) {
    const bool part = varies(*e.of[i], inner);
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
  if (any_of(vary))  // what is written through pointers varies together with the rest
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
  if (parted && called.writes_uniform)
    fail(e.place, "{} writes what is uniform, but is called a lane at a time", f.name);
  writes_uniform |= called.writes_uniform;
  vary_if([&](std::size_t i) { return called.varies(f.taken[i]); }, "writes what varies to it");
  cost += called.cost;
  masked |= called.masked;
  return called.result_varies;
}

}  // namespace sundog::spmd
