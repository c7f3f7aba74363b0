// A lathe's profile in unit space: the rows that kernels read, and geometry in double precision.
#pragma once
#include <vector>

#include "models/values/profile.h"
#include "shared/shapes.h"

namespace sundog {

using glm::dvec2;
using glm::dvec3;

inline bool operator==(const ProfileArc& a, const ProfileArc& b) {
  return a.r == b.r && a.y == b.y && a.end == b.end && a.along == b.along;
}

class Revolution {
 public:
  /// `scale`: from unit to object space. `closed`: encloses a solid.
  Revolution(const std::vector<ProfileCubic>& profile, bool closed, double scale);

  const std::vector<ProfileArc>& arcs() const { return arcs_; }
  /// The maximum of across * radius + along * height over the profile.
  double reach(double across, double along) const;
  /// The distance of a point from the surface, negative inside; a sheet has no inside.
  double distance(const dvec3& q) const;
  /// The greatest principal curvature on the parts of the profile that may come within `within` of `near`;
  /// infinite at a cone's tip.
  double greatest_curvature(const dvec3& near, double within) const;
  /// Heights and outer radii of flat rings (x: radius).
  std::vector<dvec2> rings() const;

 private:
  std::vector<ProfileCubic> parts_;  // monotone
  std::vector<ProfileArc> arcs_;
  std::vector<double> curvatures_;  // greatest curvature of each part
  bool closed_;
};

}  // namespace sundog
