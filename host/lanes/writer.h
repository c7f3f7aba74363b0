// Emits one specialisation in the vocabulary of kernels/lib/core/lanes.h; masks follow control flow. Cheap
// branches are computed in all lanes, others skipped if no lane takes them.
//   m_, m_2, ...   active lanes of the function, of a branch
//   in_3, go_4     lanes still in a loop; in its current round
#pragma once
#include <functional>

#include "lanes/specialisation.h"

namespace sundog::spmd {

struct Line {
  int depth;
  std::string text;
  Place place;
};

class Writer {
 public:
  Writer(Specialisations& all, Specialisation& made);

  std::vector<Line> function();
  /// The structures in use, for one path (false) and in lanes.
  using Structures = std::set<std::pair<const Structure*, bool>>;
  const Structures& structures() const { return structures_; }

  /// The text of a structure and its helpers for lanes.
  std::vector<std::string> structure(const Structure& s, bool in_lanes);
  std::vector<std::string> spread_structure(const Structure& s);
  std::string type_text(const Type& type, bool varying);
  std::string selected(const Type& type, const std::string& a, const std::string& b, const std::string& mask,
                       const Place& place);

 private:
  struct Loop {
    const Statement* node;
    std::string going, lanes;
  };
  using Write = std::function<std::string()>;

  void line(std::string text);
  std::string fresh(const char* stem);
  bool varies(const Expression& e);

  // Expressions (write_expressions.cpp).
  std::string value(const Expression& e);  // unchanged: for one lane or all
  std::string lanes(const Expression& e);  // one value per lane
  std::string plain(const Expression& e);  // of a uniform expression
  std::string varying(const Expression& e);
  std::string varying_cast(const Expression& e);
  std::string varying_unary(const Expression& e);
  std::string varying_binary(const Expression& e);
  std::string varying_vector_binary(const Expression& e);
  std::string varying_choice(const Expression& e);
  std::string varying_element(const Expression& e);
  std::string parts_of(const Expression& e);
  std::string mask_of(const Expression& e);  // a condition
  std::string place_of(const Expression& e);
  std::string spread(const std::string& text, const Expression& e);
  std::string simple(const Expression& e);  // may be repeated
  std::string under(const std::string& mask, const Write& write);
  bool is_guarded(const Expression& e);
  bool writes(const Expression& e) const;

  // Memory and calls (write_memory.cpp).
  bool is_gathered(const Expression& e);
  std::string index_of(const Expression& e);
  std::string gather(const Expression& e, int extra = 0, bool whole = true);
  std::pair<std::string, std::string> table_and_index(const Expression& e);
  std::string call(const Expression& e);
  std::string built_in(const Expression& e);
  std::string hand_written(const Expression& e);
  std::string argument(const Expression& e, const Variable& parameter, bool takes_mask);
  std::string pointed(const Expression& e);

  // Statements (write_statements.cpp).
  void statement(const Statement& s);
  void block(const std::vector<const Statement*>& all, bool in_loop);
  void declaration(const Statement& s);
  void declaration(const Variable& v, const Expression* first);
  std::string nothing(const Type& type);
  std::string computed(const Expression& e);
  std::string assigned(const Expression& e);
  std::string stepped(const Expression& e);
  std::string store(const Expression& to, const std::string& value);
  std::string scatter(const Expression& to, const std::string& value);
  void branch(const Statement& s);
  void feature_branch(const Statement& s);
  void inside(Frame frame, const std::string& mask, const Statement& s);
  void drop_unused(std::size_t line_at, const std::string& name);
  void leave(const Statement& s);
  void give(const Statement& s);
  void each_alike(const Statement& s);
  bool is_long(const std::vector<const Statement*>& all, std::size_t from);
  bool comes_again() const;
  const Loop* divergent_loop() const;
  std::string alive() const;
  double weight(const Statement& s);
  double weight(const Expression& e);

  // Loops (write_loops.cpp).
  void loop(const Statement& s);
  void loop_head(const Statement& s, const std::vector<std::string>& tests, const std::string& step,
                 std::vector<Line>& asked);

  Specialisations& all_;
  Specialisation& s_;
  Structures structures_;
  std::vector<Line> out_;
  int depth_ = 1, count_ = 0;
  std::string mask_;
  Frames frames_;
  std::vector<Loop> loops_;      // left by lanes at different times
  std::vector<Loop> all_loops_;  // all, including the others
  bool returned_ = false;
  std::map<const Variable*, std::string> tables_;  // for pointers kept as an index
  std::set<std::string> checked_;                  // of loops whose body tests them first
  Place place_;
};

/// The statements of a block, or the single statement.
std::vector<const Statement*> parts_of_block(const Statement& s);

/// The ways in which a statement leaves its surroundings.
struct Exits {
  bool leaves = false, next = false, gives = false;
  bool any() const { return leaves || next || gives; }
};
Exits exits_of(const Statement& s);
bool has_loop(const Statement& s);
/// Whether `text` has `name`, which ends in a number.
bool mentions(const std::string& text, const std::string& name);

}  // namespace sundog::spmd
