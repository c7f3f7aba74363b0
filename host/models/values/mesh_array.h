// An array of a mesh's vertices or triangles that owns its values or shares external memory.
#pragma once
#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace sundog {

/// A std::vector that may refer to external memory. Reading copies nothing; modification copies external
/// values first. Copies share external memory.
template <class T>
class MeshArray {
 public:
  using value_type = T;
  using const_iterator = const T*;

  MeshArray() = default;
  MeshArray(std::vector<T> values) : own_(std::move(values)) {}
  MeshArray(std::initializer_list<T> values) : own_(values) {}
  /// `values` must not change while `owner` is held.
  static MeshArray held(std::span<const T> values, std::shared_ptr<const void> owner) {
    MeshArray array;
    array.held_ = values;
    array.owner_ = std::move(owner);
    return array;
  }

  std::span<const T> span() const { return owner_ ? held_ : std::span<const T>(own_); }
  std::size_t size() const { return span().size(); }
  bool empty() const { return span().empty(); }
  const T* data() const { return span().data(); }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size(); }
  const T& operator[](std::size_t i) const { return span()[i]; }
  const T& at(std::size_t i) const { return i < size() ? span()[i] : own_.at(i); }
  const T& front() const { return span().front(); }
  const T& back() const { return span().back(); }
  bool operator==(const MeshArray& other) const {
    return size() == other.size() && std::equal(begin(), end(), other.begin());
  }

  /// The values, for modification.
  std::vector<T>& values() {
    if (owner_) own_.assign(held_.begin(), held_.end());
    owner_ = nullptr;
    return own_;
  }
  T* data() { return values().data(); }
  T* begin() { return values().data(); }
  T* end() { return values().data() + own_.size(); }
  T& operator[](std::size_t i) { return values()[i]; }
  T& at(std::size_t i) { return values().at(i); }
  T& front() { return values().front(); }
  T& back() { return values().back(); }
  void clear() { *this = MeshArray(); }
  void reserve(std::size_t count) { values().reserve(count); }
  void resize(std::size_t count, const T& value = T()) { values().resize(count, value); }
  void push_back(const T& value) { values().push_back(value); }
  void assign(std::size_t count, const T& value) { values().assign(count, value); }
  template <class It>
  void assign(It first, It last) {
    values().assign(first, last);
  }
  template <class... From>
  T& emplace_back(From&&... from) {
    return values().emplace_back(std::forward<From>(from)...);
  }

 private:
  std::vector<T> own_;
  std::span<const T> held_;
  std::shared_ptr<const void> owner_;  // null: own_ holds the values
};

}  // namespace sundog
