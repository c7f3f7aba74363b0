// SharedTable: a vector that copies share until one of them is changed. So a scene that differs from another
// in one part has the other parts' tables for nothing, and a device sees which it holds already.
#pragma once
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>
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
    static const std::vector<T> none;
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

  /// The rows to be changed: a copy of its own where others share them. One thread at a time.
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

  /// What keeps the rows where they are, as long as they are not edited; null where there are none.
  std::shared_ptr<const void> owner() const { return rows_; }

  /// Whether both have the same rows in memory: then they are equal.
  bool shares(const SharedTable& other) const { return rows_ == other.rows_; }

 private:
  std::shared_ptr<std::vector<T>> rows_;
};

}  // namespace sundog
