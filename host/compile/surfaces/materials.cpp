// Packs materials with flags derived from their values, merges equal media, adds scattering fog to the
// world's medium, and tabulates dispersion for paths.
#include "compile/surfaces/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "base/error.h"
#include "compile/surfaces/textures.h"
#include "models/values/refraction.h"
#include "scene/integrators.h"
#include "scene/pack.h"
#include "scene/spectra/upsample.h"
#include "shared/spectra.h"

namespace sundog {
namespace {

constexpr std::size_t rows = SPECTRUM_ROWS;

std::vector<float> columns_of_colors() {
  std::vector<float> table(SPECTRUM_COLUMNS * rows);
  for (std::size_t i = 0; i < rows; ++i) {
    for (int c = 0; c < 3; ++c)
      table[(SPECTRUM_RED + static_cast<std::size_t>(c)) * rows + i] =
          static_cast<float>(rgb_weights()[i][c]);
    table[SPECTRUM_OF_RED * rows + i] = static_cast<float>(spectral_basis()[i].x);
    table[SPECTRUM_OF_BLUE * rows + i] = static_cast<float>(spectral_basis()[i].z);
  }
  return table;
}

/// The table `spectra` of a scene: colours of wavelengths, basis spectra of red and blue, and refractive
/// indices of dispersive media.
class SpectraMaker {
 public:
  /// Only paths carry wavelengths; without them the table stays empty.
  explicit SpectraMaker(bool paths) : used_(paths) {}

  /// The offset of a medium's indices, shared by equal dispersions; NO_SPECTRUM without dispersion.
  u32 add(const Dispersion& dispersion) {
    if (!used_ || dispersion.kind == DispersionKind::none) return NO_SPECTRUM;
    const auto found = std::ranges::find(added_, dispersion);
    const auto index = static_cast<std::size_t>(found - added_.begin());
    if (found == added_.end()) {
      if (table_.empty()) table_ = columns_of_colors();
      for (std::size_t i = 0; i < rows; ++i) {
        const double wavelength =
            static_cast<double>(SPECTRUM_FIRST) + static_cast<double>(SPECTRUM_STEP) * static_cast<double>(i);
        table_.push_back(static_cast<float>(index_at(dispersion, 1, wavelength)));
      }
      added_.push_back(dispersion);
    }
    return static_cast<u32>((SPECTRUM_COLUMNS + index) * rows);
  }

  std::vector<float> take_table() { return std::move(table_); }

 private:
  bool used_;
  std::vector<Dispersion> added_;
  std::vector<float> table_;
};

bool is_zero(const dvec3& color) { return color == dvec3(0); }

Medium make_medium(const MediumDescription& medium) {
  Medium packed{};
  packed.absorption = pack(medium.absorption + medium.scattering, medium.ior);
  packed.scattering = pack(medium.scattering, medium.anisotropy);
  packed.priority = medium.priority;
  return packed;
}

bool same(const Medium& a, const Medium& b) {
  return a.absorption == b.absorption && a.scattering == b.scattering && a.priority == b.priority &&
         a.spectrum == b.spectrum;
}

/// The world's medium, including fog that scatters.
MediumDescription world_medium(const SurfaceInputs& in) {
  MediumDescription medium = in.media.empty() ? MediumDescription{} : in.media[0];
  if (!in.fog) return medium;
  if (!is_zero(medium.scattering))
    throw SceneError(*in.file, "/world/fog/anisotropy",
                     "the world's medium scatters by itself: leave out \"anisotropy\", or the medium's "
                     "\"scattering\"");
  const dvec3 scattering = in.fog->density * glm::min(in.fog->color, dvec3(1));
  medium.scattering = scattering;
  medium.absorption += dvec3(in.fog->density) - scattering;
  medium.anisotropy = *in.fog->anisotropy;
  return medium;
}

/// Adds the media without duplicates; returns the index of each.
std::vector<u32> add_media(const SurfaceInputs& in, Surfaces& out) {
  std::vector<Medium>& media = out.media.edit();
  SpectraMaker spectra(in.paths);
  media.push_back(make_medium(world_medium(in)));
  if (!in.media.empty()) media[0].spectrum = spectra.add(in.media[0].dispersion);
  std::vector<u32> index_of(in.media.size(), 0);
  for (std::size_t i = 1; i < in.media.size(); ++i) {
    Medium medium = make_medium(in.media[i]);
    medium.spectrum = spectra.add(in.media[i].dispersion);
    auto found =
        std::find_if(media.begin() + 1, media.end(), [&](const Medium& m) { return same(m, medium); });
    if (found == media.end()) found = media.insert(found, medium);
    if (media.size() > MAX_MEDIA)
      throw SceneError(
          *in.file, "/media",
          fmt::format(
              "at most {} different media are supported (the world's among them); merge those that are alike",
              MAX_MEDIA));
    index_of[i] = static_cast<u32>(found - media.begin());
  }
  out.spectra = spectra.take_table();
  out.features.dispersion = !out.spectra.empty();
  return index_of;
}

bool differs_in_index(const Medium& a, const Medium& b) {
  return a.absorption.w != b.absorption.w || a.spectrum != b.spectrum;
}

/// Whether some media of the scene differ in index, so that interfaces refract.
bool bends_light(const std::vector<Medium>& media) {
  return std::ranges::any_of(media, [&](const Medium& m) { return differs_in_index(m, media[0]); });
}

/// Whether a thin material's facets scatter transmitted paths. A partly opaque material is seen straight
/// through, so its facets only reflect.
bool is_frosted(const SurfaceInputs& in, const MaterialDescription& material) {
  const bool there = material.opacity == 1 && material.textures.opacity < 0 && !material.one_sided;
  const double alpha = material.roughness * material.roughness;
  return in.paths && there && material.medium < 0 && !is_zero(material.transmission) &&
         alpha >= double(LEAST_ALPHA);
}

/// Whether shadow rays stop at a material. Paths (and photons) find light through refracting interfaces and
/// frosted walls themselves, so shadow rays passing straight through would count it twice. `bends`: some
/// medium of the scene refracts; `of_world`: the material's medium has the world's index.
bool stops_shadows(const SurfaceInputs& in, const MaterialDescription& material, bool bends, bool of_world) {
  const bool frosted = is_frosted(in, material);
  const bool by_path = (in.paths && bends && material.medium >= 0) || frosted;
  const bool filters = material.shadow_filter && (!in.caustics || (of_world && !frosted));
  return material.shadow_opaque || (by_path && !filters);
}

/// Whether light passes fuzz or a coat on its way through a material.
bool passes_layers(const MaterialDescription& material) {
  const auto& layers = material.layers;
  return layers && (layers->fuzz_weight > 0 || layers->coat_weight > 0) && !is_zero(material.transmission);
}

u32 material_flags(const MaterialDescription& material) {
  u32 flags = 0;
  if (material.blinn) flags |= MATERIAL_BLINN;
  if (material.checker) flags |= MATERIAL_CHECKER;
  if (!is_zero(material.transmission) || material.opacity < 1 || material.textures.opacity >= 0)
    flags |= MATERIAL_TRANSMITS;
  if (!is_zero(material.reflection) || material.coat > 0 || material.layers) flags |= MATERIAL_REFLECTS;
  if (!is_zero(material.specular)) flags |= MATERIAL_SHINES;
  if (!is_zero(material.emission)) flags |= MATERIAL_EMITS;
  if (material.layers) flags |= MATERIAL_LAYERED;
  if (!material.multiple_scattering) flags |= MATERIAL_SCATTERS_ONCE;
  if (material.off_camera) flags |= MATERIAL_OFF_CAMERA;
  if (material.shadow_catcher) flags |= MATERIAL_CATCHER;
  if (material.medium < 0) flags |= MATERIAL_THIN;
  if (material.medium < 0 && material.wall_ior > 0) flags |= MATERIAL_WALL;
  if (material.vertex_color) flags |= MATERIAL_VERTEX_COLOR;
  if (material.one_sided) flags |= MATERIAL_ONE_SIDED | MATERIAL_TRANSMITS;
  if (material.metal_rough) {
    flags |= MATERIAL_METAL_ROUGH;
    if (material.metal_rough->metalness > 0) flags |= MATERIAL_REFLECTS;
  }
  const bool local = !is_zero(material.ambient) || !is_zero(material.diffuse) ||
                     !is_zero(material.specular) || has_maps(material) || material.layers;
  if (material.type == MaterialType::dielectric && !local && material.transmission == dvec3(1) &&
      !(flags & MATERIAL_WALL))
    flags |= MATERIAL_CLEAR;
  return flags;
}

Material make_material(const MaterialDescription& material, const std::vector<u32>& media) {
  Material packed{};
  packed.ambient = pack(material.ambient);
  packed.diffuse = pack(material.diffuse);
  packed.specular = pack(material.specular, material.exponent);
  packed.reflection = pack(material.reflection, material.roughness * material.roughness);  // GGX alpha
  packed.transmission = pack(material.transmission, material.wall_ior);
  packed.checker_ambient = pack(material.checker_ambient);
  packed.checker_diffuse = pack(material.checker_diffuse, 1 / material.checker_size);
  packed.emission = pack(material.emission);
  packed.kind = material.type == MaterialType::dielectric ? MATERIAL_DIELECTRIC : MATERIAL_PHONG;
  packed.flags = material_flags(material);
  if (packed.flags & (MATERIAL_REFLECTS | MATERIAL_TRANSMITS) && packed.reflection.w > 0)
    packed.flags |= MATERIAL_ROUGH;
  packed.medium = material.medium < 0 ? 0 : media.at(static_cast<std::size_t>(material.medium));
  return packed;
}

bool lacks_material(const SceneDescription& scene, const Object& object) {
  if (object.material >= 0) return false;
  const auto* shape = std::get_if<MeshShape>(&object.shape);
  if (!shape) return true;
  const auto& materials = scene.meshes[static_cast<std::size_t>(shape->mesh)].materials;
  return materials.empty() || std::any_of(materials.begin(), materials.end(), [](int m) { return m < 0; });
}

}  // namespace

bool lacks_materials(const SceneDescription& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [&](const Object& object) { return lacks_material(scene, object); });
}

u32 add_materials(const SurfaceInputs& in, Surfaces& out) {
  const std::vector<u32> media = add_media(in, out);
  const bool bends = bends_light(out.media);
  for (const MaterialDescription& material : in.materials) {
    Material packed = make_material(material, media);
    if (is_frosted(in, material)) packed.flags |= MATERIAL_FROSTED;
    const bool of_world = !differs_in_index(out.media.rows()[packed.medium], out.media.rows()[0]);
    if (stops_shadows(in, material, bends, of_world))
      packed.flags |= MATERIAL_SHADOW_OPAQUE;
    else if (passes_layers(material))
      out.features.layer_filters = true;
    out.features.checker |= material.checker;
    if (material.shadow_catcher && !in.paths)
      throw SceneError(*in.file, "/materials/" + material.name + "/shadow_catcher",
                       "a shadow catcher needs paths: set /render/integrator to \"path\"");
    out.features.catchers |= material.shadow_catcher;
    out.materials.push_back(packed);
  }
  if (!in.lacks_materials) return NO_MATERIAL;
  out.materials.push_back(make_material(MaterialDescription{}, media));
  return static_cast<u32>(out.materials.size() - 1);
}

}  // namespace sundog
