// The interface of a layered material's base: the light that it transmits to the ground, at one roughness, or
// on a grid if a texture sets the roughness or the coat's weight, which affects the roughness.
#pragma once
#include <array>
#include <map>
#include <span>
#include <vector>

#include "compile/layers/facets.h"

namespace sundog {

/// The surroundings of the base's facets, independent of their widths.
struct BaseSurroundings {
  Interface interface;
  double tint;             // largest component of a dielectric's tint
  AlbedoRow above;         // light that coat and fuzz transmit
  double matte_roughness;  // roughness of the ground
};

struct BaseInterface {
  AlbedoRow past;                                               // transmitted light
  double straight, shine_scale, matte_scale, matte_scale_bare;  // members of Layers
};

BaseInterface base_interface(const FacetAlbedo& shine, const BaseSurroundings& around);

/// Widths that kernels accept: at least LEAST_LAYER_ALPHA.
FacetWidths wide_enough(const FacetWidths& widths);

/// The gains at each step of a grid.
using GainGrid = std::array<FacetGains, LAYER_GRID_STEPS>;

/// The table layer_rows under construction. Materials with equal grids share one; materials with equal
/// anisotropy share gains.
struct LayerRows {
  std::vector<float> values;
  std::map<std::vector<double>, u32> grids;
  std::map<double, GainGrid> gains;
};

/// The first entry of the grids by roughness (shared/layers.h) for facets of this anisotropy, one per coat
/// weight in `around`; adds them unless present. Facets never reflect more than all light, neither at a step
/// nor between two.
u32 add_roughness_grids(double anisotropy, std::span<const BaseSurroundings> around, LayerRows& rows);
/// Number of entries of one such grid.
u32 layer_grid_size(double anisotropy);

/// The first entry of the grid by coat weight, for LAYER_GRID_STEPS widths and their surroundings.
u32 add_coat_grid(double anisotropy, std::span<const FacetWidths> widths,
                  std::span<const BaseSurroundings> around, LayerRows& rows);

}  // namespace sundog
