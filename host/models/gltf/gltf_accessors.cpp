// glTF's binary data (glTF 2.0, section 3.6): validates every count, offset and stride.
#include "models/gltf/gltf_accessors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace sundog::models {
namespace {

constexpr std::uint64_t element_array_buffer = 34963;  // target of a view: indices
constexpr std::uint64_t most = std::uint64_t{1} << 53;

// Calls `use` with a 0 of the component's type; returns a value-initialised result for unknown components.
template <class Use>
auto with_component(std::uint64_t component, const Use& use) -> decltype(use(float{})) {
  switch (component) {
    case component_byte:
      return use(std::int8_t{});
    case component_unsigned_byte:
      return use(std::uint8_t{});
    case component_short:
      return use(std::int16_t{});
    case component_unsigned_short:
      return use(std::uint16_t{});
    case component_unsigned_int:
      return use(std::uint32_t{});
    case component_float:
      return use(float{});
    default:
      return {};
  }
}

std::size_t size_of_component(std::uint64_t component) {
  return with_component(component, [](auto value) { return sizeof value; });
}

double component_at(const char* bytes, std::uint64_t component) {
  return with_component(component, [bytes](auto value) {
    std::memcpy(&value, bytes, sizeof value);  // little-endian, as on every OpenCL host
    return static_cast<double>(value);
  });
}

double normalization(std::uint64_t component) {
  return with_component(component,
                        [](auto value) { return 1.0 / std::numeric_limits<decltype(value)>::max(); });
}

struct ElementShape {
  std::size_t columns = 0, rows = 0;  // of scalars and vectors: one column
};

ElementShape shape_of(const std::string& type) {
  if (type == "SCALAR") return {1, 1};
  const auto is_edge = [](char digit) { return digit >= '2' && digit <= '4'; };
  const auto edge = static_cast<std::size_t>(type.size() == 4 && is_edge(type[3]) ? type[3] - '0' : 0);
  if (edge > 0 && type.starts_with("VEC")) return {1, edge};
  return type.starts_with("MAT") ? ElementShape{edge, edge} : ElementShape{};
}

}  // namespace

GltfAccessors::GltfAccessors(const Source& source, const GltfContainer& container, const JsonAt& root)
    : source_(source), total_bytes_(source.bytes.size()) {
  const std::vector<JsonAt> buffers = root.list("buffers");
  storage_.reserve(buffers.size());  // views into its strings must stay valid
  for (std::size_t i = 0; i < buffers.size(); ++i) read_buffer(source, container, buffers[i], i);
  for (const JsonAt& view : root.list("bufferViews")) read_view(view);
  for (const JsonAt& accessor : root.list("accessors")) read_accessor(accessor);
}

void GltfAccessors::read_buffer(const Source& source, const GltfContainer& container, const JsonAt& at,
                                std::size_t index) {
  Buffer buffer;
  buffer.length = at.member("byteLength").integer(1, most);
  const bool glb = source.bytes.starts_with("glTF");
  if (const auto uri = at.find("uri")) {
    if (auto bytes = read_buffer_uri(source, *uri)) {
      storage_.push_back(std::move(*bytes));
      buffer.bytes = storage_.back();
      buffer.present = true;
    }
  } else if (glb && index == 0) {
    buffer.present = container.binary.has_value();
    if (buffer.present) buffer.bytes = *container.binary;
  }
  if (buffer.present && buffer.bytes.size() < buffer.length)
    at.fail(fmt::format("a byteLength of {}, but the data has {} bytes", buffer.length, buffer.bytes.size()));
  total_bytes_ += buffer.bytes.size();
  buffers_.push_back(buffer);
}

void GltfAccessors::read_view(const JsonAt& at) {
  BufferView view;
  view.buffer = at.member("buffer").index(buffers_.size(), "buffer");
  view.offset = at.integer_or("byteOffset", 0);
  const JsonAt length = at.member("byteLength");
  view.length = length.integer(1, most);
  view.target = at.integer_or("target", 0);
  const std::size_t whole = buffers_[view.buffer].length;
  if (view.offset > whole || view.length > whole - view.offset)
    length.fail(
        fmt::format("bytes {} to {} of a buffer of {}", view.offset, view.offset + view.length, whole));
  if (const auto stride = at.find("byteStride")) {
    view.stride = stride->integer(4, 252);
    if (view.stride % 4 != 0) stride->fail(fmt::format("a stride of {}, not a multiple of 4", view.stride));
    if (view.stride > view.length)
      stride->fail(fmt::format("a stride of {} in {} bytes", view.stride, view.length));
    if (view.target == element_array_buffer)
      stride->fail("a stride is for vertex attributes, not for indices");
  }
  views_.push_back(view);
}

void GltfAccessors::read_accessor(const JsonAt& at) {
  Accessor accessor;
  accessor.pointer = at.pointer();
  accessor.type = at.member("type").text();
  accessor.dense.component = at.member("componentType").integer(0, most);
  accessor.dense.count = at.member("count").integer(1, most);
  const std::size_t size = size_of_component(accessor.dense.component);
  // An unknown type makes the accessor unusable, not the file.
  const ElementShape shape = shape_of(accessor.type);
  accessor.dense.components = size == 0 ? 0 : shape.columns * shape.rows;
  const std::size_t column = shape.rows * size;
  accessor.dense.padding = shape.columns > 1 ? (4 - column % 4) % 4 : 0;  // matrices align their columns
  accessor.dense.element_size = shape.columns * (column + accessor.dense.padding);
  accessor.normalized = at.boolean("normalized", false);
  if (accessor.normalized && size == 4)
    at.member("normalized").fail("only integers of 8 and 16 bits are normalised");
  if (const auto view = at.find("bufferView")) {
    accessor.has_view = true;
    accessor.dense.view = view->index(views_.size(), "buffer view");
    accessor.dense.offset = at.integer_or("byteOffset", 0);
    if (accessor.dense.components > 0) check_room(at, accessor.dense);
  } else if (const auto offset = at.find("byteOffset")) {
    warnings_.push_back(
        fmt::format("{}: a byteOffset without a bufferView is left aside", offset->pointer()));
  }
  if (const auto sparse = at.find("sparse")) read_sparse(*sparse, accessor);
  accessors_.push_back(std::move(accessor));
}

std::string GltfAccessors::view_bytes(const JsonAt& at) const {
  const BufferView& view = views_[at.index(views_.size(), "buffer view")];
  const Buffer& buffer = buffers_[view.buffer];
  if (!buffer.present) at.fail("the view's buffer is out of reach");
  return std::string(buffer.bytes.substr(view.offset, view.length));
}

void GltfAccessors::read_sparse(const JsonAt& at, Accessor& accessor) {
  const std::size_t count = at.member("count").integer(1, accessor.dense.count);
  const JsonAt indices = at.member("indices"), values = at.member("values");
  const JsonAt type = indices.member("componentType");
  const std::uint64_t component = type.integer(0, most);
  if (component != component_unsigned_byte && component != component_unsigned_short &&
      component != component_unsigned_int)
    type.fail(fmt::format("sparse indices of type {}; 5121, 5123 or 5125 wanted", component));
  accessor.sparse = true;
  accessor.sparse_indices = part_of_sparse(indices, component, 1, count);
  accessor.sparse_indices.element_size = size_of_component(component);
  accessor.sparse_values = part_of_sparse(values, accessor.dense.component, accessor.dense.components, count);
  accessor.sparse_values.element_size = accessor.dense.element_size;
  accessor.sparse_values.padding = accessor.dense.padding;
  check_room(indices, accessor.sparse_indices);
  if (accessor.dense.components > 0) check_room(values, accessor.sparse_values);
}

Elements GltfAccessors::part_of_sparse(const JsonAt& at, std::uint64_t component, std::size_t components,
                                       std::size_t count) {
  Elements part;
  const JsonAt view = at.member("bufferView");
  part.view = view.index(views_.size(), "buffer view");
  if (views_[part.view].stride != 0) view.fail("the parts of a sparse accessor must be tightly packed");
  part.offset = at.integer_or("byteOffset", 0);
  part.component = component;
  part.components = components;
  part.count = count;
  return part;
}

// Checks that the view holds all elements. They are copied byte by byte, so none needs to be aligned.
void GltfAccessors::check_room(const JsonAt& at, const Elements& elements) const {
  const BufferView& view = views_[elements.view];
  const std::size_t size = elements.element_size, stride = view.stride ? view.stride : size;
  const std::size_t last = size - elements.padding;
  if (stride < size) at.fail(fmt::format("elements of {} bytes in a view with a stride of {}", size, stride));
  if (elements.offset > view.length || last > view.length - elements.offset ||
      (elements.count - 1) > (view.length - elements.offset - last) / stride)
    at.fail(fmt::format("{} elements of {} bytes, {} apart, from byte {}: the view has {} bytes",
                        elements.count, size, stride, elements.offset, view.length));
}

void GltfAccessors::fail_at(const Accessor& accessor, const std::string& what) const {
  fail(source_, accessor.pointer, what);
}

const char* GltfAccessors::bytes_of(const Accessor& accessor, const Elements& elements,
                                    std::size_t& stride) const {
  const BufferView& view = views_[elements.view];
  const Buffer& buffer = buffers_[view.buffer];
  if (!buffer.present)
    fail_at(accessor, fmt::format("buffer {} is not at hand: it has no file beside this one", view.buffer));
  stride = view.stride ? view.stride : elements.element_size;
  return buffer.bytes.data() + view.offset + elements.offset;
}

template <class Value, class Convert>
std::vector<Value> GltfAccessors::decode(const Accessor& accessor, Convert convert) {
  const Elements& dense = accessor.dense;
  if (dense.components == 0)
    fail_at(accessor, fmt::format("unknown type {} / {}", accessor.type, dense.component));
  spend(dense.count, accessor.pointer);
  spend(dense.count * (dense.components - 1), accessor.pointer);
  std::vector<Value> values(dense.count * dense.components, Value{});
  const auto read = [&](const char* element, std::size_t to) {
    const std::size_t size = size_of_component(dense.component);
    for (std::size_t c = 0; c < dense.components; ++c)
      values[to * dense.components + c] = convert(component_at(element + c * size, dense.component));
  };
  std::size_t stride = 0;
  if (accessor.has_view) {
    const char* bytes = bytes_of(accessor, dense, stride);
    for (std::size_t i = 0; i < dense.count; ++i) read(bytes + i * stride, i);
  }
  if (!accessor.sparse) return values;
  std::size_t index_stride = 0;
  const char* indices = bytes_of(accessor, accessor.sparse_indices, index_stride);
  const char* replaced = bytes_of(accessor, accessor.sparse_values, stride);
  for (std::size_t i = 0; i < accessor.sparse_indices.count; ++i) {
    const double at = component_at(indices + i * index_stride, accessor.sparse_indices.component);
    if (at >= static_cast<double>(dense.count))
      fail_at(accessor, fmt::format("sparse index {}, but there are {} elements", at, dense.count));
    read(replaced + i * stride, static_cast<std::size_t>(at));
  }
  return values;
}

void GltfAccessors::spend(std::size_t amount, const std::string& pointer) {
  const std::size_t budget = 16 * total_bytes_ + (std::size_t{1} << 20);
  if (amount > budget - spent_)
    fail(source_, pointer,
         fmt::format("the file's {} bytes would grow to more than {} values", total_bytes_, budget));
  spent_ += amount;
}

const std::vector<float>& GltfAccessors::floats(std::size_t index) {
  if (const auto found = floats_.find(index); found != floats_.end()) return found->second;
  const Accessor& accessor = accessors_.at(index);
  const double scale = accessor.normalized ? normalization(accessor.dense.component) : 1;
  auto values = decode<float>(accessor, [&](double value) {
    if (!std::isfinite(value)) return std::numeric_limits<float>::quiet_NaN();
    return static_cast<float>(accessor.normalized ? std::max(value * scale, -1.0) : value);
  });
  return floats_.emplace(index, std::move(values)).first->second;
}

const std::vector<float>& GltfAccessors::numbers(std::size_t index) {
  const std::vector<float>& values = floats(index);
  if (!std::ranges::all_of(values, [](float value) { return std::isfinite(value); }))
    fail_at(accessors_[index], "a value is not finite");
  return values;
}

const std::vector<std::uint32_t>& GltfAccessors::indices(std::size_t index) {
  if (const auto found = indices_.find(index); found != indices_.end()) return found->second;
  auto values =
      decode<std::uint32_t>(accessors_.at(index), [](double v) { return static_cast<std::uint32_t>(v); });
  return indices_.emplace(index, std::move(values)).first->second;
}

}  // namespace sundog::models
