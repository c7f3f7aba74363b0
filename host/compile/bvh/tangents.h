// Tangents of meshes for normal maps.
#pragma once
#include <vector>

#include "compile/steps.h"

namespace sundog {

/// A tangent in object space, and whether the bitangent is opposite to cross(normal, tangent).
struct CornerTangent {
  dvec3 tangent;
  bool mirrored;
};

/// Tangents at the corners of each triangle.
std::vector<CornerTangent> corner_tangents(const Mesh& mesh);

/// Packed corner_tangents() of all meshes, if surfaces have relief.
SharedTable<u32> tangents_of(const MappingInputs& in);

}  // namespace sundog
