#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace talus {

/// P-values corrected for their number, in the order given: the share of false alarms among all of them stays below the
/// level, however they depend on each other. NaN stays NaN and does not count.
/// Source: Holm (1979), "A simple sequentially rejective multiple test procedure".
inline std::vector<double> holm(std::span<const double> p_values) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p_values.size(); ++i)
    if (!std::isnan(p_values[i])) order.push_back(i);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return p_values[i]; });
  std::vector<double> corrected(p_values.begin(), p_values.end());
  double largest = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, std::min(1.0, p_values[order[i]] * static_cast<double>(order.size() - i)));
    corrected[order[i]] = largest;
  }
  return corrected;
}

/// Sets `corrected` of each row from its `p_value`.
template <class Row>
void correct_rows(std::vector<Row>& rows) {
  std::vector<double> p;
  for (const Row& row : rows) p.push_back(row.p_value);
  const std::vector<double> corrected = holm(p);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].corrected = corrected[i];
}

}  // namespace talus
