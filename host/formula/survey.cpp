// Samples points, climbs from the best ones, and compares estimates with distances to surface points found by
// bisection.
#include "formula/survey.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace sundog {
namespace {

using glm::dvec3;

class Surveyor {
 public:
  Surveyor(const FormulaField& field, const dvec3& lower, const dvec3& upper)
      : evaluator_(field), lower_(lower), upper_(upper), size_(glm::length(upper - lower)) {
    found_.least.value = std::numeric_limits<double>::infinity();
    found_.greatest.value = -found_.least.value;
  }

  FormulaSurvey run(bool closely) {
    sample();
    if (found_.finite == 0) return found_;
    const auto distance = [&](const dvec3& p) { return evaluator_.at(p).distance; };
    if (found_.inside == 0)
      found_.least =
          climb([&](const dvec3& p) { return -distance(p); }, found_.least.at, -found_.least.value);
    found_.least.value = found_.inside == 0 ? -found_.least.value : found_.least.value;
    if (found_.inside == found_.points)
      found_.greatest = climb(distance, found_.greatest.at, found_.greatest.value);
    if (closely) {
      find_steepest();
      find_reach();
    }
    return found_;
  }

 private:
  struct Sample {
    dvec3 p;
    FieldValue value;
  };

  void sample() {
    constexpr std::size_t operations = 200000;
    found_.points = static_cast<int>(std::clamp<std::size_t>(operations / (evaluator_.cost() + 1), 64, 1024));
    for (int i = 0; i < found_.points; ++i) {
      // An additive sequence with powers of the plastic number (M. Roberts, 2018), which leaves no gaps.
      const double n = i + 0.5;
      const dvec3 place = glm::fract(n * dvec3(0.8191725134, 0.6710436067, 0.5497004779));
      const dvec3 p = glm::mix(lower_, upper_, place);
      const FieldValue value = evaluator_.at(p);
      if (!(std::abs(value.distance) < 1e30)) {  // as finite_distance() of lib/sdf/sample.h
        if (found_.finite == i) found_.lost = p;
        continue;
      }
      ++found_.finite;
      found_.inside += value.inside;
      if (value.distance < found_.least.value) found_.least = {value.distance, p};
      if (value.distance > found_.greatest.value) found_.greatest = {value.distance, p};
      samples_.push_back({p, value});
    }
    for (const DomainBreach& breach : evaluator_.breaches())
      if (breach.count > 0) found_.breaches.push_back(breach);
  }

  double spacing() const { return size_ / std::cbrt(static_cast<double>(found_.points)); }

  /// Hill climbing along the axes; the step halves when no direction improves.
  PlacedValue climb(const std::function<double(const dvec3&)>& f, const dvec3& from, double value) {
    PlacedValue best{value, from};
    double step = 0.5 * spacing();
    for (int round = 0; round < 48 && step > 1e-9 * size_; ++round) {
      PlacedValue next = best;
      for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
          dvec3 p = best.at;
          p[axis] = std::clamp(p[axis] + sign * step, lower_[axis], upper_[axis]);
          const double here = f(p);
          if (here > next.value) next = {here, p};
        }
      if (next.value > best.value)
        best = next;
      else
        step *= 0.5;
    }
    return best;
  }

  void find_steepest() {
    std::vector<Sample> steep = samples_;
    const std::size_t starts = std::min<std::size_t>(4, steep.size());
    std::partial_sort(steep.begin(), steep.begin() + static_cast<std::ptrdiff_t>(starts), steep.end(),
                      [](const Sample& a, const Sample& b) { return a.value.slope > b.value.slope; });
    const double sampled = steep[0].value.slope;
    if (sampled == 0) return;
    for (std::size_t i = 0; i < starts; ++i) {
      const PlacedValue top =
          climb([&](const dvec3& p) { return evaluator_.at(p).slope; }, steep[i].p, steep[i].value.slope);
      if (top.value > found_.steepest.value) found_.steepest = top;
    }
    found_.is_bounded = found_.steepest.value < 8 * sampled;  // near a pole it grows without bound
  }

  /// Bisects between a point inside and one outside.
  dvec3 surface_between(dvec3 inside, dvec3 outside) {
    for (int i = 0; i < 24; ++i) {
      const dvec3 middle = 0.5 * (inside + outside);
      (evaluator_.at(middle).inside ? inside : outside) = middle;
    }
    return inside;
  }

  void find_reach() {
    std::vector<dvec3> inside, surface;
    std::vector<Sample> outside;
    if (found_.inside == 0 && found_.least.value < 0) inside.push_back(found_.least.at);
    for (const Sample& s : samples_)
      if (s.value.inside)
        inside.push_back(s.p);
      else
        outside.push_back(s);
    if (inside.empty() || outside.empty()) return;
    for (std::size_t i = 0; i < 48; ++i) {
      const dvec3 from = outside[i * 7 % outside.size()].p;  // a copy: more are added below
      const dvec3 at = surface_between(inside[i % inside.size()], from);
      surface.push_back(at);
      for (const double away : {1e-4, 1e-3, 0.01, 0.05}) {  // also nearby, where marches end
        const dvec3 p = at + away * size_ * glm::normalize(from - at);
        if (glm::any(glm::lessThan(p, lower_)) || glm::any(glm::greaterThan(p, upper_))) continue;
        outside.push_back({p, evaluator_.at(p)});
      }
    }
    for (const Sample& s : outside)
      for (const dvec3& at : surface) {
        const double way = glm::distance(s.p, at);
        if (way < found_.reach.value * s.value.distance && way > 1e-6 * size_)
          found_.reach = {way / s.value.distance, s.p};
      }
  }

  FormulaEvaluator evaluator_;
  dvec3 lower_, upper_;
  double size_;
  FormulaSurvey found_;
  std::vector<Sample> samples_;
};

}  // namespace

FormulaSurvey survey_formula(const FormulaField& field, const dvec3& lower, const dvec3& upper,
                             bool closely) {
  return Surveyor(field, lower, upper).run(closely);
}

}  // namespace sundog
