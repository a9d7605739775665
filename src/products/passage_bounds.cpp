#include "talus/products/passage_bounds.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <vector>

#include "in_double.hpp"
#include "talus/base/sample.hpp"

namespace talus {
namespace {

constexpr double kStep = 0.01;               // of the logarithm of the shape
constexpr int kSteps = 2500;                 // of the table
constexpr double kLargest = kStep * kSteps;  // logarithm of its largest shape: above it the quantile is the mean

/// Quantiles over shape, by the logarithm of the shape.
struct Table {
  std::vector<double> low, high;
  Table() {
    for (int i = 0; i <= kSteps + 1; ++i) {  // the value at the end has a next one, too
      const double shape = std::exp(kStep * i), width = kTwoSided / std::sqrt(shape);
      const bool wide = shape < 1e6;  // above it the distribution is normal to 1e-6
      low.push_back(wide ? boost::math::gamma_p_inv(shape, kTail, InDouble()) / shape : 1.0 - width);
      high.push_back(wide ? boost::math::gamma_p_inv(shape, 1.0 - kTail, InDouble()) / shape : 1.0 + width);
    }
  }
};

double read(const std::vector<double>& values, double shape) {
  const double at = std::clamp(std::log(shape), 0.0, kLargest) / kStep;
  const auto i = static_cast<std::size_t>(at);
  const double share = at - static_cast<double>(i);
  return values[i] + share * (values[i + 1] - values[i]);
}

const Table& table() {
  static const Table all;
  return all;
}

}  // namespace

double gamma_high(double shape) {
  return read(table().high, shape);
}

double gamma_low(double shape) {
  return shape < 1.0 - 1e-9 ? 0.0 : read(table().low, shape);
}

Bounded table_interval(double sum, double squares, double largest) {
  const double above = sum + largest, spread = squares + largest * largest;
  return {sum, sum > 0.0 ? sum * gamma_low(sum * sum / squares) : 0.0, above * gamma_high(above * above / spread)};
}

Bounded mean_length(double length, double squares, double straight, double released) {
  squares = std::min(squares, length * length);  // as lengths are not negative; more is their rounding
  const double longest = length > 0.0 ? std::max(straight, squares / length) : straight;
  Bounded bounds = table_interval(length, squares, longest);
  const double counts = std::max(0.0, squares - length * length / released) / (longest * longest);
  const double margin = longest * ((counts + 1.0) * gamma_high(counts + 1.0) - counts);
  bounds.low = std::max(bounds.low, length > 0.0 ? length - margin : 0.0);
  bounds.high = std::min(bounds.high, length + margin);
  return {length / released, bounds.low / released, bounds.high / released};
}

}  // namespace talus
