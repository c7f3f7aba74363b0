// Writes one function of a leaf: what is shared by its parts. Internal to leaf_code().
#pragma once
#include <string>
#include <vector>

#include "compile/fields/sdf_emit.h"
#include "scene/formula/lower.h"
#include "scene/formula/sdf.h"

namespace sundog {

// The table of a leaf: these, then the parameters of its steps in order.
namespace leaf_slot {
constexpr int iterations = 0, bailout = 1, inside = 2, safety = 3, inside_safety = 4, level = 5,
              first_parameter = 6;
}

/// The names of z's components in the code.
inline constexpr const char* z_names[4] = {"zx", "zy", "zz", "zw"};

class LeafEmitter {
 public:
  enum class Variant { distance, two_sided, sample };

  /// `field` must outlive it.
  LeafEmitter(const FormulaField& field, Variant variant);

  std::string function();

 private:
  bool escapes() const { return last_->kind == FormulaKind::escape; }
  bool bails_out() const { return escapes() || field_.bailout > 0; }
  bool running() const { return !jacobian_; }
  /// Only |z| and its derivative at the escape are wanted: z itself may run on.
  bool latched() const { return variant_ == Variant::distance && escapes() && running(); }

  std::string input(std::size_t step, int index) const;
  GraphPrinter printer(std::size_t step, const Section& section, std::vector<NodeId> outputs,
                       const char* prefix) const;
  std::string square() const;

  // The orbit (sdf_leaf_orbit.cpp): z, c and derivatives before the first iteration; one iteration; all.
  struct MapCode {
    std::string before, inside;
  };
  std::string start();
  std::string assign(const std::string& name, const std::string& value) const;
  MapCode map(std::size_t step);
  /// One iteration: the only step, or the step whose turn it is.
  MapCode iteration();
  /// dr from the Jacobian: the most that lengths grow in any direction.
  std::string derivative_from_jacobian() const;
  std::string inner_distance() const;
  std::string traps() const;
  std::string latched_loop();
  std::string loop();

  // What comes of it (sdf_leaf.cpp).
  std::string direct();
  /// The gradient of |z| times |z|: J^T z.
  std::string gradient_of_length() const;
  /// Distance of an orbit that escaped or was ended; one that stays is inside, as deep as `inner`.
  std::string escape_distance() const;
  std::string folded_distance(std::string* gradient);
  std::string iterated();

  const FormulaField& field_;
  Variant variant_;
  std::vector<LoweredFormula> lowered_;
  std::vector<int> slots_;
  const FormulaDefinition* last_ = nullptr;
  int size_ = 3;
  bool jacobian_ = false, tangents_ = false;
};

}  // namespace sundog
