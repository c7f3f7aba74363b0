// The interface of a layered material's base: what it leaves for the ground, at one roughness, and at a grid
// of them where a texture gives the roughness, or the coat's weight, which the roughness below it depends on.
#pragma once
#include <array>
#include <map>
#include <span>
#include <vector>

#include "compile/layers/facets.h"

namespace sundog {

/// What the base's facets have about them, whatever their widths.
struct BaseSurroundings {
  Interface interface;
  double tint;             // the greatest part of a dielectric's
  AlbedoRow above;         // what coat and fuzz pass
  double matte_roughness;  // of the ground
};

struct BaseInterface {
  AlbedoRow past;                                               // what it passes
  double straight, shine_scale, matte_scale, matte_scale_bare;  // members of Layers
};

BaseInterface base_interface(const FacetAlbedo& shine, const BaseSurroundings& around);

/// Widths that the kernels take: none is below LEAST_LAYER_ALPHA.
FacetWidths wide_enough(const FacetWidths& widths);

/// Of each step of a grid.
using GainGrid = std::array<FacetGains, LAYER_GRID_STEPS>;

/// The table layer_rows while it is made: materials whose grids are the same share one, those of the same
/// anisotropy its gains.
struct LayerRows {
  std::vector<float> values;
  std::map<std::vector<double>, u32> grids;
  std::map<double, GainGrid> gains;
};

/// The first number of the grids by roughness (shared/layers.h) of facets of this anisotropy, one for each
/// weight of the coat, where they have `around` about them; they are added unless they are there. No step's
/// facets return more than all light, nor do those between two steps.
u32 add_roughness_grids(double anisotropy, std::span<const BaseSurroundings> around, LayerRows& rows);
/// Numbers of one such grid.
u32 layer_grid_size(double anisotropy);

/// The same of the grid by the coat's weight: of LAYER_GRID_STEPS widths, and of what lies about them.
u32 add_coat_grid(double anisotropy, std::span<const FacetWidths> widths,
                  std::span<const BaseSurroundings> around, LayerRows& rows);

}  // namespace sundog
