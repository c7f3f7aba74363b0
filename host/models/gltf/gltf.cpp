// Converts glTF 2.0 and GLB files, as JSON and buffers, to a Model whose objects share meshes: one scene's
// nodes with their meshes, instances, camera and lights, at rest or at a time of the animations.
#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "models/gltf/gltf_animations.h"
#include "models/gltf/gltf_layers.h"
#include "models/gltf/gltf_meshes.h"
#include "models/gltf/gltf_unread.h"
#include "models/gltf/gltf_views.h"
#include "models/readers.h"

namespace sundog::models {
namespace {

struct Node {
  std::string name, pointer;
  NodePose rest;
  dmat4 local{1};
  std::vector<double> weights;  // as in NodePose
  std::vector<std::size_t> children;
  std::optional<std::size_t> mesh, camera, light, parent, skin;
  std::vector<dmat4> instances;  // EXT_mesh_gpu_instancing
  bool instanced = false;
};

dmat4 place(dvec3 translation, glm::dquat rotation, dvec3 scale) {
  dmat4 m = glm::mat4_cast(rotation);
  for (int axis = 0; axis < 3; ++axis) m[axis] *= scale[axis];
  m[3] = glm::dvec4(translation, 1);
  return m;
}

dmat4 matrix_of(const NodePose& pose) {
  return pose.matrix ? *pose.matrix : place(pose.translation, pose.rotation, pose.scale);
}

glm::dquat checked_quaternion(double x, double y, double z, double w, const JsonAt& at) {
  const auto unit = unit_quaternion(x, y, z, w);
  if (!unit) at.fail("a rotation whose quaternion is 0");
  return *unit;
}

NodePose read_pose(const JsonAt& at) {
  NodePose pose;
  if (const auto matrix = at.find("matrix")) {
    const std::vector<double> values = matrix->numbers(16);
    dmat4 m;
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = values[static_cast<std::size_t>(i)];
    if (glm::row(m, 3) != glm::dvec4(0, 0, 0, 1)) matrix->fail("the last row must be 0 0 0 1");
    pose.matrix = m;
    return pose;
  }
  if (const auto found = at.find("rotation")) {
    const std::vector<double> q = found->numbers(4);
    pose.rotation = checked_quaternion(q[0], q[1], q[2], q[3], *found);
  }
  pose.translation = at.vector("translation", dvec3(0));
  pose.scale = at.vector("scale", dvec3(1));
  return pose;
}

bool is_singular(const dmat4& m) {
  const double determinant = glm::determinant(glm::dmat3(m));
  return determinant == 0 || !std::isfinite(determinant) || !std::isfinite(glm::length(m[3]));
}

bool places_lights(const JsonAt& root) {
  return std::ranges::any_of(root.list("nodes"), [](const JsonAt& node) {
    return node.extension("KHR_lights_punctual").has_value();
  });
}

class GltfReader {
 public:
  GltfReader(const Source& source, const GltfContainer& container, const JsonAt& root,
             const ModelOptions& options)
      : root_(root),
        accessors_(source, container, root),
        textures_(root, accessors_),
        for_paths_(options.for_paths.value_or(!places_lights(root))),
        materials_(root, textures_, for_paths_),
        meshes_(root, accessors_, materials_, options.crease_angle.value_or(0)) {}

  /// Reads the nodes at rest.
  Model read() {
    Model model;
    model.for_paths = for_paths_;
    model_ = &model;
    for (const JsonAt& at : root_.list("cameras")) cameras_.push_back(read_gltf_camera(at));
    if (const auto extension = root_.extension("KHR_lights_punctual"))
      for (const JsonAt& at : extension->list("lights")) lights_.push_back(read_gltf_light(at));
    read_nodes();
    walk(scene_roots());
    model.warnings.insert(model.warnings.end(), accessors_.warnings().begin(), accessors_.warnings().end());
    return model;
  }

  /// Moves the model from read() to a time of the animations.
  void pose(const Playing& playing, Model& model) {
    if (!animations_) animations_.emplace(root_, accessors_, targets_by_node());
    if (playing.animation.empty() && animations_->compete())
      model.warnings.emplace_back(
          "several animations move the same nodes: the first of the file counts; \"animation\" names one");
    std::vector<NodePose> poses;
    for (const Node& node : nodes_) poses.push_back(node.rest);
    animations_->move(playing, poses);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      nodes_[i].local = matrix_of(poses[i]);
      nodes_[i].weights = std::move(poses[i].weights);
    }
    model.duration = animations_->last();
    model_ = &model;
    worlds_.clear();
    meshes_.deform_anew();
    model.objects.clear(), model.lights.clear(), model.camera.reset();
    walk(scene_roots());
  }

 private:
  void read_nodes() {
    const std::vector<JsonAt> all = root_.list("nodes");
    skins_ = root_.list("skins");
    nodes_.resize(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) read_node(all[i], nodes_[i]);
    const std::set<std::size_t> moved = nodes_with_moving_weights(root_.json());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      Node& node = nodes_[i];
      if (moved.contains(i) && node.mesh && node.rest.weights.empty())
        node.rest.weights = meshes_.weights(*node.mesh);
      node.weights = node.rest.weights;
    }
    for (std::size_t i = 0; i < all.size(); ++i)
      for (const JsonAt& at : all[i].list("children")) {
        const std::size_t child = at.index(nodes_.size(), "node");
        if (nodes_[child].parent || child == i) at.fail(fmt::format("node {} is a child already", child));
        nodes_[child].parent = i;
        nodes_[i].children.push_back(child);
      }
  }

  void read_node(const JsonAt& at, Node& node) {
    node.name = at.text("name");
    node.pointer = at.pointer();
    node.rest = read_pose(at);
    node.local = matrix_of(node.rest);
    if (const auto mesh = at.find("mesh")) node.mesh = mesh->index(meshes_.count(), "mesh");
    if (const auto weights = at.find("weights"); weights && node.mesh)
      node.rest.weights = weights->numbers(meshes_.weights(*node.mesh).size());
    if (const auto skin = at.find("skin")) node.skin = skin->index(skins_.size(), "skin");
    if (const auto camera = at.find("camera")) node.camera = camera->index(cameras_.size(), "camera");
    if (const auto light = at.extension("KHR_lights_punctual"))
      node.light = light->member("light").index(lights_.size(), "light");
    if (const auto instances = at.extension("EXT_mesh_gpu_instancing")) read_instances(*instances, node);
  }

  const std::vector<float>* instance_attribute(const JsonAt& attributes, const char* name,
                                               std::size_t components, std::optional<std::size_t>& count) {
    const auto at = attributes.find(name);
    if (!at) return nullptr;
    const std::size_t index = at->index(accessors_.all().size(), "accessor");
    const Accessor& accessor = accessors_.all()[index];
    const bool number = accessor.dense.component == component_float || accessor.normalized;
    if (accessor.type != (components == 3 ? "VEC3" : "VEC4") || !number)
      at->fail(fmt::format("{} components of floats or normalised integers wanted", components));
    if (count && *count != accessor.dense.count) at->fail("instance attributes of different counts");
    count = accessor.dense.count;
    return &accessors_.numbers(index);
  }

  void read_instances(const JsonAt& extension, Node& node) {
    const JsonAt attributes = extension.member("attributes");
    std::optional<std::size_t> count;
    const auto* translations = instance_attribute(attributes, "TRANSLATION", 3, count);
    const auto* rotations = instance_attribute(attributes, "ROTATION", 4, count);
    const auto* scales = instance_attribute(attributes, "SCALE", 3, count);
    if (!count) attributes.fail("TRANSLATION, ROTATION or SCALE wanted");
    node.instanced = true;
    accessors_.spend(*count, node.pointer);
    for (std::size_t i = 0; i < *count; ++i) {
      const auto value = [i](const std::vector<float>& all, std::size_t n, std::size_t c) {
        return static_cast<double>(all[i * n + c]);
      };
      const auto vector = [&](const std::vector<float>* all, dvec3 otherwise) {
        return all ? dvec3(value(*all, 3, 0), value(*all, 3, 1), value(*all, 3, 2)) : otherwise;
      };
      glm::dquat rotation(1, 0, 0, 0);
      if (rotations)
        rotation = checked_quaternion(value(*rotations, 4, 0), value(*rotations, 4, 1),
                                      value(*rotations, 4, 2), value(*rotations, 4, 3), attributes);
      node.instances.push_back(place(vector(translations, dvec3(0)), rotation, vector(scales, dvec3(1))));
    }
  }

  // The file's default scene, else its first; a file without scenes shows all nodes.
  std::vector<std::size_t> scene_roots() {
    const std::vector<JsonAt> scenes = root_.list("scenes");
    std::vector<std::vector<std::size_t>> roots;
    for (const JsonAt& scene : scenes) {
      roots.emplace_back();
      std::set<std::size_t> seen;
      for (const JsonAt& at : scene.list("nodes")) {
        const std::size_t node = at.index(nodes_.size(), "node");
        if (nodes_[node].parent || !seen.insert(node).second)
          at.fail(fmt::format("node {} is not a root, or is named twice", node));
        roots.back().push_back(node);
      }
    }
    const auto chosen = root_.find("scene");
    const std::size_t scene = chosen ? chosen->index(roots.size(), "scene") : 0;
    if (!roots.empty()) return roots[scene];
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (!nodes_[i].parent) all.push_back(i);
    return all;
  }

  // Nodes have at most one parent and roots have none, so no node is visited twice.
  void walk(const std::vector<std::size_t>& roots) {
    struct Visit {
      std::size_t node;
      dmat4 parent;
    };
    std::vector<Visit> open;
    for (std::size_t i = roots.size(); i-- > 0;) open.push_back({roots[i], dmat4(1)});
    while (!open.empty()) {
      const Visit visit = open.back();
      open.pop_back();
      const Node& node = nodes_[visit.node];
      const dmat4 world = visit.parent * node.local;
      add_node(visit.node, world);
      for (std::size_t i = node.children.size(); i-- > 0;) open.push_back({node.children[i], world});
    }
  }

  void add_node(std::size_t index, const dmat4& world) {
    const Node& node = nodes_[index];
    if (node.camera) add_camera(node, world);
    if (node.light) add_light(node, world);
    if (!node.mesh) return;
    const bool skinned = node.skin && !node.instanced && meshes_.has_joints(*node.mesh);
    Deformed which{.mesh = *node.mesh};
    if (skinned) which.skin = node.skin;
    if (!node.weights.empty()) which.node = index;
    const Deformation deformation{node.weights, skinned ? joints_of(*node.skin) : std::vector<dmat4>()};
    const int mesh = which.skin || which.node ? meshes_.use_deformed(which, deformation, *model_)
                                              : meshes_.use(*node.mesh, *model_);
    if (mesh < 0) return;
    // The joints place a mesh with a skin; its node's transform is ignored.
    if (!node.instanced) return add_object(node, mesh, skinned ? dmat4(1) : world);
    for (const dmat4& instance : node.instances) add_object(node, mesh, world * instance);
  }

  std::vector<std::size_t> targets_by_node() const {
    std::vector<std::size_t> targets;
    for (const Node& node : nodes_) targets.push_back(node.mesh ? meshes_.weights(*node.mesh).size() : 0);
    return targets;
  }

  // Matrices from the bind pose to the world, for the file's node transforms.
  std::vector<dmat4> joints_of(std::size_t skin) {
    if (worlds_.empty()) place_all_nodes();
    const JsonAt& at = skins_[skin];
    std::vector<dmat4> joints;
    for (const JsonAt& joint : at.list("joints"))
      joints.push_back(worlds_[joint.index(nodes_.size(), "node")]);
    const auto inverse = at.find("inverseBindMatrices");
    if (!inverse) return joints;
    const std::size_t index = inverse->index(accessors_.all().size(), "accessor");
    const std::vector<float>& values = accessors_.numbers(index);
    if (accessors_.all()[index].type != "MAT4" || values.size() < 16 * joints.size())
      inverse->fail(fmt::format("{} matrices of type MAT4 wanted, one a joint", joints.size()));
    for (std::size_t i = 0; i < joints.size(); ++i) {
      dmat4 bind;
      for (int k = 0; k < 16; ++k)
        bind[k / 4][k % 4] = static_cast<double>(values[16 * i + static_cast<std::size_t>(k)]);
      joints[i] *= bind;
    }
    return joints;
  }

  void place_all_nodes() {
    worlds_.assign(nodes_.size(), dmat4(1));
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (!nodes_[i].parent) open.push_back(i);
    while (!open.empty()) {
      const std::size_t i = open.back();
      open.pop_back();
      worlds_[i] = nodes_[i].parent ? worlds_[*nodes_[i].parent] * nodes_[i].local : nodes_[i].local;
      open.insert(open.end(), nodes_[i].children.begin(), nodes_[i].children.end());
    }
  }

  // Some files hide a node by a scale of 0.
  void add_object(const Node& node, int mesh, const dmat4& world) {
    if (is_singular(world)) {
      if (!animations_)
        model_->warnings.push_back(
            fmt::format("{}: the transform flattens the mesh; it is left out", node.pointer));
      return;
    }
    Object object;
    object.name = node.name.empty() ? meshes_.name(*node.mesh) : node.name;
    object.shape = MeshShape{mesh};
    object.world_from_object = world;
    object.place = node.pointer;
    model_->objects.push_back(std::move(object));
  }

  void add_camera(const Node& node, const dmat4& world) {
    const GltfCamera& from = cameras_[*node.camera];
    const bool parallel = from.height >= 1e-9 && from.height <= 1e15,  // as in scenes
        perspective = from.fov > 0 && from.fov < std::numbers::pi;
    if ((!parallel && !perspective) || is_singular(world))
      return leave_unread(*model_, "cameras that are neither perspective nor orthographic");
    if (model_->camera) return;
    Camera camera;
    camera.position = dvec3(world[3]);
    camera.target = camera.position - glm::normalize(dvec3(world[2]));
    camera.up = glm::normalize(dvec3(world[1]));
    if (parallel)
      camera.orthographic = from.height;
    else
      camera.fov = glm::degrees(from.fov);
    camera.near = from.near;
    camera.far = from.far;
    model_->camera = camera;
    if (from.aspect > 0) model_->aspect = from.aspect;
  }

  void add_light(const Node& node, const dmat4& world) {
    LightDescription light = lights_[*node.light];
    light.position = dvec3(world[3]);
    const dvec3 direction = -dvec3(world[2]);
    if (glm::length(direction) > 0) light.direction = glm::normalize(direction);
    model_->lights.push_back(light);
  }

  JsonAt root_;
  GltfAccessors accessors_;
  GltfTextures textures_;
  bool for_paths_;
  GltfMaterials materials_;
  GltfMeshes meshes_;
  std::vector<GltfCamera> cameras_;
  std::vector<LightDescription> lights_;
  std::vector<Node> nodes_;
  std::vector<JsonAt> skins_;
  std::vector<dmat4> worlds_;                 // by node; filled when a skin needs them
  std::optional<GltfAnimations> animations_;  // read when they are first played
  Model* model_ = nullptr;
};

}  // namespace

Model load_gltf(Source from, const ModelOptions& options) {
  struct File {
    Source source;
    GltfContainer container;
    nlohmann::json json;
    std::optional<GltfReader> reader;  // refers to the members above
  };
  const auto file = std::make_shared<File>();
  file->source = std::move(from);
  const Source& source = file->source;
  file->container = open_container(source);
  file->json = parse_json(source, file->container.json);
  const JsonAt root(source, file->json, "");
  note_files(source, root);
  const std::string version = root.member("asset").member("version").text();
  if (!version.starts_with("2."))
    fail(source, "/asset/version", fmt::format("glTF {}; 2.x is read", version));
  if (const auto least = root.member("asset").find("minVersion"))
    if (least->text() != "2.0") least->fail(fmt::format("glTF {} at least; 2.0 is read", least->text()));
  check_extensions(root);
  convert_specular_glossiness(source, file->json);
  file->reader.emplace(source, file->container, root, options);
  Model model = file->reader->read();
  find_unread(file->json, model);
  name_unread_extensions(root, model);
  model.animations = animation_names(file->json);
  if (!model.animations.empty())
    model.pose = [file](const Playing& playing, Model& posed) { file->reader->pose(playing, posed); };
  return model;
}

}  // namespace sundog::models
