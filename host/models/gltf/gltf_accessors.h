// glTF's binary data: buffers, buffer views and accessors, all validated before anything is read.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "models/gltf/gltf_container.h"

namespace sundog::models {

struct BufferView {
  std::size_t buffer = 0, offset = 0, length = 0, stride = 0;  // stride 0: tightly packed
  std::uint64_t target = 0;
};

enum ComponentType : std::uint64_t {
  component_byte = 5120,
  component_unsigned_byte = 5121,
  component_short = 5122,
  component_unsigned_short = 5123,
  component_unsigned_int = 5125,
  component_float = 5126
};

/// Location of the elements of an accessor, or of a sparse accessor's parts.
struct Elements {
  std::size_t view = 0, offset = 0, count = 0;
  std::uint64_t component = component_float;
  std::size_t components = 0;                 // per element; 0: unknown type
  std::size_t element_size = 0, padding = 0;  // bytes at an element's end that the last one may lack
};

struct Accessor {
  std::string pointer, type;
  Elements dense;
  bool has_view = false;  // false: all zeros
  bool normalized = false, sparse = false;
  Elements sparse_indices, sparse_values;
};

class GltfAccessors {
 public:
  /// Reads and validates the document's buffers, bufferViews and accessors. Throws SceneError.
  GltfAccessors(const Source& source, const GltfContainer& container, const JsonAt& root);

  const Source& source() const { return source_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  const std::vector<Accessor>& all() const { return accessors_; }
  const BufferView* view_of(const Accessor& accessor) const {
    return accessor.has_view ? &views_[accessor.dense.view] : nullptr;
  }
  /// `components` floats per element; normalised integers are scaled; decoded once. Infinities become NaN.
  const std::vector<float>& floats(std::size_t index);
  /// floats() without NaN. Throws SceneError if there is one.
  const std::vector<float>& numbers(std::size_t index);
  [[noreturn]] void fail_at(const Accessor& accessor, const std::string& what) const;
  /// The bytes of the buffer view with index `at`.
  std::string view_bytes(const JsonAt& at) const;
  /// A SCALAR accessor of an unsigned type.
  const std::vector<std::uint32_t>& indices(std::size_t index);
  /// Counts `amount` items created from the file (values, triangles, objects). Fails at `pointer` if the sum
  /// is out of proportion to the file and its buffers, as when a small file references the same data over and
  /// over.
  void spend(std::size_t amount, const std::string& pointer);
  /// Resets spend(), for content that replaces what was created before.
  void forget_spent() { spent_ = 0; }

 private:
  void read_buffer(const Source& source, const GltfContainer& container, const JsonAt& at, std::size_t index);
  void read_view(const JsonAt& at);
  void read_accessor(const JsonAt& at);
  void read_sparse(const JsonAt& at, Accessor& accessor);
  Elements part_of_sparse(const JsonAt& at, std::uint64_t component, std::size_t components,
                          std::size_t count);
  void check_room(const JsonAt& at, const Elements& elements) const;
  const char* bytes_of(const Accessor& accessor, const Elements& elements, std::size_t& stride) const;
  template <class Value, class Convert>
  std::vector<Value> decode(const Accessor& accessor, Convert convert);

  const Source& source_;
  struct Buffer {
    std::string_view bytes;  // empty if the buffer is unavailable
    std::size_t length = 0;
    bool present = false;
  };
  std::vector<Buffer> buffers_;
  std::vector<std::string> storage_;  // backs `bytes`, except for a GLB's chunk
  std::vector<BufferView> views_;
  std::vector<Accessor> accessors_;
  std::vector<std::string> warnings_;
  std::map<std::size_t, std::vector<float>> floats_;
  std::map<std::size_t, std::vector<std::uint32_t>> indices_;
  std::size_t total_bytes_ = 0, spent_ = 0;
};

}  // namespace sundog::models
