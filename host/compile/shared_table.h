// SharedTable: a copy-on-write vector. Scenes that differ in one part share the other parts' tables, and a
// device recognises the ones it already holds.
#pragma once
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace sundog {

template <class T>
class SharedTable {
 public:
  using value_type = T;
  using const_iterator = typename std::vector<T>::const_iterator;

  SharedTable() = default;
  SharedTable(std::initializer_list<T> rows) : SharedTable(std::vector<T>(rows)) {}
  SharedTable(std::vector<T> rows) : rows_(std::make_shared<std::vector<T>>(std::move(rows))) {}

  const std::vector<T>& rows() const {
    static const auto& none = *new const std::vector<T>;
    return rows_ ? *rows_ : none;
  }
  operator const std::vector<T>&() const { return rows(); }
  std::size_t size() const { return rows().size(); }
  bool empty() const { return rows().empty(); }
  const T* data() const { return rows().data(); }
  const T& operator[](std::size_t i) const { return rows()[i]; }
  const T& at(std::size_t i) const { return rows().at(i); }
  const T& front() const { return rows().front(); }
  const T& back() const { return rows().back(); }
  const_iterator begin() const { return rows().begin(); }
  const_iterator end() const { return rows().end(); }

  /// The rows for modification, copied first if shared. Not thread-safe.
  std::vector<T>& edit() {
    if (!rows_)
      rows_ = std::make_shared<std::vector<T>>();
    else if (rows_.use_count() > 1)
      rows_ = std::make_shared<std::vector<T>>(*rows_);
    return *rows_;
  }
  void push_back(T row) { edit().push_back(std::move(row)); }
  void resize(std::size_t size) { edit().resize(size); }
  void assign(std::size_t size, const T& row) { rows_ = std::make_shared<std::vector<T>>(size, row); }
  void clear() { rows_.reset(); }

  /// Keeps the rows' memory alive and unchanged until edited; null without rows.
  std::shared_ptr<const void> owner() const { return rows_; }

  /// Whether both refer to the same memory, hence are equal.
  bool shares(const SharedTable& other) const { return rows_ == other.rows_; }

 private:
  std::shared_ptr<std::vector<T>> rows_;
};

}  // namespace sundog
