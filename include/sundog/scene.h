// Scenes: read from a file or from text, or made of values in code.
//
// Every scene is a JSON document (docs/scene-reference.md has each key with its unit, range and default). The
// structs below are the usual part of it with names; set() reaches all of it.
#pragma once
#include <sundog/version.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sundog {
inline namespace v0 {

/// x, y, z in scene units, or linear red, green, blue.
using Vec3 = std::array<double, 3>;
/// Row by row; the last row is 0 0 0 1.
using Mat4 = std::array<double, 16>;
/// Everything stays where it is.
inline constexpr Mat4 identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// From where a scene is seen.
struct Camera {
  Vec3 position{0, 0, 5};  ///< in scene units
  Vec3 target{0, 0, 0};    ///< a point in the middle of the picture
  Vec3 up{0, 1, 0};        ///< a direction that is upward in the picture
  double fov = 45;         ///< vertical angle of view in degrees, (0, 180)
  double lens_radius = 0;  ///< in scene units; above 0 only what is at `focus` is sharp
  double focus = 0;        ///< depth along the view; 0: that of the target
};

/// "phong": shares of ambient, diffuse, mirrored and transmitted light. "dielectric" (glass, water): the
/// Fresnel equations decide, and `ior` must be set.
struct Material {
  std::string type = "phong";            ///< "phong" or "dielectric"
  Vec3 color{1, 1, 1};                   ///< of the ambient and the diffuse term, from 0; white: not set
  std::optional<double> ambient{};       ///< ka, from 0; default 0.1, of a dielectric 0
  std::optional<double> diffuse{};       ///< kd, from 0; default 0.8, of a dielectric 0
  double specular = 0;                   ///< ks, from 0
  double exponent = 32;                  ///< of the highlight, from 1
  std::optional<double> reflection{};    ///< kr, 0..1; default 0, of a dielectric 1
  std::optional<double> transmission{};  ///< kt, 0..1; default 0, of a dielectric 1
  double roughness = 0;                  ///< 0..1, of reflection and transmission
  std::optional<double> ior{};           ///< index of refraction inside, 0.01..100
  Vec3 emission{0, 0, 0};                ///< radiance that the outside sends out, from 0
};

/// `type` says which of the values count; docs/scene-reference.md, "Lights".
struct Light {
  std::string type = "point";  ///< "ambient", "directional", "point", "spot", "rectangle", "disk", "sphere"
  Vec3 color{1, 1, 1};         ///< linear, from 0
  double intensity = 1;        ///< times colour, from 0; of the last three types the radiance
  Vec3 position{0, 0, 0};      ///< in scene units; all but ambient and directional
  Vec3 direction{0, -1, 0};    ///< in which light travels: directional, spot, rectangle, disk
  double angle = 30;           ///< spot: half the cone, degrees, (0, 90)
  double radius = 0.5;         ///< disk, sphere: in scene units, above 0
  std::array<double, 2> size{1, 1};  ///< rectangle: width, height in scene units, above 0
  int samples = 1;                   ///< shadow rays of each surface to an extent, 1..1024
  /// Further keys of scene files with their numbers, such as {"inner_angle", 10} of a spot; they come last.
  std::map<std::string, double> more{};
};

/// Triangles in memory. Spans of `normals`, `uvs` and `colors` are empty or as long as `positions`. Without
/// normals the mesh is flat shaded.
struct MeshView {
  std::span<const std::array<float, 3>> positions{};  ///< x, y, z in the object's units, finite
  /// Indices into positions, counterclockwise seen from outside.
  std::span<const std::array<std::uint32_t, 3>> triangles{};
  std::span<const std::array<float, 3>> normals{};  ///< x, y, z, of any length above 0
  std::span<const std::array<float, 2>> uvs{};      ///< u, v; v up
  std::span<const std::array<float, 3>> colors{};   ///< linear red, green, blue
  /// Whoever holds this keeps the spans' memory as it is: the scene, its copies, and renders and sessions of
  /// them hold it, read the numbers where they are, and copy none. The last of them lets go of it in its own
  /// thread. Null: add_mesh() copies the numbers.
  std::shared_ptr<const void> owner{};
};

/// A distance field by formulas (docs/formula-language.md): `map` is one iteration, `distance` an expression.
struct Formula {
  std::string map{};                                         ///< one iteration, as z = z^8 + c; empty: none
  std::string distance{};                                    ///< an expression; empty: by the map's escape
  std::vector<std::pair<std::string, double>> parameters{};  ///< names in the formulas, with their values
  int iterations = 0;                                        ///< at most; 0: the default, 8
  double bailout = 0;          ///< radius at which an orbit has escaped; 0: the default
  Vec3 low{-1.5, -1.5, -1.5};  ///< of the box outside of which it is not marched
  Vec3 high{1.5, 1.5, 1.5};    ///< of the box outside of which it is not marched
};

/// Where things stand. `transform` goes from the object's to the world's coordinates.
struct Placement {
  std::string material{};     ///< a name of add_material()'s; empty: "default", made where there is none
  std::string name{};         ///< that Session::pick() gives; may be empty
  Mat4 transform = identity;  ///< from the object's to the world's coordinates; invertible
};

/// What a program that reads other people's files grants them.
struct LoadOptions {
  std::optional<double> frame{};  ///< of an animation; none: the scene as it is written
  bool native_code = false;       ///< scenes may hold OpenCL C: only for files that you trust
  bool outside_files = false;     ///< scenes may name files outside their own folders
  /// Width and height of the picture in pixels; 0: as the file says. The camera that is made up around a
  /// model file fits it.
  std::array<int, 2> size{0, 0};
};

/// What is rendered: a JSON document, with meshes from memory beside it. A value: a copy is a scene of its
/// own (meshes are shared until they differ). One thread at a time changes a scene; render() and
/// Session::start() of several threads may use one that nobody changes.
class SUNDOG_API Scene {
 public:
  /// Empty: no objects, no lights, 640x480 pixels, black.
  Scene();
  Scene(const Scene&);                 ///< a scene of its own, which shares meshes
  Scene(Scene&&) noexcept;             ///< the other can only be destroyed or assigned to afterwards
  Scene& operator=(const Scene&);      ///< as the constructor
  Scene& operator=(Scene&&) noexcept;  ///< as the constructor
  ~Scene();

  /// A scene (.json) or a model by itself (.gltf .glb .obj .ply .stl .nff, each also .gz), for which a camera
  /// and lights are made up where it has none. Throws Error (scene).
  static Scene load(const std::filesystem::path& file, const LoadOptions& options = {});
  /// The text of a scene; names of files count from `folder`. Throws Error as load() does.
  static Scene from_json(std::string_view text, const std::filesystem::path& folder = ".",
                         const LoadOptions& options = {});

  /// The document, without meshes added from memory.
  std::string to_json() const;
  /// The value at a JSON pointer (RFC 6901), as JSON text. Throws Error (usage) where there is none.
  std::string get(std::string_view pointer) const;
  /// Whether there is a value at a JSON pointer. Throws Error (usage) for a text that is none.
  bool contains(std::string_view pointer) const;
  /// Sets one value, given as JSON text; "-" as the last key appends to an array, objects around it that are
  /// missing are made. Throws Error (usage) for text that is no JSON, or a pointer that leads nowhere.
  /// Whether the value makes sense is checked by check(), render() and Session::start().
  Scene& set(std::string_view pointer, std::string_view text);
  /// The same for a number, such as set("/camera/fov", 30.0).
  Scene& set(std::string_view pointer, double value);
  /// Takes the value at a JSON pointer out. Throws Error (usage) where there is none.
  Scene& remove(std::string_view pointer);

  /// The picture's size in pixels, each 1..65536. The camera stays as it is.
  Scene& set_size(int width, int height);
  /// Samples a pixel, 1..65536.
  Scene& set_samples(int samples);
  /// Takes the place of the scene's camera.
  Scene& set_camera(const Camera& camera);
  /// Linear colours of what no object covers, from the picture's lower to its upper edge.
  Scene& set_background(const Vec3& bottom, const Vec3& top);
  /// Adds a light. Throws Error (usage) where the document's lights are no array.
  Scene& add_light(const Light& light);
  /// Adds or replaces the material of that name. Throws Error (usage) where the document's materials are no
  /// object.
  Scene& add_material(const std::string& name, const Material& material);
  /// Adds or replaces the mesh of that name, for add_instance(). Throws Error (usage) for spans of different
  /// lengths, indices out of range, numbers that are not finite, or no triangle.
  Scene& add_mesh(const std::string& name, const MeshView& mesh);
  /// Places a mesh of add_mesh(), or of the document. This, and what else adds an object, throws Error
  /// (usage) where the document's objects are no array.
  Scene& add_instance(const std::string& mesh, const Placement& placement);
  /// A sphere; `radius` in the object's units, above 0.
  Scene& add_sphere(const Vec3& center, double radius, const Placement& placement);
  /// A box between two corners.
  Scene& add_box(const Vec3& low, const Vec3& high, const Placement& placement);
  /// An endless plane through `point`.
  Scene& add_plane(const Vec3& point, const Vec3& normal, const Placement& placement);
  /// A surface by its distance.
  Scene& add_formula(const Formula& formula, const Placement& placement);

  /// Reads the whole scene, files and all. Throws Error (scene) with the place at fault. Returns warnings,
  /// one line each.
  std::vector<std::string> check() const;

  struct Impl;
  /// For the library itself.
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace v0
}  // namespace sundog
