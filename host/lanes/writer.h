// Emits one specialisation in the vocabulary of kernels/lib/core/lanes.h; masks follow control flow. Cheap
// branches are computed in all lanes, others skipped if no lane takes them.
//   m_, m_2, ...   active lanes of the function, of a branch
//   in_3, go_4     lanes still in a loop; in its current round
#pragma once
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

  /// The text of a structure, and its functions for lanes.
  std::vector<Line> structure(const Structure& s, bool in_lanes);
  std::vector<Line> spread_structure(const Structure& s);

 private:
  struct Loop {
    const Statement* node;
    std::string going, lanes;
    bool masked;           // lanes leave it at different times
    bool checked = false;  // its body first tests whether any lane is left
  };
  using Write = std::function<std::string()>;

  void line(std::string text) { out_.push_back({depth_, std::move(text), place_}); }
  template <class First, class... Others>
  void line(fmt::format_string<const First&, const Others&...> text, const First& first,
            const Others&... others) {
    line(fmt::format(text, first, others...));
  }
  void directive(std::string text) { out_.push_back({0, std::move(text), {}}); }
  std::string fresh(const char* stem) { return fmt::format("{}_{}", stem, ++count_); }
  bool varies(const Expression& e);
  std::string type_text(const Type& type, bool varying);

  template <class Text>
  void member_lines(const Structure& s, const std::string& head, const Text& text, const char* end);
  template <class Text>
  std::vector<Line> structure_function(const Structure& s, const std::string& head, const Text& text);

  // Expressions (write_expressions.cpp).
  std::string value(const Expression& e);  // one value, or one per lane if it varies
  std::string lanes(const Expression& e);  // one value per lane
  std::string varying_cast(const Expression& e);
  std::string varying_binary(const Expression& e);
  std::string varying_vector_binary(const Expression& e);
  std::string parts_of(const Expression& e, std::string_view wanted = "");
  std::string spread(const std::string& text, const Type& type);
  std::string simple(const Expression& e);  // text that may be repeated

  std::string mask_of(const Expression& e);
  std::string joined_masks(const Expression& e);
  std::string varying_choice(const Expression& e);
  std::string selected(const Type& type, const std::string& a, const std::string& b, const std::string& mask,
                       const Place& place);
  std::string under(const std::string& mask, const Write& write);
  bool is_guarded(const Expression& e);

  // Memory and calls (write_memory.cpp).
  bool is_gathered(const Expression& e);
  std::string index_of(const Expression& e);
  std::string gather(const Expression& e, std::size_t part = 0);
  std::pair<std::string, std::string> table_and_index(const Expression& e);
  std::pair<std::string, std::string> place_in_lane(const Expression& e, const std::string& lane);
  std::string element(const Expression& e);
  std::string scatter(const Expression& to, const std::string& value);
  std::string call(const Expression& e);
  std::string hand_written(const Expression& e);
  std::string pointed(const Expression& e);

  // Statements (write_statements.cpp).
  void statement(const Statement& s);
  void block(const std::vector<StatementPtr>& all, bool in_loop);
  void declaration(const Variable& v, const Expression* first);
  std::string nothing(const Type& type);
  std::string computed(const Expression& e);
  std::string store(const Expression& to, const std::string& value);
  void branch(const Statement& s);
  void inside(const Frame& frame, std::string mask, const Statement& s);
  void drop_unused(std::size_t line_at, const std::string& name);
  bool is_long(const std::vector<StatementPtr>& all, std::size_t from);
  bool comes_again() const;
  std::string alive() const;  // the remaining lanes
  double weight(const Statement& s);
  double weight(const Expression& e);

  // Loops (write_loops.cpp).
  void loop(const Statement& s);
  void leave(const Statement& s);
  void give(const Statement& s);
  void each_alike(const Statement& s);

  Specialisations& all_;
  Specialisation& s_;
  Structures structures_;
  std::vector<Line> out_;
  int depth_ = 1, count_ = 0;
  std::string mask_;
  Frames frames_;
  std::vector<Loop> loops_;
  bool returned_ = false;
  std::map<const Variable*, std::string> tables_;  // for pointers kept as an index
  Place place_;
};

/// The texts of `all`, separated by commas.
template <class All, class Text>
std::string joined(const All& all, const Text& text) {
  std::string out;
  for (const auto& one : all) out += (out.empty() ? "" : ", ") + text(one);
  return out;
}

/// The ways in which a statement leaves its surroundings, and whether it has a loop.
struct Exits {
  bool leaves = false, next = false, gives = false, loops = false;
  bool any() const { return leaves || next || gives; }
};
Exits exits_of(const Statement& s);
/// Whether `text` has `name`, which ends in a number.
bool mentions(const std::string& text, const std::string& name);

}  // namespace sundog::spmd
