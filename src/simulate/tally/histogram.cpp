#include "talus/simulate/tally/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "talus/base/expect.hpp"
#include "talus/simulate/tally/checked_sum.hpp"

namespace talus {
namespace {

unsigned char* zeros(MemoryPolicy memory, std::size_t bytes) {
  return static_cast<unsigned char*>(std::memset(memory.allocate(bytes), 0, bytes));
}

/// Number of the smallest of `total` values, one or more, below which `share` of them lie.
double rank_of(double share, std::uint64_t total) {
  const auto count = static_cast<double>(total);
  return std::clamp(std::ceil(share * count), 1.0, count);
}

}  // namespace

LogHistogram::~LogHistogram() {
  memory_.release(counts_, static_cast<std::size_t>(size_) * width_);
}

std::uint32_t LogHistogram::get(int bin) const {
  switch (width_) {
    case 1:
      return counts_[bin];
    case 2: {
      std::uint16_t value = 0;
      std::memcpy(&value, counts_ + 2 * bin, 2);
      return value;
    }
    default: {
      std::uint32_t value = 0;
      std::memcpy(&value, counts_ + 4 * bin, 4);
      return value;
    }
  }
}

void LogHistogram::put(int bin, std::uint32_t count) {
  TALUS_EXPECT(bin >= 0 && bin < size_, "a bin is one of the histogram");
  if (width_ == 1 && count > 0xFFU) widen(2);
  if (width_ == 2 && count > 0xFFFFU) widen(4);
  if (width_ == 1) {
    counts_[bin] = static_cast<unsigned char>(count);
  } else if (width_ == 2) {
    const auto value = static_cast<std::uint16_t>(count);
    std::memcpy(counts_ + 2 * bin, &value, 2);
  } else {
    std::memcpy(counts_ + 4 * bin, &count, 4);
  }
}

/// Throws InputError if the sum does not fit 32 bits.
void LogHistogram::add_count(int bin, std::uint32_t more) {
  std::uint32_t count = get(bin);
  add_checked(count, more);
  put(bin, count);
}

void LogHistogram::widen(std::uint8_t width) {
  LogHistogram wide(memory_);
  wide.counts_ = zeros(memory_, std::size_t{size_} * width);
  wide.first_ = first_;
  wide.size_ = size_;
  wide.width_ = width;
  for (int bin = 0; bin < size_; ++bin) wide.put(bin, get(bin));
  swap(wide);
}

/// Makes room for a range of keys. Grows in steps of half a doubling, so that it grows rarely.
void LogHistogram::cover(int low_key, int high_key) {
  int low = low_key & ~7, high = high_key | 7;
  if (size_ > 0) {
    low = std::min<int>(low, first_);
    high = std::max<int>(high, first_ + size_ - 1);
  }
  low = std::max(low, high - kSpan + 1);
  if (size_ > 0 && low == first_ && high == first_ + size_ - 1) return;
  LogHistogram wide(memory_);
  wide.counts_ = zeros(memory_, static_cast<std::size_t>(high - low + 1) * width_);
  wide.first_ = static_cast<std::uint16_t>(low);
  wide.size_ = static_cast<std::uint16_t>(high - low + 1);
  wide.width_ = width_;
  const int collapsed = std::clamp(low - first_, 0, static_cast<int>(size_));  // bins that fall into the lowest one
  std::uint32_t sum = 0;
  for (int bin = 0; bin < collapsed; ++bin) add_checked(sum, get(bin));
  if (collapsed < size_)
    std::memcpy(wide.counts_ + (first_ + collapsed - low) * width_, counts_ + collapsed * width_,
                static_cast<std::size_t>(size_ - collapsed) * width_);
  if (sum > 0) wide.add_count(0, sum);
  swap(wide);
}

void LogHistogram::add_key(int key) {
  const int bin = std::max(0, key - first_);
  TALUS_EXPECT(bin < size_, "there is room for a value");
  if (width_ == 1 && counts_[bin] < 0xFFU)
    ++counts_[bin];
  else
    put(bin, get(bin) + 1);
}

/// Turns the few values stored so far into counts, with room for a range of keys.
void LogHistogram::spill(int low_key, int high_key) {
  const auto few = few_;
  const int n = few_count_;
  few_count_ = 0;
  for (int i = 0; i < n; ++i) {
    low_key = std::min<int>(low_key, few[static_cast<std::size_t>(i)]);
    high_key = std::max<int>(high_key, few[static_cast<std::size_t>(i)]);
  }
  cover(low_key, high_key);
  for (int i = 0; i < n; ++i) add_key(few[static_cast<std::size_t>(i)]);
}

void LogHistogram::add(std::span<const float> values) {
  float least = std::numeric_limits<float>::infinity(), largest = kFloor;
#pragma omp simd reduction(min : least) reduction(max : largest)
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float value = values[i] > kFloor ? values[i] : kFloor;  // NaN, too, counts as the floor
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
  count_all(make_room(values, least, largest));
}

std::span<const float> LogHistogram::make_room(std::span<const float> values, float least, float largest) {
  if (values.empty()) return {};
  if (counts_ == nullptr && few_count_ + values.size() <= kFew) {
    for (const float value : values) few_[few_count_++] = static_cast<std::uint16_t>(key_of(value));
    return {};
  }
  const int low = key_of(least), high = key_of(largest);  // a key grows with its value
  if (few_count_ > 0 || low < first_ || high >= first_ + size_) spill(low, high);
  return values;
}

void LogHistogram::count_all(std::span<const float> values) {
  auto value = values.begin();
  if (const Narrow counts = narrow(); counts.counts != nullptr)
    for (; value != values.end(); ++value) {
      unsigned char& here = counts.of(*value);
      if (here == 0xFFU) break;
      ++here;
    }
  for (; value != values.end(); ++value) add_key(key_of(*value));
}

void LogHistogram::merge(const LogHistogram& other) {
  if (other.counts_ == nullptr && other.few_count_ == 0) return;
  if (other.counts_ == nullptr && counts_ == nullptr && few_count_ + other.few_count_ <= kFew) {
    for (int i = 0; i < other.few_count_; ++i) few_[few_count_++] = other.few_[static_cast<std::size_t>(i)];
    return;
  }
  const auto few_end = other.few_.begin() + other.few_count_;
  const int low = other.counts_ ? other.first_ : *std::min_element(other.few_.begin(), few_end);
  const int high = other.counts_ ? other.first_ + other.size_ - 1 : *std::max_element(other.few_.begin(), few_end);
  spill(low, high);
  for (auto key = other.few_.begin(); key != few_end; ++key) add_key(*key);
  for (int bin = 0; bin < other.size_; ++bin) {
    const std::uint32_t count = other.get(bin);
    if (count > 0) add_count(std::max(0, other.first_ + bin - first_), count);
  }
}

void LogHistogram::save(ByteWriter& out) const {
  out.put(few_count_);
  auto few = few_;
  std::sort(few.begin(), few.begin() + few_count_);  // as the order in which they came depends on the threads
  for (int i = 0; i < few_count_; ++i) out.put(few[static_cast<std::size_t>(i)]);
  out.put(size_);
  if (size_ == 0) return;
  out.put(first_);
  out.put(width_);
  out.put_all(std::span<const unsigned char>(counts_, static_cast<std::size_t>(size_) * width_));
}

LogHistogram LogHistogram::restored(ByteReader& in) {
  LogHistogram h;
  h.few_count_ = in.get<std::uint8_t>();
  if (h.few_count_ > kFew) throw std::out_of_range("values of a histogram");
  for (int i = 0; i < h.few_count_; ++i) {
    std::uint16_t& key = h.few_[static_cast<std::size_t>(i)] = in.get<std::uint16_t>();
    if (key >= kKeys) throw std::out_of_range("values of a histogram");
  }
  h.size_ = in.get<std::uint16_t>();
  if (h.size_ == 0) return h;
  h.first_ = in.get<std::uint16_t>();
  h.width_ = in.get<std::uint8_t>();
  const auto counts = in.get_all<unsigned char>();
  if ((h.width_ != 1 && h.width_ != 2 && h.width_ != 4) || h.size_ > kSpan || h.first_ + h.size_ > kKeys ||
      h.few_count_ > 0 || counts.size() != static_cast<std::size_t>(h.size_) * h.width_)
    throw std::out_of_range("bins of a histogram");
  h.counts_ = zeros(h.memory_, counts.size());
  std::memcpy(h.counts_, counts.data(), counts.size());
  return h;
}

std::uint64_t LogHistogram::count() const {
  std::uint64_t sum = few_count_;
  in_width([&](auto counts) {
    for (int bin = 0; bin < size_; ++bin) sum += counts(bin);
  });
  return sum;
}

/// Calls action(counts), where counts(bin) is the count of a bin, for the width that the counts have.
template <class Action>
void LogHistogram::in_width(const Action& action) const {
  const auto read = [counts = counts_]<class Count>(Count count, int bin) {
    std::memcpy(&count, counts + static_cast<std::size_t>(bin) * sizeof count, sizeof count);
    return std::uint32_t{count};
  };
  if (width_ == 1)
    action([&](int bin) { return read(std::uint8_t{}, bin); });
  else if (width_ == 2)
    action([&](int bin) { return read(std::uint16_t{}, bin); });
  else
    action([&](int bin) { return read(std::uint32_t{}, bin); });
}

/// Calls visit(key, count) for the bins that hold something, in ascending order; until it returns false.
template <class Visit>
void LogHistogram::each_bin(const Visit& visit) const {
  if (counts_ != nullptr) {
    in_width([&](auto counts) {
      for (int bin = 0; bin < size_; ++bin)
        if (const std::uint32_t here = counts(bin); here > 0 && !visit(first_ + bin, here)) return;
    });
    return;
  }
  auto keys = few_;
  const auto end = keys.begin() + few_count_;
  std::sort(keys.begin(), end);
  for (auto key = keys.begin(); key != end;) {
    const int lowest = (keys[few_count_ - 1U] | 7) - kSpan + 1;  // as `cover` has it
    const int here = std::max<int>(*key, lowest);
    const auto next = std::find_if(key, end, [&](int other) { return std::max(other, lowest) != here; });
    if (!visit(here, static_cast<std::uint32_t>(next - key))) return;
    key = next;
  }
}

void LogHistogram::percentiles(std::span<const double> shares, std::span<double> values) const {
  const std::uint64_t total = count();
  std::ranges::fill(values, 0.0);
  if (total == 0 || shares.empty()) return;
  std::size_t next = 0;
  double below = 0.0, rank = rank_of(shares[0], total);
  each_bin([&](int key, double here) {
    for (; below + here >= rank; rank = rank_of(shares[next], total)) {
      values[next] = edge_of(key) + (edge_of(key + 1) - edge_of(key)) * (rank - below - 0.5) / here;
      if (++next == shares.size()) return false;
    }
    below += here;
    return true;
  });
}

/// The few values as counts.
LogHistogram LogHistogram::spilled() const {
  LogHistogram bins;
  bins.few_ = few_;
  bins.few_count_ = few_count_;
  bins.spill(few_[0], few_[0]);
  return bins;
}

LogHistogram::Bin LogHistogram::bin_of(double k) const {
  if (counts_ == nullptr && few_count_ > 0) return spilled().bin_of(k);
  double below = 0.0;
  for (int bin = 0; bin < size_; ++bin) {
    const double here = get(bin);
    if (here > 0.0 && below + here >= k) {
      const int key = first_ + bin;
      const bool collected = (bin == 0 && size_ == kSpan) || key == key_of(kFloor);
      return {edge_of(key), edge_of(key + 1), collected};
    }
    below += here;
  }
  TALUS_EXPECT(false, "a histogram holds the value of each rank");
  return {};
}

}  // namespace talus
