// Infers, for one kind of call of a function, what varies between lanes and where masks are needed.
#pragma once
#include <set>

#include "lanes/tree.h"

namespace sundog::spmd {

/// Control flow around a place; lanes diverge in a divergent one.
struct Frame {
  enum class Kind { branch, loop, round, alike };
  Kind kind = Kind::branch;
  const Statement* node = nullptr;
  int part = 0;  // of a branch: 0 then, 1 else
  bool divergent = false;
  std::string only;  // of a branch that no lane leaves: the condition of its lanes
};
using Frames = std::vector<Frame>;

class Specialisations;

class Specialisation {
 public:
  /// `varying`: one per parameter.
  Specialisation(Specialisations& all, const Function& function, std::vector<bool> varying);

  /// Iterates to a fixed point.
  void analyse();

  /// Whether `e` varies. Adds to `cost`; records assignments.
  bool varies(const Expression& e, const Frames& frames);
  bool varies(const Variable* v) const { return varying_.contains(v); }
  /// The variable that an lvalue is part of, and whether it is reached through a pointer.
  struct Root {
    const Variable* variable;
    bool through;
  };
  Root root_of(const Expression& e) const;
  /// The divergent control flow between a variable's declaration and `frames`. Excludes loops whose leaving
  /// lanes never read the variable again.
  std::vector<const Frame*> between(const Variable* v, const Frames& frames) const;
  void declare(const Variable* v, const Frames& frames);
  /// Which arguments vary in a call.
  std::vector<bool> arguments_of(const Expression& call, const Frames& frames);

  const Function& function;
  std::string name;         // of the generated function
  std::vector<bool> given;  // which parameters vary
  bool result_varies = false, masked = false, writes_uniform = false;
  double cost = 0;
  bool divergent_return = false;
  std::set<const Statement*> divergent_break, divergent_continue;
  const Variable* only_result = nullptr;  // every return returns it
  std::map<const Variable*, std::string> why;

 private:
  struct Uses {  // positions in reading order
    std::map<const Variable*, int> last;
    std::map<const Statement*, int> end;
  };
  void statement(const Statement& s, Frames& frames);
  void inside(const Statement& s, const Frame& frame, Frames& frames);
  void loop(const Statement& s, Frames& frames);
  void leave(const Statement& s, const Frames& frames);
  void assign(const Expression& to, bool value_varies, const Frames& frames);
  void make_vary(const Variable* v, const Place& place, const std::string& what);
  bool parts_vary(const Expression& e, const Frames& frames);
  bool call_varies(const Expression& e, const Frames& frames);
  bool hand_written_varies(const Expression& e, const std::vector<bool>& vary, const Frames& frames);
  bool pointee_varies(const Expression& e) const;
  bool is_dead_after(const Variable* v, const Statement* loop, const Frames& frames, std::size_t from) const;
  void number(const Statement& s, int& at);
  void number(const Expression& e, int& at);
  void find_only_result();

  Specialisations& all_;
  std::set<const Variable*> varying_;
  std::map<const Variable*, std::vector<std::pair<const Statement*, int>>> declared_in_;
  Uses uses_;
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

/// The cost of an expression that is not a call of the program.
double cost_of(const Expression& e);

}  // namespace sundog::spmd
