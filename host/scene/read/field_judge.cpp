// Surveys each formula in its part of the field; sets the safety that it needs, or warns if the scene sets
// another.
#include "scene/read/field_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "formula/evaluate.h"
#include "formula/survey.h"
#include "scene/read/parts.h"

namespace sundog {
namespace {

using glm::dvec3;

constexpr int most_iterations = 64;  // unless a scene asks for more

std::string text_of(const dvec3& p) { return fmt::format("[{:.3g}, {:.3g}, {:.3g}]", p.x, p.y, p.z); }

/// Rounds down to three digits, so that differences in the last bits between machines vanish.
double rounded_down(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 2);
  return std::floor(x / unit + 1e-9) * unit;
}

/// Judges one formula or hybrid of a scene.
class FormulaJudge {
 public:
  /// `whole`: the formula is the whole field.
  FormulaJudge(FormulaField& field, const JsonValue& value, bool whole)
      : field_(field), value_(value), last_(field.steps.back().definition), whole_(whole) {
    const auto& json = value.json();
    is_own_ = json.contains("map") || json.contains("distance");
    has_safety_ = json.contains("safety");
  }

  void run(const dvec3& lower, const dvec3& upper) {
    const bool escapes = last_.kind == FormulaKind::escape;
    const auto& json = value_.json();
    bool is_changed = is_own_ || json.contains("parameters");
    for (const char* key : {"steps", "iterations", "bailout"}) is_changed |= escapes && json.contains(key);
    // A power's derivative bounds the distance; for a set that only scales, the distance also depends on its
    // size.
    std::optional<double> scale;
    if (is_changed && escapes) scale = FormulaEvaluator(field_).scale();
    const bool closely = is_changed && (!escapes || scale);
    size_ = glm::length(upper - lower);
    if (last_value().json().contains("map") && scale && *scale > 1 &&
        last_.estimate == EscapeEstimate::linear)
      judge_iterations(*scale);
    found_ = survey_formula(field_, lower, upper, closely);
    judge_values(escapes);
    judge_domains();
    if (closely && escapes) judge_estimate();
    if (closely && found_.finite > 0) judge_length();
  }

 private:
  /// With a linear estimate, the solid is thicker than the set by bailout / scale^iterations; by default, at
  /// most by a thousandth of the interval's diagonal.
  void judge_iterations(double scale) {
    const double wanted = std::ceil(std::log(1000 * field_.bailout / size_) / std::log(scale));
    const double thicker = field_.bailout / std::pow(scale, field_.iterations);
    const int enough = wanted < most_iterations ? static_cast<int>(wanted) : most_iterations;
    if (!value_.json().contains("iterations"))
      field_.iterations = std::max(field_.iterations, enough);
    else if (thicker > 0.01 * size_)
      place("iterations")
          .warn(fmt::format("the solid is thicker than the set by about {:.2g}: wanted {} or more, or a "
                            "smaller \"bailout\"",
                            thicker, std::max(enough, field_.iterations + 1)));
  }

  std::string of_points() const { return fmt::format("of {} points of its interval", found_.points); }

  /// The formula's JSON, or that of a hybrid's last step.
  JsonValue last_value() const {
    if (!value_.json().contains("steps")) return value_;
    return value_.member("steps", "").items("")[field_.steps.size() - 1];
  }

  JsonValue place(const char* key) const {
    return value_.json().contains(key) ? value_.member(key, "") : value_;
  }

  void judge_values(bool escapes) {
    if (found_.finite == 0)
      value_.fail(fmt::format("the formula gives a finite distance at none {}", of_points()));
    if (found_.finite < found_.points)
      value_.warn(
          fmt::format("the formula gives no finite distance at {} {}, as at {}: it counts as empty there",
                      found_.points - found_.finite, of_points(), text_of(found_.lost)));
    if (!whole_) return;
    if (escapes && found_.inside == found_.points)
      value_.fail(fmt::format(
          "the formula lets the orbit escape from none {}: the whole interval would be solid (more "
          "\"iterations\" or a smaller \"bailout\" let orbits escape)",
          of_points()));
    if (found_.inside == found_.finite && found_.greatest.value < 0)
      place("distance")
          .warn(fmt::format("the whole interval is inside: the greatest distance found is {:.3g}, at {}; "
                            "where it is above 0, there is nothing",
                            found_.greatest.value, text_of(found_.greatest.at)));
    // Thin sheets may lie between the points, but the estimate is small near them.
    if (found_.inside == 0 && found_.least.value > (escapes ? 0.01 : 1e-3) * size_)
      place("distance")
          .warn(fmt::format("the interval holds no surface: the least distance found is {:.3g}, at {}",
                            found_.least.value, text_of(found_.least.at)));
  }

  void judge_domains() {
    std::size_t told = 0;
    for (const DomainBreach& b : found_.breaches) {
      if (++told > 3) return;
      JsonValue own = value_;
      if (value_.json().contains("steps")) own = value_.member("steps", "").items("")[b.step];
      if (own.json().contains(b.section)) own = own.member(b.section, "");
      own.warn(
          fmt::format("line {}, column {}: {} is asked for {:.3g} at {}, which it is not defined for ({} {} "
                      "are like that): it takes {:g} instead",
                      b.guard.line, b.guard.column, b.guard.function, b.value, text_of(b.at), b.count,
                      of_points(), b.value < b.guard.low ? b.guard.low : b.guard.high));
    }
  }

  /// Warns of a map that scales: there, r log r / (2 dr) exceeds the distance, so that steps must be short.
  void judge_estimate() {
    const JsonValue last = last_value();
    if (last_.estimate == EscapeEstimate::logarithmic && last.json().contains("map") &&
        !last.json().contains("estimate") && !has_safety_)
      last.member("map", "").warn(
          "far points' lengths grow in proportion, not by a power: the logarithmic estimate is too long; "
          "set \"estimate\": \"linear\", with so many \"iterations\" that orbits escape");
  }

  /// The largest safety not contradicted by the survey.
  double bearable_safety() const {
    const bool is_distance = is_own_ && !last_.normalize && found_.is_bounded && found_.steepest.value > 0;
    double safety = field_.safety;
    if (is_distance && last_.kind == FormulaKind::direct) {
      const double slope = found_.steepest.value;
      safety = slope > 1.01 || slope < 0.5 ? 0.98 / slope : 1;
    } else if (is_distance && found_.steepest.value > 1.01) {
      safety = std::min(safety, 0.98 / found_.steepest.value);
    }
    const double reached = found_.reach.value * field_.safety;
    if (found_.reach.value < 0.98 && safety > reached)
      safety = 0.75 * reached;  // worse points lie between those found
    return last_.kind == FormulaKind::escape ? std::max(safety, 0.1) : safety;  // tears lower it no further
  }

  std::string reason() const {
    const bool is_steep = is_own_ && last_.kind != FormulaKind::escape && !last_.normalize &&
                          found_.is_bounded && (found_.steepest.value > 1.01 || found_.steepest.value < 0.5);
    if (is_steep)
      return fmt::format("changes by {:.3g} a unit of length{} at {}, where a distance changes by 1",
                         found_.steepest.value, last_.kind == FormulaKind::folded ? " of z" : "",
                         text_of(found_.steepest.at));
    return fmt::format("is too long at {}: the surface is {:.3g} times as far away or less",
                       text_of(found_.reach.at), found_.reach.value);
  }

  void judge_length() {
    const double bearable = bearable_safety();
    if (is_own_ && !has_safety_ && bearable < 0.02 && found_.reach.value < 0.02 &&
        bearable < found_.reach.value)
      place("distance")
          .fail(fmt::format("the distance jumps, or grows steeper without bound, near {}, where the surface "
                            "is {:.2g} times as far away: no step is short enough for it ({}a \"safety\" "
                            "that is set is taken as it is)",
                            text_of(found_.reach.at), found_.reach.value,
                            last_.normalize ? "" : "\"normalize\": true divides it by its gradient; "));
    if (bearable > 0.97 * field_.safety && bearable < 1.5 * field_.safety) return;
    if (has_safety_) {
      if (bearable < field_.safety)
        value_.member("safety", "")
            .warn(fmt::format(
                "the distance {}; a \"safety\" of {:g} or less fits, found {:g}: there may be holes",
                reason(), rounded_down(bearable), field_.safety));
      return;
    }
    if (bearable > field_.safety && last_.kind != FormulaKind::direct) return;
    field_.safety = rounded_down(bearable);
    const std::string mend = !is_own_ || last_.kind != FormulaKind::direct || last_.normalize
                                 ? fmt::format("\"safety\": {:g}", field_.safety)
                                 : fmt::format("a factor of {:g} in the expression, or \"safety\": {:g}",
                                               field_.safety, field_.safety);
    place("distance")
        .warn(fmt::format("the distance {}; it is taken times {:g} ({} says the same)", reason(),
                          field_.safety, mend));
  }

  FormulaField& field_;
  const JsonValue& value_;
  const FormulaDefinition& last_;
  bool whole_, is_own_ = false, has_safety_ = false;
  double size_ = 0;
  FormulaSurvey found_;
};

/// Replaces a box of the transformed field by the box around it in the child's space.
void into_child(const SdfNode& node, dvec3& lower, dvec3& upper) {
  dvec3 low(1e30), high(-1e30);
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 p(corner & 1 ? upper.x : lower.x, corner & 2 ? upper.y : lower.y,
                  corner & 4 ? upper.z : lower.z);
    const dvec3 q = glm::transpose(node.rotation) * (p - node.offset) / node.scale;
    low = glm::min(low, q);
    high = glm::max(high, q);
  }
  lower = low;
  upper = high;
}

/// Limits the box to a repeated field's own cell and half of the next.
void into_cell(const SdfNode& node, dvec3& lower, dvec3& upper) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(node.period[axis] > 0)) continue;
    const double beyond = node.count[axis] > 0 ? node.count[axis] * node.period[axis] : 0;
    lower[axis] = std::min(std::max(lower[axis] + beyond, -node.period[axis]), -0.5 * node.period[axis]);
    upper[axis] = std::max(std::min(upper[axis] - beyond, node.period[axis]), 0.5 * node.period[axis]);
  }
}

bool is_solid(const JsonValue& value) {
  const auto type = value.json().find("type");
  const Names solids = solid_types();
  return type != value.json().end() && type->is_string() &&
         std::find(solids.begin(), solids.end(), type->get<std::string>()) != solids.end();
}

void judge_node(SdfNode& node, const JsonValue& value, dvec3 lower, dvec3 upper, bool whole) {
  if (is_solid(value)) return;  // an exact distance
  if (node.kind == SdfNode::Kind::formula) return FormulaJudge(node.formula, value, whole).run(lower, upper);
  if (node.kind == SdfNode::Kind::transform) into_child(node, lower, upper);
  if (node.kind == SdfNode::Kind::repeat) into_cell(node, lower, upper);
  if (node.children.size() == 1) {
    judge_node(node.children[0], value.member("field", ""), lower, upper, false);
  } else if (!node.children.empty()) {
    const auto items = value.member("fields", "").items("fields");
    for (std::size_t i = 0; i < node.children.size(); ++i)
      judge_node(node.children[i], items[i], lower, upper, false);
  }
}

}  // namespace

void judge_field(SdfNode& root, const JsonValue& value, const dvec3& lower, const dvec3& upper) {
  judge_node(root, value, lower, upper, true);
}

void judge_cut(const FormulaField& formula, const JsonValue& value, const dvec3& lower, const dvec3& upper) {
  const auto& json = value.json();
  if (!json.contains("map") && !json.contains("distance")) return;
  constexpr int steps = 16;
  FormulaEvaluator evaluator(formula);
  for (int face = 0; face < 6; ++face)
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; j <= steps; ++j) {
        const int axis = face / 2;
        dvec3 part(face % 2);
        part[(axis + 1) % 3] = double(i) / steps;
        part[(axis + 2) % 3] = double(j) / steps;
        const dvec3 p = lower + part * (upper - lower);
        if (!evaluator.at(p).inside) continue;
        value.warn(
            fmt::format("the solid reaches the boundary of the interval from {:g} to {:g} that a formula has "
                        "by default, as at {}, and is cut there; set \"interval\"",
                        lower.x, upper.x, text_of(p)));
        return;
      }
}

}  // namespace sundog
