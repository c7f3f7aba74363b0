// Scenes, read from a file or from text, or built in code.
//
// Every scene is a JSON document (docs/reference/scene-reference.md lists each key with unit, range and
// default). The structs below cover the common keys; set() reaches all of them.
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
/// Row-major; the last row is 0 0 0 1.
using Mat4 = std::array<double, 16>;
/// The identity transform.
inline constexpr Mat4 identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// The point of view.
struct Camera {
  Vec3 position{0, 0, 5};  ///< in scene units
  Vec3 target{0, 0, 0};    ///< a point in the centre of the picture
  Vec3 up{0, 1, 0};        ///< direction that points up in the picture
  double fov = 45;         ///< vertical angle of view in degrees, (0, 180)
  double lens_radius = 0;  ///< aperture radius in scene units; above 0, only objects at `focus` are sharp
  double focus = 0;        ///< focus distance along the view; 0: the target's distance
};

/// "phong": shares of ambient, diffuse, reflected and transmitted light. "dielectric" (glass, water): the
/// Fresnel equations set the shares; requires `ior`.
struct Material {
  std::string type = "phong";  ///< "phong" or "dielectric"
  Vec3 color{1, 1, 1};         ///< ambient and diffuse colour, from 0; white: not written to the document
  std::optional<double> ambient{};       ///< ka, from 0; default 0.1 (dielectric: 0)
  std::optional<double> diffuse{};       ///< kd, from 0; default 0.8 (dielectric: 0)
  double specular = 0;                   ///< ks, from 0
  double exponent = 32;                  ///< the highlight's exponent, from 1
  std::optional<double> reflection{};    ///< kr, 0..1; default 0 (dielectric: 1)
  std::optional<double> transmission{};  ///< kt, 0..1; default 0 (dielectric: 1)
  double roughness = 0;                  ///< 0..1, of reflection and transmission
  std::optional<double> ior{};           ///< index of refraction inside, 0.01..100
  Vec3 emission{0, 0, 0};                ///< radiance emitted to the outside, from 0
};

/// A light; `type` decides which members apply (docs/reference/scene-reference.md, "Lights").
struct Light {
  std::string type = "point";  ///< "ambient", "directional", "point", "spot", "rectangle", "disk", "sphere"
  Vec3 color{1, 1, 1};         ///< linear, from 0
  double intensity = 1;        ///< multiplies color, from 0; radiance for the last three types
  Vec3 position{0, 0, 0};      ///< in scene units; ignored by ambient and directional
  Vec3 direction{0, -1, 0};    ///< direction of the emitted light: directional, spot, rectangle, disk
  double angle = 30;           ///< spot: half angle of the cone in degrees, (0, 90)
  double radius = 0.5;         ///< disk, sphere: in scene units, above 0
  std::array<double, 2> size{1, 1};  ///< rectangle: width, height in scene units, above 0
  int samples = 1;  ///< area and directional lights: shadow rays from each surface point, 1..1024
  /// Other numeric keys of scene files, such as {"inner_angle", 10} for a spot; applied last.
  std::map<std::string, double> more{};
};

/// Triangles in memory. `normals`, `uvs` and `colors` are empty or as long as `positions`. Without normals
/// the mesh is flat shaded.
struct MeshView {
  std::span<const std::array<float, 3>> positions{};  ///< x, y, z in the object's units, finite
  /// Indices into positions, counterclockwise seen from outside.
  std::span<const std::array<std::uint32_t, 3>> triangles{};
  std::span<const std::array<float, 3>> normals{};  ///< x, y, z, of any length above 0
  std::span<const std::array<float, 2>> uvs{};      ///< u, v; v up
  std::span<const std::array<float, 3>> colors{};   ///< linear red, green, blue
  /// Keeps the memory of the spans alive: the scene, its copies, and their renders and sessions share it and
  /// read the numbers in place. The last holder releases it on its own thread. Null: add_mesh() copies the
  /// numbers.
  std::shared_ptr<const void> owner{};
};

/// A distance field given by formulas (docs/reference/formula-language.md).
struct Formula {
  std::string map{};       ///< one iteration, such as z = z^8 + c; empty: none
  std::string distance{};  ///< an expression; empty: estimated from the map's escape
  std::vector<std::pair<std::string, double>> parameters{};  ///< names in the formulas, with values
  int iterations = 0;                                        ///< maximum; 0: the default, 8
  double bailout = 0;          ///< radius at which an orbit has escaped; 0: the default
  Vec3 low{-1.5, -1.5, -1.5};  ///< lower corner of the bounding box
  Vec3 high{1.5, 1.5, 1.5};    ///< upper corner of the bounding box
};

/// An object's position, material and name.
struct Placement {
  std::string material{};     ///< a name given to add_material(); empty: "default", created if missing
  std::string name{};         ///< reported by Session::pick(); may be empty
  Mat4 transform = identity;  ///< from the object's to the world's coordinates; invertible
};

/// Options for reading a scene, and permissions that untrusted scenes should not have.
struct LoadOptions {
  std::optional<double> frame{};  ///< animation frame; none: the scene as written
  bool native_code = false;       ///< allow OpenCL C in scenes: only for files that you trust
  bool outside_files = false;     ///< allow file names outside the scene's folder
  /// Width and height in pixels; 0: as in the file. The camera generated for a model file fits this size.
  std::array<int, 2> size{0, 0};
};

/// A JSON document and meshes from memory. A value: copies are independent (they share meshes until one
/// changes). Changing a scene needs exclusive access; render() and Session::start() may read an unchanging
/// scene from several threads.
class SUNDOG_API Scene {
 public:
  /// An empty scene: no objects, no lights, 640x480 pixels, black background.
  Scene();
  Scene(const Scene&);                 ///< independent; meshes are shared
  Scene(Scene&&) noexcept;             ///< afterwards `other` can only be destroyed or assigned to
  Scene& operator=(const Scene&);      ///< as the copy constructor
  Scene& operator=(Scene&&) noexcept;  ///< as the move constructor
  ~Scene();

  /// Reads a scene (.json) or a model in any format that `sundog render` accepts; a model without a camera or
  /// lights gets defaults. Throws Error (scene).
  static Scene load(const std::filesystem::path& file, const LoadOptions& options = {});
  /// Reads a scene from text; file names in it are relative to `folder`. Throws Error (scene).
  static Scene from_json(std::string_view text, const std::filesystem::path& folder = ".",
                         const LoadOptions& options = {});

  /// Returns the document, without meshes added from memory.
  std::string to_json() const;
  /// Returns the value at a JSON pointer (RFC 6901) as JSON text. Throws Error (usage) if there is none.
  std::string get(std::string_view pointer) const;
  /// Tells whether a JSON pointer leads to a value. Throws Error (usage) for a malformed pointer.
  bool contains(std::string_view pointer) const;
  /// Sets one value, given as JSON text. "-" as the last key appends to an array; missing parent objects are
  /// created. Throws Error (usage) for malformed JSON or a pointer that leads nowhere. check(), render() and
  /// Session::start() validate the value.
  Scene& set(std::string_view pointer, std::string_view text);
  /// Sets a number, such as set("/camera/fov", 30.0).
  Scene& set(std::string_view pointer, double value);
  /// Removes the value at a JSON pointer. Throws Error (usage) if there is none.
  Scene& remove(std::string_view pointer);

  /// Sets the picture's size in pixels, each 1..65536. The camera is unchanged.
  Scene& set_size(int width, int height);
  /// Sets the samples per pixel, 1..65536.
  Scene& set_samples(int samples);
  /// Replaces the scene's camera.
  Scene& set_camera(const Camera& camera);
  /// Sets the background as linear colours at the picture's lower and upper edge.
  Scene& set_background(const Vec3& bottom, const Vec3& top);
  /// Adds a light. Throws Error (usage) if the document's "lights" is not an array.
  Scene& add_light(const Light& light);
  /// Adds or replaces the named material. Throws Error (usage) if the document's "materials" is not an
  /// object.
  Scene& add_material(const std::string& name, const Material& material);
  /// Adds or replaces the named mesh, for add_instance(). Throws Error (usage) for spans of different
  /// lengths, indices out of range, non-finite numbers, or an empty mesh.
  Scene& add_mesh(const std::string& name, const MeshView& mesh);
  /// Places a mesh from add_mesh() or from the document. This and the functions below throw Error (usage) if
  /// the document's "objects" is not an array.
  Scene& add_instance(const std::string& mesh, const Placement& placement);
  /// Adds a sphere; `radius` in the object's units, above 0.
  Scene& add_sphere(const Vec3& center, double radius, const Placement& placement);
  /// Adds an axis-aligned box between two corners, in the object's units.
  Scene& add_box(const Vec3& low, const Vec3& high, const Placement& placement);
  /// Adds an infinite plane through `point`.
  Scene& add_plane(const Vec3& point, const Vec3& normal, const Placement& placement);
  /// Adds a distance field.
  Scene& add_formula(const Formula& formula, const Placement& placement);

  /// Reads the whole scene, with its files, and validates it. Returns warnings, one line each. Throws Error
  /// (scene) with the place at fault.
  std::vector<std::string> check() const;

  struct Impl;
  /// Internal.
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace v0
}  // namespace sundog
