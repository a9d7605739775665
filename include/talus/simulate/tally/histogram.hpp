#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>

#include "talus/base/scratch.hpp"
#include "talus/simulate/tally/bytes.hpp"

namespace talus {

/// Counts of positive values in bins: 16 of equal width to each doubling, so that a bin is 3.2 to 6.25 % wide.
///
/// The bins of the first few values are stored in the object, without further memory: most cells at the edge of a map
/// have no more values. After them, counts are stored for the bins from the smallest to the largest value: 8-bit counts
/// that widen to 16 and 32 bits when one is full. At most kSpan bins are stored, and smaller values count in the lowest
/// one. What is read and saved depends on the values only, not on their order: merging is exact.
class LogHistogram {
 public:
  static constexpr int kSpan = 128;            ///< most bins: from the largest value down to 1/128 of it or less
  static constexpr float kFloor = 0x1p-7F;     ///< smaller values count as this: 8 J, 8 mm/s or 8 mm
  static constexpr double kBinWidth = 0.0625;  ///< largest relative width of a bin

  LogHistogram() = default;
  explicit LogHistogram(MemoryPolicy memory) : memory_(memory) {}
  LogHistogram(LogHistogram&& other) noexcept { swap(other); }
  LogHistogram& operator=(LogHistogram&& other) noexcept {
    swap(other);
    return *this;
  }
  ~LogHistogram();

  void add(std::span<const float> values);
  /// The first part of `add`: makes room for the values, from `least` to `largest`, both kFloor or more; or, if they
  /// are few, adds them. Returns those that are left to be counted: all or none.
  std::span<const float> make_room(std::span<const float> values, float least, float largest);
  /// The second part of `add`: counts values for which there is room.
  void count_all(std::span<const float> values);
  /// Local copies for a loop that counts: the compiler must assume that a byte written may change any member.
  struct Narrow {
    unsigned char* counts;  ///< null if they are wider than 8 bits
    int first;
    unsigned char& of(float value) const { return counts[std::max(0, key_of(value) - first)]; }
  };
  Narrow narrow() const { return {width_ == 1 ? counts_ : nullptr, first_}; }
  void merge(const LogHistogram& other);

  void save(ByteWriter& out) const;
  /// Reads what `save` wrote. Throws std::out_of_range if the bytes cannot be that.
  static LogHistogram restored(ByteReader& in);

  std::uint64_t count() const;
  const void* counts() const { return counts_; }                     ///< their address, for the tally to prefetch
  std::size_t bytes() const { return std::size_t{size_} * width_; }  ///< of the counts

  /// The values below which these shares of the counted values lie, interpolated within their bins.
  ///
  /// @param shares  0 to 1, ascending
  /// The exact answer is the k-th smallest value, k = ceil(share n). The returned value is in the same bin: the error
  /// is less than 6.25 %. If the exact answer is below m = max(kFloor, largest / 128), only this is known, and the
  /// returned value is below 1.0625 * m. 0 if nothing was counted.
  void percentiles(std::span<const double> shares, std::span<double> values) const;

  /// A bin.
  struct Bin {
    double low = 0.0, high = 0.0;  ///< edges: low <= value < high
    bool lowest = false;           ///< the values in it may also be smaller than `low`
  };
  /// The bin of the k-th smallest value. @param k  1 to count()
  Bin bin_of(double k) const;

 private:
  static constexpr int kFew = 5;
  static constexpr int kShift = 19;  // a float keeps 23 bits after the leading one: 4 of them number a doubling's bins
  static constexpr int kKeys = 1 << (31 - kShift);  // keys of positive floats are below this

  static int key_of(float value) {
    return static_cast<int>(std::bit_cast<std::uint32_t>(value > kFloor ? value : kFloor) >> kShift);
  }
  static double edge_of(int key) { return std::bit_cast<float>(static_cast<std::uint32_t>(key) << kShift); }

  void swap(LogHistogram& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(counts_, other.counts_);
    std::swap(first_, other.first_);
    std::swap(size_, other.size_);
    std::swap(width_, other.width_);
    std::swap(few_count_, other.few_count_);
    std::swap(few_, other.few_);
  }
  std::uint32_t get(int bin) const;
  void put(int bin, std::uint32_t count);
  void add_count(int bin, std::uint32_t more);
  void add_key(int key);
  void cover(int low_key, int high_key);
  void spill(int low_key, int high_key);
  void widen(std::uint8_t width);
  LogHistogram spilled() const;
  template <class Action>
  void in_width(const Action& action) const;
  template <class Visit>
  void each_bin(const Visit& visit) const;

  MemoryPolicy memory_;
  unsigned char* counts_ = nullptr;  // null while there are few values
  std::uint16_t first_ = 0;          // key of the lowest stored bin
  std::uint16_t size_ = 0;           // bins stored
  std::uint8_t width_ = 1;           // bytes per count
  std::uint8_t few_count_ = 0;
  std::array<std::uint16_t, kFew> few_{};  // keys of the first values
};

}  // namespace talus
