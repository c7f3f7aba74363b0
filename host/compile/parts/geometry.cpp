// Texture coordinates, alpha and tangents that textures need.
#include "compile/parts/steps.h"
#include "compile/textures.h"

namespace sundog {

MeshMapping compile_mapping(const MappingInputs& in) {
  return {further_uvs(in), vertex_alphas(in), tangents_of(in)};
}

}  // namespace sundog
