// Reads the vertices of a PLY file, in parallel if all have the same size in bytes.
#pragma once
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "models/far_mesh.h"
#include "models/ply/ply_cursor.h"
#include "models/ply/ply_layout.h"
#include "models/values/mesh.h"

namespace sundog::models::ply {

// The content read so far.
struct Content {
  Mesh mesh;
  dvec3 origin{0};                     // origin of the positions
  std::vector<glm::vec3> face_colors;  // per triangle, if faces have colours and vertices have none
  std::vector<glm::vec2> corner_uvs;   // three per triangle, if faces have them and vertices have none
  std::vector<std::uint32_t> images;   // per triangle, if faces name them
  std::size_t dropped = 0;
  std::size_t normals_of_no_number = 0, uvs_of_no_number = 0;
  std::set<std::uint32_t> lost;  // NaN positions
  std::vector<std::string> unread;
};

// Reads an element's scalars into `values` and passes list items to `item(property number, value)`.
template <class Cursor, class Item>
void read_element(Cursor& cursor, const PlyElement& element, const Layout& layout, Values& values,
                  Item item) {
  cursor.begin_element(element.name);
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    if (property.count_type) {
      const double length = cursor.value(property, *property.count_type);
      if (length < 0) cursor.fail(fmt::format("{}: a list of length {}", property.name, length));
      for (double i = 0; i < length; ++i) item(p, cursor.value(property, property.type));
    } else {
      values[layout.slots[p]] =
          slot_value(layout.slots[p], property.type, cursor.value(property, property.type));
    }
  }
  cursor.end_element(element.name);
}

/// Reads the vertices of an element. The file must be known to hold that many.
template <class Cursor>
class VertexReader {
 public:
  VertexReader(const PlyElement& element, Content& content)
      : element_(element), layout_(element), content_(content) {}

  /// Moves the cursor past the vertices.
  void read(Cursor& cursor) {
    if (!layout_.has[px] || !layout_.has[py] || !layout_.has[pz])
      cursor.fail("a vertex needs the properties x, y and z");
    Mesh& mesh = content_.mesh;
    if (!mesh.positions.empty()) cursor.fail("a second element 'vertex'");
    mesh.source_vertex_count = element_.count;
    positions_ = std::make_unique_for_overwrite<dvec3[]>(element_.count);
    if (layout_.normals()) normals_ = resized(mesh.normals);
    if (layout_.uvs()) uvs_ = resized(mesh.uvs);
    if (layout_.colors()) colors_ = resized(mesh.colors);
    read_ranges(cursor);
    // A NaN position is an error if a face uses it; until then it repeats the one before.
    for (const std::uint32_t v : content_.lost) positions_[v] = v > 0 ? positions_[v - 1] : dvec3(0);
    if (fades_) content_.unread.emplace_back("alpha of vertices");
    const dvec3 origin = near_origin({positions_.get(), element_.count});
    glm::vec3* const near = resized(mesh.positions);
    in_ranges(element_.count, [&](std::size_t i) { near[i] = glm::vec3(positions_[i] - origin); });
    content_.origin = origin;
  }

 private:
  static constexpr std::size_t range_size = 16384;

  template <class Array>
  auto* resized(Array& array) {
    array.values().resize(element_.count);
    return array.values().data();
  }

  template <class Body>
  static void in_ranges(std::size_t count, const Body& body) {
    tbb::parallel_for(std::size_t{0}, (count + range_size - 1) / range_size, [&](std::size_t range) {
      const std::size_t end = std::min(count, (range + 1) * range_size);
      for (std::size_t i = range * range_size; i < end; ++i) body(i);
    });
  }

  void read_ranges(Cursor& cursor) {
    const std::size_t count = element_.count, bytes = Cursor::bytes_of_scalars(element_);
    if (bytes == 0) return read_range(cursor, 0, count);
    // The first bad vertex of the file is reported, whichever thread fails first.
    std::vector<std::exception_ptr> failures((count + range_size - 1) / range_size);
    tbb::parallel_for(std::size_t{0}, failures.size(), [&](std::size_t range) {
      Cursor own = cursor;
      own.skip(range * range_size * bytes);
      try {
        read_range(own, range * range_size, std::min(count, (range + 1) * range_size));
      } catch (const SceneError&) {
        failures[range] = std::current_exception();
      }
    });
    for (const std::exception_ptr& failure : failures)
      if (failure) std::rethrow_exception(failure);
    cursor.skip(count * bytes);
  }

  void read_range(Cursor& cursor, std::size_t begin, std::size_t end) {
    Values v{};
    std::vector<std::uint32_t> lost;
    std::size_t bad_normals = 0, bad_uvs = 0;
    const auto narrow = [&](Slot slot) { return static_cast<float>(bounded(cursor, v[slot])); };
    for (std::size_t i = begin; i < end; ++i) {
      read_element(cursor, element_, layout_, v, [](std::size_t, double) {});
      positions_[i] = dvec3(bounded(cursor, v[px]), bounded(cursor, v[py]), bounded(cursor, v[pz]));
      if (!is_finite(positions_[i])) lost.push_back(static_cast<std::uint32_t>(i));
      if (normals_) normals_[i] = number_or_zero(glm::vec3(narrow(nx), narrow(ny), narrow(nz)), bad_normals);
      if (uvs_) uvs_[i] = number_or_zero(glm::vec2(narrow(tu), narrow(tv)), bad_uvs);
      if (colors_) colors_[i] = color_of(v);
      if (layout_.has[alpha] && v[alpha] < 1) fades_ = true;
    }
    const std::lock_guard lock(mutex_);
    content_.lost.insert(lost.begin(), lost.end());
    content_.normals_of_no_number += bad_normals;
    content_.uvs_of_no_number += bad_uvs;
  }

  static double bounded(const Cursor& cursor, double value) {
    if (std::abs(value) > static_cast<double>(std::numeric_limits<float>::max()))
      cursor.fail(fmt::format("{} is beyond single precision's range", value));
    return value;
  }

  template <class Vector>
  static Vector number_or_zero(const Vector& value, std::size_t& count) {
    if (is_finite(value)) return value;
    ++count;
    return Vector(0);
  }

  const PlyElement& element_;
  const Layout layout_;
  Content& content_;
  std::unique_ptr<dvec3[]> positions_;
  glm::vec3 *normals_ = nullptr, *colors_ = nullptr;
  glm::vec2* uvs_ = nullptr;
  std::atomic<bool> fades_ = false;
  std::mutex mutex_;
};

}  // namespace sundog::models::ply
