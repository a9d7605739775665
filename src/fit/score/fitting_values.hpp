#pragma once
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace talus {

/// Measured values of the fitting rows, with the block of each: the climatology, and what gives a spread.
template <class Value>
struct FittingValues {
  std::vector<Value> values;
  std::vector<std::uint32_t> blocks;  ///< of each value

  void add(std::uint32_t block, const Value& value) {
    values.push_back(value);
    blocks.push_back(block);
  }
  std::size_t size() const { return values.size(); }

  /// The values that the climatology of a block may know: those of blocks that are not left out together with it. All,
  /// where there are no others.
  ///
  /// @param folds  by block, see ScoreOptions; empty: the block is left out alone
  void of_others(std::uint32_t block, std::vector<Value>& out, std::span<const std::uint32_t> folds = {}) const {
    out.clear();
    for (std::size_t i = 0; i < values.size(); ++i)
      if (folds.empty() ? blocks[i] != block : folds[blocks[i]] != folds[block]) out.push_back(values[i]);
    if (out.empty() && !folds.empty()) out = values;
  }
};

inline double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Variance of the values themselves (n, not n - 1).
inline double variance_of(std::span<const double> values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum / static_cast<double>(values.size());
}

inline void keep_finite(std::span<const double> values, std::vector<double>& out) {
  out.clear();
  for (const double value : values)
    if (!std::isnan(value)) out.push_back(value);
}

}  // namespace talus
