// Emits one function of a leaf. Internal to leaf_code().
#pragma once
#include <array>
#include <map>
#include <tuple>
#include <vector>

#include "compile/fields/sdf_emit.h"
#include "formula/lower.h"
#include "formula/sdf.h"

namespace sundog {

// A leaf's table: these entries, the steps' parameters in order, and numbers derived from those.
namespace leaf_slot {
constexpr int iterations = 0, bailout = 1, inside = 2, safety = 3, inside_safety = 4, level = 5,
              first_parameter = 6;
}

struct LeafTable {
  std::vector<double> values;
  std::map<std::tuple<std::size_t, char, NodeId>, std::size_t> places;  // of numbers, by step and section
};

class LeafEmitter {
 public:
  enum class Variant { distance, two_sided, sample };

  /// `field` and `table`, to which numbers are added, must outlive this.
  LeafEmitter(const FormulaField& field, Variant variant, LeafTable& table);

  FieldCode function();

 private:
  bool escapes() const { return last_->kind == FormulaKind::escape; }
  bool bails_out() const { return escapes() || field_.bailout > 0; }
  bool running() const { return !jacobian_; }
  bool is_sample() const { return variant_ == Variant::sample; }
  /// Only |z| and its derivative at escape are needed, so z may continue to change afterwards.
  bool latched() const { return variant_ == Variant::distance && escapes() && running(); }
  std::size_t components() const { return static_cast<std::size_t>(size_); }

  Operand input(std::size_t step, int index);
  Operand known(std::size_t step, char section, const Graph& graph, NodeId id);
  GraphWriter writer(std::size_t step, const Section& section, std::vector<NodeId> outputs,
                     const char* prefix);
  static Operand slot(int index) { return Operand::table(static_cast<std::size_t>(index)); }

  // The orbit (sdf_leaf_orbit.cpp): z, c and derivatives before the first iteration; one iteration; the loop.
  void start();
  void square(const Operand& r2);
  Operand below_bailout();
  void assign(const Operand& variable, const Operand& value);
  GraphWriter map_writer(std::size_t step);
  void map(std::size_t step, GraphWriter& write);
  /// Emits loop invariants; one writer per step.
  std::vector<GraphWriter> begin_maps();
  /// One iteration; if there are several steps, of the step whose turn it is.
  void iteration(std::vector<GraphWriter>& maps);
  /// Computes dr as the Jacobian's largest stretch.
  Operand derivative_from_jacobian();
  void inner_distance();
  void traps();
  void latched_look();
  void latched_loop();
  void loop();

  // The result (sdf_leaf.cpp).
  void direct();
  /// The gradient of |z| times |z|: J^T z.
  std::array<Operand, 3> gradient_of_length();
  /// Distance of an escaped or stopped orbit; one that never escapes is inside at depth `inner`.
  Operand escape_distance();
  Operand folded_distance(std::array<Operand, 3>* gradient);
  void iterated();

  const FormulaField& field_;
  Variant variant_;
  LeafTable& table_;
  std::vector<LoweredFormula> lowered_;
  std::vector<int> slots_;
  const FormulaDefinition* last_ = nullptr;
  int size_ = 3;
  bool jacobian_ = false, tangents_ = false;

  FieldCode code_;
  std::array<Operand, 4> z_, c_;
  std::array<Operand, 12> t_, c_t_;  // tangents
  Operand dr_, c_slope_, r2_, escaped_r2_, alive_, entered_, late_, inner_;
  Operand point_, plane_, axis_, count_;
};

}  // namespace sundog
