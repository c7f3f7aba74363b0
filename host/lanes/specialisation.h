// Infers, for one kind of call of a function, which values vary between lanes and where masks are needed.
#pragma once
#include <set>

#include "lanes/tree.h"

namespace sundog::spmd {

/// Control flow around a place. In a divergent frame, only some lanes may be active.
struct Frame {
  enum class Kind { branch, loop, round, alike };
  Kind kind = Kind::branch;
  const Statement* node = nullptr;
  bool divergent = false;
  std::string only = {};  // the lanes' condition, for a branch that no lane leaves
};
using Frames = std::vector<Frame>;
bool is_parted(const Frames& frames);
/// The loop that a break or continue in `frames` belongs to, and whether only some lanes take it there.
std::pair<const Statement*, bool> left_loop(const Statement& s, const Frames& frames);

class Specialisations;

/// The results of the analysis.
struct Findings {
  bool result_varies = false, masked = false, divergent_return = false;
  std::set<const Statement*> divergent_break, divergent_continue;
  std::set<const Variable*> varying;
  bool operator==(const Findings&) const = default;
};

class Specialisation : public Findings {
 public:
  /// `given`: which parameters vary.
  Specialisation(Specialisations& all, const Function& function, const std::vector<bool>& given);

  /// Iterates to a fixed point.
  void analyse();

  /// Whether `e` varies. Adds to `cost`; records assignments.
  bool varies(const Expression& e, const Frames& frames);
  bool varies(const Variable* v) const { return varying.contains(v); }
  /// The variable that an lvalue is part of, and whether it is reached through a pointer.
  struct Root {
    const Variable* variable;
    bool through;
  };
  Root root_of(const Expression& e) const;
  /// The divergent control flow between a variable's declaration and `frames`. Excludes loops after which the
  /// lanes that leave never read the variable again.
  std::vector<const Frame*> between(const Variable* v, const Frames& frames);
  void declare(const Variable* v, const Frames& frames);
  /// Which arguments vary in a call.
  std::vector<bool> arguments_of(const Expression& call, const Frames& frames);

  const Function& function;
  std::string name;  // name of the generated function
  bool writes_uniform = false;
  double cost = 0;
  const Variable* only_result = nullptr;  // the variable that every return returns
  std::map<const Variable*, std::string> why;
  std::set<const Specialisation*> calls;
  std::set<const Variable*> set_by_call;  // first used as the OUT argument of a call

 private:
  void statement(const Statement& s, Frames& frames);
  void inside(const Statement& s, const Frame& frame, Frames& frames);
  void loop(const Statement& s, Frames& frames);
  void assign(const Expression& to, bool value_varies, const Frames& frames);
  void make_vary(const Variable* v, const Place& place, const std::string& what);
  bool parts_vary(const Expression& e, const Frames& frames);
  bool call_varies(const Expression& e, const Frames& frames);
  bool hand_written_varies(const Expression& e, const std::vector<bool>& vary);
  void refuse_varying_uniforms(const Expression& call, const std::vector<bool>& vary) const;
  bool pointee_varies(const Expression& e) const { return varies(root_of(e).variable); }
  bool is_dead_after(const Variable* v, const Statement* loop, const Frames& frames, std::size_t from) const;
  void number(const Statement& s, int& at);
  void find_only_result();

  Specialisations& all_;
  std::map<const Variable*, std::size_t> declared_in_;  // number of frames there
  std::map<const Variable*, int> last_use_;             // positions in reading order
  std::map<const Statement*, int> loop_end_;
};

/// A program's specialisations, created on demand.
class Specialisations {
 public:
  Specialisation& of(const Function& f, const std::vector<bool>& varying);
  /// In definition order: callees first.
  const std::vector<Specialisation*>& done() const { return done_; }

 private:
  std::map<std::pair<const Function*, std::vector<bool>>, std::unique_ptr<Specialisation>> made_;
  std::vector<Specialisation*> done_;
};

/// The cost of an expression without its parts; for a call, only that of a built-in function.
double cost_of(const Expression& e);

}  // namespace sundog::spmd
