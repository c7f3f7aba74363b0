// Converts textures to nodes, which follow their operands' nodes, and writes their images. An image's colours
// are weighted by alpha where alpha is the material's opacity.
#include "compile/surfaces/textures.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.h"
#include "base/image_io.h"
#include "base/memory.h"
#include "compile/fields/pattern_code.h"
#include "scene/pack.h"

namespace sundog {
namespace {

/// Returns zeros. All threads touch the pages of large memory first, because one thread would fault them in
/// slowly.
std::vector<u32> zeroed_words(std::size_t count) {
  constexpr std::size_t step = 1024, least = std::size_t{1} << 20;
  std::vector<u32> words;
  words.reserve(count);
  prefer_large_pages(words.data(), count * sizeof(u32));
  if (count > least)
    tbb::parallel_for(std::size_t{0}, count / step, [at = words.data()](std::size_t i) { at[i * step] = 0; });
  words.resize(count);
  return words;
}

float4 pack4(const glm::dvec4& v) { return pack(dvec3(v), v.w); }

/// Converts the textures that materials use to nodes, each once; skips unused images.
class TextureCompiler {
 public:
  TextureCompiler(const SurfaceInputs& in, Surfaces& out) : in_(in), out_(out) {}

  void compile() {
    out_.material_maps.push_back({});  // entry 0 means none
    for (std::size_t i = 0; i < in_.materials.size(); ++i)
      if (const MaterialDescription& material = in_.materials[i]; has_maps(material)) {
        cut_images_.clear();
        find_cut_images(material.textures.opacity);
        out_.materials.edit()[i].maps = static_cast<u32>(out_.material_maps.size());
        add_maps(material);
      }
    if (out_.material_maps.size() == 1) {
      out_.material_maps.clear();
      return;
    }
    out_.features.maps = true;
    for (std::size_t i = 0; i < SRGB_VALUES; ++i)
      out_.texture_values.push_back(linear_from_srgb(static_cast<float>(i) / (SRGB_VALUES - 1)));
    std::vector<float>& values = out_.texture_values.edit();
    values.insert(values.end(), stops_.begin(), stops_.end());
    out_.pattern_source = formulas_.empty() ? "" : pattern_code(formulas_);
    write_images();
  }

 private:
  static constexpr std::size_t most_nodes = 4096;

  void add_maps(const MaterialDescription& material) {
    MaterialMaps maps{};
    std::fill(std::begin(maps.slot), std::end(maps.slot), NO_TEXTURE);
    const MaterialTextures& textures = material.textures;
#define SUNDOG_ADD_MAP(constant, name)                             \
  maps.slot[MAP_##constant] = first_node(textures.name, material); \
  if (textures.name >= 0) out_.features.map_slots |= 1u << MAP_##constant;
    MAP_SLOTS(SUNDOG_ADD_MAP)
#undef SUNDOG_ADD_MAP
    maps.opacity = static_cast<float>(material.opacity);
    maps.cutoff = static_cast<float>(material.cutoff);
    if (const auto& metal = material.metal_rough) {
      maps.base = pack(metal->base, metal->metalness);
      maps.roughness = static_cast<float>(metal->roughness);
      maps.reflectance = static_cast<float>(metal->reflectance);
      out_.features.metal_rough = true;
    }
    maps.normal_scale = static_cast<float>(material.normal_scale);
    maps.bump = static_cast<float>(material.bump);
    maps.bump_uv = static_cast<float>(material.bump_uv);
    maps.parallax = textures.height >= 0 ? static_cast<float>(material.parallax) : 0;
    out_.features.parallax |= maps.parallax > 0;
    maps.occlusion = static_cast<float>(material.occlusion);
    maps.coat = static_cast<float>(material.coat);
    maps.normal_turn = normal_turn(textures.normal);
    if (textures.normal >= 0 || textures.height >= 0) add_relief(textures, maps);
    out_.material_maps.push_back(maps);
  }

  /// The directions of the texture's u and v on the surface: normal maps rotate with their picture, like
  /// heights.
  float4 normal_turn(int texture) const {
    glm::dvec2 u(1, 0), v(0, 1);
    if (texture >= 0) {
      const TextureDescription& map = texture_at(texture);
      const glm::dvec2 across(map.uv[0][0], map.uv[1][0]), up(map.uv[0][1], map.uv[1][1]);
      if (map.mapping == Mapping::uv && across != glm::dvec2(0) && up != glm::dvec2(0))
        u = glm::normalize(across), v = glm::normalize(up);
    }
    return pack4({u, v});
  }

  /// Relief needs the surface's coordinates, for tangents and steps along it.
  void add_relief(const MaterialTextures& textures, MaterialMaps& maps) {
    out_.features.relief = true;
    out_.features.surface_coordinates = true;
    if (textures.height < 0) return;
    const TextureNode& node = out_.texture_nodes[maps.slot[MAP_HEIGHT]];
    if (node.kind == TEXTURE_IMAGE && (node.mapping & MAPPING_KIND) == MAPPING_UV)
      maps.height_texels = node.scale;
  }

  const TextureDescription& texture_at(int index) const {
    return in_.textures[static_cast<std::size_t>(index)];
  }

  const ImageDescription& image_at(int index) const { return in_.images[static_cast<std::size_t>(index)]; }

  /// Adds the images whose alpha a texture uses. `depth` ends the recursion in graphs that add_graph()
  /// rejects.
  void find_cut_images(int index, u32 depth = 0) {
    if (index < 0 || depth > MOST_TEXTURE_STACK) return;
    const TextureDescription& texture = texture_at(index);
    if (texture.image >= 0 && texture.channel == 3) cut_images_.push_back(&image_at(texture.image));
    for (const int of : texture.of) find_cut_images(of, depth + 1);
  }

  /// Whether an image's colours are weighted by its alpha: it is the material's opacity.
  bool counts_by_alpha(const ImageDescription& image) const {
    return image.srgb && image.pixels.channels == 4 &&
           std::ranges::any_of(cut_images_,
                               [&](const ImageDescription* cut) { return same_picture(*cut, image); });
  }

  bool any_counts_by_alpha(int index, u32 depth = 0) const {
    if (index < 0 || cut_images_.empty() || depth > MOST_TEXTURE_STACK) return false;
    const TextureDescription& texture = texture_at(index);
    if (texture.image >= 0 && counts_by_alpha(image_at(texture.image))) return true;
    return any_counts_by_alpha(texture.of[0], depth + 1) || any_counts_by_alpha(texture.of[1], depth + 1);
  }

  /// The first node of a texture; its own node follows those of its operands.
  u32 first_node(int texture, const MaterialDescription& material) {
    if (texture < 0) return NO_TEXTURE;
    // Materials share a texture's nodes, except images weighted by alpha for only one of them.
    const std::pair key(texture, any_counts_by_alpha(texture) ? cut_images_ : CutImages());
    const auto found = nodes_.find(key);
    if (found != nodes_.end()) return found->second;
    const auto first = static_cast<u32>(out_.texture_nodes.size());
    nodes_.emplace(key, first);
    add_graph(texture, material, 0);
    out_.texture_nodes.edit().back().flags |= TEXTURE_LAST;
    return first;
  }

  /// Adds the nodes of a texture; `below` is the stack depth.
  void add_graph(int index, const MaterialDescription& material, u32 below) {
    const TextureDescription& texture = texture_at(index);
    if (out_.texture_nodes.size() >= most_nodes)
      throw SceneError(*in_.file, "/textures",
                       fmt::format("the materials' textures take more than {} images, patterns and colours, "
                                   "the most that a scene can have: \"{}\" is one too many",
                                   most_nodes, material.name));
    if (below + 2 > MOST_TEXTURE_STACK)
      throw SceneError(
          *in_.file, "/textures",
          "material \"" + material.name + "\" has a texture of too many others inside each other");
    for (u32 i = 0; i < 2; ++i)
      if (texture.of[i] >= 0) add_graph(texture.of[i], material, below + i);
    const bool works = texture.of[0] >= 0;
    out_.features.texture_stack = std::max(out_.features.texture_stack, below + (works ? 2 : 1));
    add_node(texture);
  }

  void add_node(const TextureDescription& texture) {
    TextureNode node{};
    node.kind = texture.kind;
    node.factor = pack4(texture.factor);
    node.offset = pack4(texture.offset);
    node.mapping = static_cast<u32>(texture.mapping);
    out_.features.texture_mappings |= 1u << node.mapping;
    node.mapping |= static_cast<u32>(texture.uv_set) << MAPPING_SET_SHIFT;
    if (texture.of[1] >= 0 && texture.kind != TEXTURE_PRODUCT) node.flags |= TEXTURE_MIXES;
    if (texture.channel >= 0)
      node.flags |= TEXTURE_ONE_CHANNEL | static_cast<u32>(texture.channel) << TEXTURE_CHANNEL_SHIFT;
    for (int row = 0; row < 2; ++row)
      node.uv_rows[row] = pack(dvec3(texture.uv[0][row], texture.uv[1][row], texture.uv[2][row]));
    for (int row = 0; row < 3; ++row)
      node.rows[row] = pack4({texture.placement[0][row], texture.placement[1][row], texture.placement[2][row],
                              texture.placement[3][row]});
    for (std::size_t i = 0; i < texture.parameter.size(); ++i)
      node.parameter[i] = static_cast<float>(texture.parameter[i]);
    node.scale = static_cast<float>(scale_of(texture));
    if (texture.kind == TEXTURE_IMAGE) set_image(texture, node);
    if (texture.kind == TEXTURE_RAMP) set_stops(texture, node);
    if (texture.kind == TEXTURE_FORMULA) set_formula(texture, node);
    const bool placed = texture.kind != TEXTURE_COLOR && texture.kind != TEXTURE_VERTEX_COLOR;
    if (placed && texture.mapping == Mapping::uv) {
      out_.features.surface_coordinates = true;
      out_.features.extra_uvs = std::max(out_.features.extra_uvs, static_cast<u32>(texture.uv_set));
    }
    out_.features.texture_kinds |= 1u << node.kind;
    out_.texture_nodes.push_back(node);
  }

  /// Texture units per unit of the mapping's coordinates (geometric mean).
  static double scale_of(const TextureDescription& texture) {
    const double uv = std::sqrt(std::abs(glm::determinant(glm::dmat2(texture.uv))));
    const double placed = std::cbrt(std::abs(glm::determinant(glm::dmat3(texture.placement))));
    if (texture.mapping == Mapping::uv) return uv;
    if (texture.mapping == Mapping::object && texture.kind != TEXTURE_IMAGE) return placed;
    return uv * placed;
  }

  void set_stops(const TextureDescription& texture, TextureNode& node) {
    node.first = static_cast<u32>(SRGB_VALUES + stops_.size());
    node.count = static_cast<u32>(texture.stops.size());
    for (const RampStop& stop : texture.stops)
      for (const double value : {stop.at, stop.color.x, stop.color.y, stop.color.z})
        stops_.push_back(static_cast<float>(value));
  }

  void set_formula(const TextureDescription& texture, TextureNode& node) {
    node.first = static_cast<u32>(SRGB_VALUES + stops_.size());
    node.count = static_cast<u32>(formulas_.size());
    formulas_.push_back(*texture.formula);
    for (const FormulaParameter& parameter : texture.formula->parameters)
      for (const double value : parameter.value) stops_.push_back(static_cast<float>(value));
  }

  void set_image(const TextureDescription& texture, TextureNode& node) {
    const ImageDescription& image = image_at(texture.image);
    const SampleUse use = !image.srgb              ? SampleUse::data
                          : counts_by_alpha(image) ? SampleUse::color_by_alpha
                                                   : SampleUse::color;
    const auto [found, added] = levels_.try_emplace({texture.image, use}, 0u, 0u);
    auto& [first, count] = found->second;
    if (added) {
      first = static_cast<u32>(out_.texel_levels.size());
      units_ = lay_out_levels(image.pixels, units_, out_.texel_levels.edit());
      count = static_cast<u32>(out_.texel_levels.size()) - first;
    }
    node.first = first;
    node.count = count;
    node.scale *= static_cast<float>(std::sqrt(double(image.pixels.width) * image.pixels.height));
    const u32 format = texel_format(image.pixels);
    node.flags |= format << TEXTURE_FORMAT_SHIFT;
    out_.features.texel_formats |= 1u << format;
    if (image.srgb && image.pixels.sample == StoredImage::Sample::byte) node.flags |= TEXTURE_SRGB;
    if (texture.filter == TextureFilter::nearest) node.flags |= TEXTURE_NEAREST;
    if (texture.filter == TextureFilter::bilinear) node.flags |= TEXTURE_BILINEAR;
    node.flags |= static_cast<u32>(texture.wrap[0]) << TEXTURE_WRAP_U_SHIFT;
    node.flags |= static_cast<u32>(texture.wrap[1]) << TEXTURE_WRAP_V_SHIFT;
  }

  void write_images() {
    if (units_ > std::numeric_limits<u32>::max())
      throw SceneError(*in_.file, "", "the images take more than 64 GiB; use smaller ones");
    TexelTables made = make_texel_tables(units_, TEXEL_PAGE_BYTES / TEXEL_UNIT);
    const TexelPages pages = made.pages;
    out_.texel_page = static_cast<u32>(pages.units);
    out_.features.texel_pages = made.several;
    std::tie(out_.texels0, out_.texels1, out_.texels2, out_.texels3) =
        std::tie(made.tables[0], made.tables[1], made.tables[2], made.tables[3]);
    const std::vector<std::pair<std::pair<int, SampleUse>, std::pair<u32, u32>>> images(levels_.begin(),
                                                                                        levels_.end());
    tbb::parallel_for(std::size_t{0}, images.size(), [&](std::size_t i) {
      const auto& [image, levels] = images[i];
      write_levels(image_at(image.first).pixels, image.second, &out_.texel_levels[levels.first], pages);
    });
  }

  const SurfaceInputs& in_;
  Surfaces& out_;
  using CutImages = std::vector<const ImageDescription*>;
  CutImages cut_images_;                            // images whose alpha is the current material's opacity
  std::map<std::pair<int, CutImages>, u32> nodes_;  // by texture and images weighted by alpha
  std::map<std::pair<int, SampleUse>, std::pair<u32, u32>> levels_;  // by image: first level and count
  std::vector<float> stops_;  // numbers of ramps and formulas, after the sRGB values
  std::vector<PatternFormula> formulas_;
  std::size_t units_ = 0;
};

}  // namespace

bool has_maps(const MaterialDescription& material) {
  bool textured = false;
#define SUNDOG_HAS_MAP(constant, name) textured |= material.textures.name >= 0;
  MAP_SLOTS(SUNDOG_HAS_MAP)
#undef SUNDOG_HAS_MAP
  return textured || material.opacity < 1 || material.one_sided || material.metal_rough || material.coat > 0;
}

TexelTables make_texel_tables(std::size_t units, u32 least_page) {
  const std::size_t unit_words = TEXEL_UNIT / sizeof(u32);
  const std::size_t quarter = (units + TEXEL_PAGES - 1) / TEXEL_PAGES;
  const std::size_t page =
      std::max<std::size_t>(least_page, (quarter + TEXEL_ALIGNMENT - 1) / TEXEL_ALIGNMENT * TEXEL_ALIGNMENT);
  TexelTables made{{}, {{}, page}, units > page};
  tbb::parallel_for(std::size_t{0}, std::size_t{TEXEL_PAGES}, [&](std::size_t i) {
    made.tables[i] = zeroed_words((std::min(units, (i + 1) * page) - std::min(units, i * page)) * unit_words);
    made.pages.bytes[i] = reinterpret_cast<std::uint8_t*>(made.tables[i].edit().data());
  });
  return made;
}

void add_textures(const SurfaceInputs& in, Surfaces& out) { TextureCompiler(in, out).compile(); }

}  // namespace sundog
