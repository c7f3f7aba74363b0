// glTF's primitives (glTF 2.0, section 3.7.2): triangles, strips and fans. Points and lines are skipped.
#include "models/gltf/gltf_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>

#include "models/gltf/gltf_deform.h"
#include "models/normals.h"

namespace sundog::models {
namespace {

// Accessors allowed for an attribute: types, and whether normalised integers are allowed.
struct AttributeRule {
  std::string_view name, type, other_type;
  bool normalized_integers;
};
constexpr AttributeRule rules[] = {{"POSITION", "VEC3", "VEC3", false},
                                   {"NORMAL", "VEC3", "VEC3", false},
                                   {"TANGENT", "VEC4", "VEC4", false},
                                   {"TEXCOORD_0", "VEC2", "VEC2", true},
                                   {"TEXCOORD_1", "VEC2", "VEC2", true},
                                   {"TEXCOORD_2", "VEC2", "VEC2", true},
                                   {"TEXCOORD_3", "VEC2", "VEC2", true},
                                   {"COLOR_0", "VEC3", "VEC4", true},
                                   {"TANGENT of a target", "VEC3", "VEC3", false}};

// KHR_mesh_quantization also allows 8- and 16-bit integers; for normals, signed normalised ones.
bool fits_quantized(std::string_view name, const Accessor& accessor) {
  const std::uint64_t component = accessor.dense.component;
  const bool is_signed = component == component_byte || component == component_short;
  const bool is_unsigned = component == component_unsigned_byte || component == component_unsigned_short;
  if (name == "NORMAL" || name.starts_with("TANGENT")) return is_signed && accessor.normalized;
  return (name == "POSITION" || name.starts_with("TEXCOORD_")) && (is_signed || is_unsigned);
}

bool fits(const AttributeRule& rule, const Accessor& accessor, bool quantized) {
  if (accessor.type != rule.type && accessor.type != rule.other_type) return false;
  const std::uint64_t component = accessor.dense.component;
  if (component == component_float || (quantized && fits_quantized(rule.name, accessor))) return true;
  const bool small = component == component_unsigned_byte || component == component_unsigned_short;
  return rule.normalized_integers && small && accessor.normalized;
}

bool names_extension(const JsonAt& root, const std::string& wanted) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"})
    for (const JsonAt& name : root.list(list))
      if (name.text() == wanted) return true;
  return false;
}

std::vector<glm::uvec3> triangles_of(std::uint64_t mode, std::span<const std::uint32_t> v) {
  std::vector<glm::uvec3> triangles;
  if (mode == 4)
    for (std::size_t i = 0; i + 2 < v.size(); i += 3) triangles.emplace_back(v[i], v[i + 1], v[i + 2]);
  if (mode == 5)
    for (std::size_t i = 0; i + 2 < v.size(); ++i)
      triangles.emplace_back(v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]);
  if (mode == 6)
    for (std::size_t i = 0; i + 2 < v.size(); ++i) triangles.emplace_back(v[i + 1], v[i + 2], v[0]);
  return triangles;
}

template <class Vector>
Vector element(const std::vector<float>& values, std::size_t stride, std::size_t index) {
  Vector out;
  for (int c = 0; c < Vector::length(); ++c) out[c] = values[index * stride + static_cast<std::size_t>(c)];
  return out;
}

}  // namespace

GltfMeshes::GltfMeshes(const JsonAt& root, GltfAccessors& accessors, GltfMaterials& materials,
                       double crease_degrees)
    : accessors_(accessors),
      materials_(materials),
      crease_degrees_(crease_degrees),
      quantized_(names_extension(root, "KHR_mesh_quantization")) {
  for (const JsonAt& at : root.list("meshes")) {
    Entry entry;
    entry.name = at.text("name");
    for (const JsonAt& primitive : at.member("primitives").elements())
      entry.primitives.push_back(read_primitive(primitive));
    entry.weights = read_weights(at, entry);
    meshes_.push_back(std::move(entry));
  }
}

std::vector<double> GltfMeshes::read_weights(const JsonAt& at, const Entry& entry) {
  const std::size_t targets = entry.primitives.empty() ? 0 : entry.primitives[0].targets.size();
  for (const Primitive& primitive : entry.primitives)
    if (primitive.targets.size() != targets)
      at.fail(fmt::format("primitives of {} and of {} morph targets", targets, primitive.targets.size()));
  const auto weights = at.find("weights");
  return weights ? weights->numbers(targets) : std::vector<double>(targets, 0);
}

std::vector<GltfMeshes::Target> GltfMeshes::read_targets(const JsonAt& at, const Primitive& primitive) const {
  std::vector<Target> targets;
  for (const JsonAt& target : at.list("targets")) {
    targets.push_back({read_attribute(target, "POSITION"), read_attribute(target, "NORMAL"),
                       read_attribute(target, "TANGENT", "TANGENT of a target")});
    for (const auto& changes : {targets.back().position, targets.back().normal, targets.back().tangent})
      if (changes && primitive.position)
        if (const std::size_t count = accessors_.all()[*changes].dense.count,
            wanted = accessors_.all()[*primitive.position].dense.count;
            count != wanted)
          target.fail(fmt::format("a morph target of {} elements for {} positions", count, wanted));
  }
  return targets;
}

/// `name_of_rule`: where it is not the attribute's name.
std::optional<std::size_t> GltfMeshes::read_attribute(const JsonAt& attributes, const char* name,
                                                      std::string_view name_of_rule) const {
  const auto found = attributes.find(name);
  if (!found) return std::nullopt;
  const std::size_t index = found->index(accessors_.all().size(), "accessor");
  const Accessor& accessor = accessors_.all()[index];
  for (const AttributeRule& rule : rules)
    if (rule.name == (name_of_rule.empty() ? name : name_of_rule) && !fits(rule, accessor, quantized_))
      found->fail(fmt::format("accessor {} is a {} of type {}: {} of floats{} wanted", index, accessor.type,
                              accessor.dense.component, rule.type,
                              rule.normalized_integers ? " or normalised unsigned integers" : ""));
  const BufferView* view = accessors_.view_of(accessor);
  if (view && (accessor.dense.offset % 4 != 0 || (view->stride == 0 && accessor.dense.element_size % 4 != 0)))
    found->fail(fmt::format("accessor {}: vertex attributes must begin at multiples of four bytes", index));
  return index;
}

/// An accessor of four numbers for each of `count` vertices; nothing for other data.
std::optional<std::size_t> GltfMeshes::read_four(const JsonAt& attributes, const char* name,
                                                 std::size_t count) const {
  const auto found = attributes.find(name);
  if (!found) return std::nullopt;
  const std::size_t index = found->index(accessors_.all().size(), "accessor");
  const Accessor& accessor = accessors_.all()[index];
  return accessor.type == "VEC4" && accessor.dense.count == count ? std::optional(index) : std::nullopt;
}

void GltfMeshes::check_indices(const JsonAt& at, const Accessor& accessor) const {
  const std::uint64_t component = accessor.dense.component;
  if (accessor.type != "SCALAR" || accessor.normalized ||
      (component != component_unsigned_byte && component != component_unsigned_short &&
       component != component_unsigned_int))
    at.fail(fmt::format("indices must be SCALAR of type 5121, 5123 or 5125, not {} of type {}", accessor.type,
                        component));
  const BufferView* view = accessors_.view_of(accessor);
  if (view && view->stride != 0) at.fail("the indices' buffer view must not have a byteStride");
}

GltfMeshes::Primitive GltfMeshes::read_primitive(const JsonAt& at) const {
  Primitive p;
  p.pointer = at.pointer();
  const JsonAt attributes = at.member("attributes");
  p.position = read_attribute(attributes, "POSITION");
  p.normal = read_attribute(attributes, "NORMAL");
  p.tangent = read_attribute(attributes, "TANGENT");
  for (std::uint64_t set = 0; set < most_uv_sets; ++set)
    p.uvs.push_back(read_attribute(attributes, fmt::format("TEXCOORD_{}", set).c_str()));
  p.color = read_attribute(attributes, "COLOR_0");
  const auto vertices = [&](std::size_t accessor) { return accessors_.all()[accessor].dense.count; };
  std::vector<std::optional<std::size_t>> others = p.uvs;
  others.insert(others.end(), {p.normal, p.tangent, p.color});
  for (const auto& other : others)
    if (p.position && other && vertices(*other) != vertices(*p.position))
      attributes.fail(fmt::format("an attribute of {} elements beside {} positions", vertices(*other),
                                  vertices(*p.position)));
  if (p.position) p.joints = read_four(attributes, "JOINTS_0", vertices(*p.position));
  if (p.position) p.weights = read_four(attributes, "WEIGHTS_0", vertices(*p.position));
  if (const auto indices = at.find("indices")) {
    p.indices = indices->index(accessors_.all().size(), "accessor");
    check_indices(*indices, accessors_.all()[*p.indices]);
  }
  const auto material = at.find("material");
  p.material = material ? material->index(materials_.count() - 1, "material") : materials_.count() - 1;
  if (const auto mode = at.find("mode")) p.mode = mode->integer(0, 6);
  p.targets = read_targets(at, p);
  return p;
}

int GltfMeshes::add(std::size_t index, const Deformation& deformation, Model& model) {
  of_no_number_ = 0;
  Mesh mesh = build(meshes_.at(index), deformation, model);
  if (of_no_number_ > 0)
    model.warnings.push_back(
        fmt::format("/meshes/{}: {} attributes of vertices are no numbers: normals are made up, other "
                    "attributes taken as if they were not there",
                    index, of_no_number_));
  if (mesh.triangles.empty()) return -1;
  model.meshes.push_back(std::move(mesh));
  return static_cast<int>(model.meshes.size()) - 1;
}

int GltfMeshes::use(std::size_t index, Model& model) {
  Entry& entry = meshes_.at(index);
  if (!entry.used) entry.used = add(index, {}, model);
  return *entry.used;
}

bool GltfMeshes::has_joints(std::size_t index) const {
  return std::ranges::any_of(meshes_.at(index).primitives,
                             [](const Primitive& p) { return p.joints && p.weights; });
}

int GltfMeshes::use_deformed(const Deformed& which, const Deformation& deformation, Model& model) {
  Added& added = deformed_[which];
  if (!added.done && added.mesh < 0) added.mesh = add(which.mesh, deformation, model);
  if (const auto at = static_cast<std::size_t>(added.mesh); !added.done && added.mesh >= 0) {
    model.meshes[at] = build(meshes_.at(which.mesh), deformation, model);
    if (at < model.origins.size()) model.origins[at] = dvec3(0);
  }
  added.done = true;
  return added.mesh;
}

void GltfMeshes::deform_anew() {
  accessors_.forget_spent();
  for (auto& [which, added] : deformed_) added.done = false;
}

Mesh GltfMeshes::build(const Entry& entry, const Deformation& deformation, Model& model) {
  Mesh mesh;
  mesh.name = entry.name;
  Deformation shape = deformation;
  if (shape.weights.empty()) shape.weights = entry.weights;
  bool any_color = false, any_tangent = false;
  std::vector<bool> any_uv(most_uv_sets, false);
  mesh.further_uvs.resize(most_uv_sets - 1);
  std::vector<bool> has_normal;
  for (const Primitive& primitive : entry.primitives) {
    if (!primitive.position || primitive.mode < 4) continue;
    append(primitive, shape, model, mesh, has_normal);
    for (std::size_t set = 0; set < most_uv_sets; ++set) any_uv[set] = any_uv[set] || primitive.uvs[set];
    any_color = any_color || primitive.color;
    any_tangent = any_tangent || (primitive.normal && primitive.tangent);
  }
  if (!any_uv[0]) mesh.uvs.clear();
  for (std::size_t set = 1; set < most_uv_sets; ++set)
    if (!any_uv[set]) mesh.further_uvs[set - 1].clear();
  while (!mesh.further_uvs.empty() && mesh.further_uvs.back().empty()) mesh.further_uvs.pop_back();
  if (!any_color) mesh.colors.clear();
  if (std::ranges::all_of(std::as_const(mesh.alphas), [](float alpha) { return alpha == 1; }))
    mesh.alphas.clear();
  if (!any_tangent) mesh.tangents.clear();
  const bool smooth =
      crease_degrees_ > 0 && std::find(has_normal.begin(), has_normal.end(), false) != has_normal.end();
  complete_normals(mesh, std::move(has_normal), crease_degrees_,
                   smooth ? weld_positions(mesh) : std::vector<std::uint32_t>());
  return mesh;
}

// The primitive's vertices in drawing order.
std::vector<std::uint32_t> GltfMeshes::vertex_numbers(const Primitive& primitive) {
  const std::size_t count = accessors_.all()[*primitive.position].dense.count;
  if (!primitive.indices) {
    accessors_.spend(count, primitive.pointer);
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0u);
    return numbers;
  }
  const std::vector<std::uint32_t>& numbers = accessors_.indices(*primitive.indices);
  accessors_.spend(numbers.size(), primitive.pointer);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (numbers[i] >= count)
      JsonAt(accessors_.source(), nlohmann::json(), primitive.pointer + "/indices")
          .fail(fmt::format("index {} is {}, but there are {} vertices", i, numbers[i], count));
  return numbers;
}

template <class Vector>
Vector GltfMeshes::number_or(const std::vector<float>& values, std::size_t stride, std::size_t index,
                             const Vector& otherwise) {
  const auto value = element<Vector>(values, stride, index);
  if (is_finite(value)) return value;
  ++of_no_number_;
  return otherwise;
}

// Tangents without normals must be recomputed (glTF 2.0, section 3.7.2.1), as missing ones are.
void GltfMeshes::append_tangents(const Primitive& primitive, const std::vector<std::uint32_t>& used,
                                 Mesh& mesh) {
  if (!primitive.normal || !primitive.tangent) {
    mesh.tangents.resize(mesh.tangents.size() + used.size(), glm::vec4(0));
    return;
  }
  const std::vector<float>& tangents = accessors_.floats(*primitive.tangent);
  for (const std::uint32_t v : used) mesh.tangents.push_back(number_or(tangents, 4, v, glm::vec4(0)));
}

// The file's v points down.
void GltfMeshes::append_uvs(const Primitive& primitive, const std::vector<std::uint32_t>& used, Mesh& mesh) {
  for (std::size_t set = 0; set < most_uv_sets; ++set) {
    MeshArray<glm::vec2>& to = set == 0 ? mesh.uvs : mesh.further_uvs[set - 1];
    if (!primitive.uvs[set]) {
      to.resize(to.size() + used.size(), glm::vec2(0));
      continue;
    }
    const std::vector<float>& uvs = accessors_.floats(*primitive.uvs[set]);
    for (const std::uint32_t v : used) {
      const auto uv = number_or(uvs, 2, v, glm::vec2(0));
      to.emplace_back(uv.x, 1 - uv.y);
    }
  }
}

// Targets first, joints after them.
void GltfMeshes::deform(const Primitive& primitive, const Deformation& deformation,
                        const std::vector<std::uint32_t>& used, std::size_t first, Mesh& mesh) {
  const auto floats = [&](const std::optional<std::size_t>& accessor) {
    return accessor ? &accessors_.floats(*accessor) : nullptr;
  };
  for (std::size_t i = 0; i < primitive.targets.size(); ++i) {
    const auto weight = static_cast<float>(deformation.weights[i]);
    if (weight == 0) continue;
    const Target& target = primitive.targets[i];
    TargetChanges changes{.positions = floats(target.position)};
    if (primitive.normal) changes.normals = floats(target.normal);
    if (primitive.normal && primitive.tangent) changes.tangents = floats(target.tangent);
    move_by_target(weight, changes, used, first, mesh);
  }
  for (std::size_t i = 0; i < used.size(); ++i)
    if (!is_finite(mesh.positions[first + i]))
      accessors_.fail_at(accessors_.all()[*primitive.position],
                         fmt::format("vertex {} is not finite", used[i]));
  if (!deformation.joints.empty() && primitive.joints && primitive.weights)
    move_by_joints(deformation.joints,
                   {accessors_.floats(*primitive.joints), accessors_.floats(*primitive.weights)}, used, first,
                   mesh);
}

// Copies only the attribute elements that the triangles use: primitives often share accessors.
void GltfMeshes::append(const Primitive& primitive, const Deformation& deformation, Model& model, Mesh& mesh,
                        std::vector<bool>& has_normal) {
  const std::vector<float>& positions = accessors_.floats(*primitive.position);
  std::vector<glm::uvec3> triangles = triangles_of(primitive.mode, vertex_numbers(primitive));
  if (triangles.empty()) return;
  std::vector<std::uint32_t> used;
  used.reserve(triangles.size() * 3);
  for (const glm::uvec3 t : triangles) used.insert(used.end(), {t.x, t.y, t.z});
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const std::vector<float> none;
  const std::vector<float>& normals = primitive.normal ? accessors_.floats(*primitive.normal) : none;
  const std::vector<float>& colors = primitive.color ? accessors_.floats(*primitive.color) : none;
  const std::size_t channels = primitive.color ? accessors_.all()[*primitive.color].dense.components : 3;
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  bool fades = false;
  for (const std::uint32_t v : used) {
    mesh.positions.push_back(element<glm::vec3>(positions, 3, v));
    mesh.normals.push_back(primitive.normal ? number_or(normals, 3, v, glm::vec3(0)) : glm::vec3(0));
    mesh.colors.push_back(primitive.color ? number_or(colors, channels, v, glm::vec3(1)) : glm::vec3(1));
    mesh.alphas.push_back(channels == 4 && std::isfinite(colors[4 * v + 3]) ? colors[4 * v + 3] : 1.0f);
    fades = fades || mesh.alphas.back() < 1;
    has_normal.push_back(primitive.normal.has_value());
  }
  append_tangents(primitive, used, mesh);
  append_uvs(primitive, used, mesh);
  deform(primitive, deformation, used, first, mesh);
  const auto place = [&](std::uint32_t v) {
    return first + static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
  };
  for (const glm::uvec3 t : triangles) mesh.triangles.emplace_back(place(t.x), place(t.y), place(t.z));
  mesh.source_vertex_count += accessors_.all()[*primitive.position].dense.count;
  const VertexColors kind = fades             ? VertexColors::with_alpha
                            : primitive.color ? VertexColors::opaque
                                              : VertexColors::none;
  mesh.materials.resize(mesh.triangles.size(), materials_.use(primitive.material, kind, model));
}

}  // namespace sundog::models
