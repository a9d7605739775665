#pragma once
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "talus/base/not_set.hpp"
#include "talus/base/scratch.hpp"
#include "talus/base/shared_memory.hpp"
#include "talus/terrain/grid.hpp"

namespace talus {

/// The values of a raster, in its own memory or in memory shared by processes.
template <class T>
class Cells {
 public:
  Cells() = default;
  /// Cells without a value yet: the thread that sets one is the first to touch its memory.
  Cells(std::size_t size, MemoryPolicy memory) : own_(size, memory), data_(own_.data()), size_(size) {}
  Cells(std::size_t size, T fill, MemoryPolicy memory = {}) : own_(memory) {
    constexpr std::size_t kPiece = std::size_t{1} << 24U;
    own_.reserve(size);
    while (own_.size() < size) {  // in pieces, so that a map can be larger than the memory
      own_.resize(std::min(size, own_.size() + kPiece), fill);
      memory.keep_below_limit();
    }
    data_ = own_.data(), size_ = size;
  }
  template <class Iterator>
  Cells(Iterator begin, Iterator end) : own_(begin, end), data_(own_.data()), size_(own_.size()) {}
  Cells(std::shared_ptr<SharedPiece> shared, std::size_t size)
      : shared_(std::move(shared)), data_(static_cast<T*>(shared_->data())), size_(size) {}
  Cells(const Cells& other) : own_(other.own_), shared_(other.shared_), size_(other.size_) {
    data_ = shared_ ? other.data_ : own_.data();
  }
  Cells(Cells&& other) noexcept { swap(other); }
  Cells& operator=(Cells other) noexcept {
    swap(other);
    return *this;
  }
  ~Cells() = default;

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  /// Memory policy of the cells; for shared cells the heap, which holds the data that belong to them.
  MemoryPolicy memory() const { return own_.get_allocator().memory; }
  bool operator==(const Cells& other) const { return std::equal(begin(), end(), other.begin(), other.end()); }

 private:
  void swap(Cells& other) noexcept {
    own_.swap(other.own_);
    shared_.swap(other.shared_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }
  std::vector<T, NotSet<ScratchAllocator<T>>> own_;
  std::shared_ptr<SharedPiece> shared_;
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Values on a grid, row 0 in the south. The reader of a file decides which value means "missing" (NaN for heights).
template <class T>
struct Raster {
  Grid grid;
  Cells<T> values;

  Raster() = default;
  Raster(const Grid& g, T fill, MemoryPolicy memory = {}) : grid(g), values(g.cells(), fill, memory) {}
  /// @param v  one value per cell; another number throws std::invalid_argument
  Raster(const Grid& g, const std::vector<T>& v) : grid(g), values(v.begin(), v.end()) {
    if (v.size() != g.cells()) throw std::invalid_argument("a raster has one value per cell of its grid");
  }

  T& at(int column, int row) { return values[grid.index(column, row)]; }
  const T& at(int column, int row) const { return values[grid.index(column, row)]; }
};

/// Calls `work(row)` for each row, from the south. With a memory limit gives memory back every few rows, so that the
/// raster can be larger than the limit.
template <class T, class Work>
void for_each_row(const Raster<T>& raster, Work work) {
  constexpr int kRows = 64;
  for (int row = 0; row < raster.grid.rows; ++row) {
    if (row % kRows == 0) raster.values.memory().keep_below_limit();
    work(row);
  }
  raster.values.memory().keep_below_limit();
}

/// Memory for the rasters of a scenario.
struct RasterMemory {
  MemoryPolicy policy;
  SharedMemory* shared = nullptr;  ///< null: each process has its own
};

/// Makes the values of a raster and lets `read` set all of them: once per machine if its processes share memory, else
/// in each process.
template <class T, class Read>
void fill_raster(Raster<T>& raster, const RasterMemory& memory, Read read) {
  const std::size_t cells = raster.grid.cells();
  if (memory.shared == nullptr) {
    raster.values = Cells<T>(cells, memory.policy);
    read();
    return;
  }
  const auto piece = memory.shared->next(cells * sizeof(T));
  raster.values = Cells<T>(piece, cells);
  if (piece->is_filled()) return;
  read();
  piece->set_filled();
}

}  // namespace talus
