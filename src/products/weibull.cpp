#include "talus/products/weibull.hpp"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>

#include "beta_draw.hpp"
#include "talus/base/expect.hpp"
#include "talus/base/random.hpp"
#include "talus/base/sample.hpp"
#include "talus/products/interval.hpp"

namespace talus {
namespace {

constexpr std::size_t kMostSimulated = 2000;  // values of one bootstrap draw
constexpr int kBits = 40;                     // of the shape

/// Fits to the logarithms of values. Shifts them so that the largest is 0: no power overflows.
Weibull fit_to_logarithms(std::vector<double>& logs) {
  const double largest = *std::max_element(logs.begin(), logs.end());
  const auto n = static_cast<double>(logs.size());
  double mean = 0.0, square = 0.0;
  for (double& y : logs) {
    y -= largest;
    mean += y / n;
    square += y * y / n;
  }
  const auto likelihood = [&](double shape) {
    double s0 = 0.0, s1 = 0.0, s2 = 0.0;  // sums of x^k (ln x)^i
    for (const double y : logs) {
      const double power = std::exp(shape * y);
      s0 += power;
      s1 += power * y;
      s2 += power * y * y;
    }
    const double first = s1 / s0;
    return std::make_pair(first - 1.0 / shape - mean, s2 / s0 - first * first + 1.0 / (shape * shape));
  };
  const double guess = kPi / std::sqrt(6.0 * (square - mean * mean));  // from the variance of ln x
  std::uintmax_t steps = 100;
  const double shape =
      boost::math::tools::newton_raphson_iterate(likelihood, guess, guess / 100.0, guess * 100.0, kBits, steps);
  double sum = 0.0;
  for (const double y : logs) sum += std::exp(shape * y);
  return {shape, std::exp(largest + std::log(sum / n) / shape)};
}

/// Draws n values of the standard exponential distribution, which is Weibull (1, 1), and fits them.
Weibull fit_to_standard(std::size_t n, std::uint32_t draw, std::uint64_t seed, std::vector<double>& logs) {
  const Random random(seed, 0, draw, Purpose::Bootstrap);
  logs.resize(n);
  for (std::uint32_t i = 0; i < n; i += 4) {
    const Words words = random.words(i / 4);
    for (std::uint32_t j = i; j < std::min<std::size_t>(n, i + 4); ++j)
      logs[j] = std::log(-std::log(uniform(words[j - i])));
  }
  return fit_to_logarithms(logs);
}

template <class Value>
Interval middle_of_draws(const std::vector<WeibullDraw>& draws, Value value) {
  std::vector<double> values;
  values.reserve(draws.size());
  for (const WeibullDraw& draw : draws) values.push_back(value(draw));
  return middle_of(std::move(values));
}

/// Bootstrap sample of the law behind n values with this fit: the pivots of simulated fits, solved for shape and scale.
std::vector<WeibullDraw> laws_of(const Weibull& fit, std::size_t n, const BootstrapOptions& options) {
  const std::size_t simulated = std::min(n, kMostSimulated);
  const double shrink = std::sqrt(static_cast<double>(simulated) / static_cast<double>(n));
  std::vector<WeibullDraw> draws;
  draws.reserve(options.draws);
  std::vector<double> logs;
  for (std::uint32_t draw = 0; draw < options.draws; ++draw) {
    const Weibull pivot = fit_to_standard(simulated, draw, options.seed, logs);
    const double shape = fit.shape / std::exp(shrink * std::log(pivot.shape));
    draws.push_back({{shape, fit.scale * std::exp(-shrink * std::log(pivot.scale) / shape)}});
  }
  return draws;
}

/// Adds the share of the values above 0 to each draw: of the posterior of a binomial share under Jeffreys' prior.
void draw_shares(WeibullFit& fit, std::uint64_t seed) {
  if (fit.zeros == 0) return;
  const auto zeros = static_cast<double>(fit.zeros), others = static_cast<double>(fit.values - fit.zeros);
  for (std::uint32_t draw = 0; draw < fit.draws.size(); ++draw)
    fit.draws[draw].positive = beta_draw(Random(seed, 1, draw, Purpose::Bootstrap), others + 0.5, zeros + 0.5);
}

}  // namespace

double Weibull::exceedance(double x) const {
  return x > 0.0 ? std::exp(-std::pow(x / scale, shape)) : 1.0;
}

Weibull fit_weibull(std::span<const double> values) {
  std::vector<double> logs;
  logs.reserve(values.size());
  for (const double value : values) logs.push_back(std::log(value));
  return fit_to_logarithms(logs);
}

double anderson_darling(std::span<const double> sorted, const Weibull& law) {
  const std::size_t n = sorted.size();
  const auto count = static_cast<double>(n);
  const auto hazard = [&](std::size_t i) { return std::pow(sorted[i] / law.scale, law.shape); };  // -ln P(X > x)
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    sum += (2.0 * static_cast<double>(i) + 1.0) * (std::log(-std::expm1(-hazard(i))) - hazard(n - 1 - i));
  return (-count - sum / count) * (1.0 + 0.2 / std::sqrt(count));
}

WeibullFit fit_weibull(std::span<const double> values, const BootstrapOptions& options) {
  std::vector<double> positive(values.begin(), values.end());
  std::erase_if(positive, [](double value) { return !(value > 0.0); });
  std::sort(positive.begin(), positive.end());
  TALUS_EXPECT(positive.size() >= kFewestForWeibull, "a law is fitted to enough values");
  WeibullFit fit;
  fit.values = values.size();
  fit.zeros = values.size() - positive.size();
  fit.law = fit_weibull(positive);
  fit.distance = anderson_darling(positive, fit.law);
  fit.draws = laws_of(fit.law, positive.size(), options);
  draw_shares(fit, options.seed);
  fit.shape = middle_of_draws(fit.draws, [](const WeibullDraw& draw) { return draw.law.shape; });
  fit.scale = middle_of_draws(fit.draws, [](const WeibullDraw& draw) { return draw.law.scale; });
  return fit;
}

Exceedance exceedance(const WeibullFit& fit, std::span<const double> values, double limit) {
  const double positive = 1.0 - static_cast<double>(fit.zeros) / static_cast<double>(fit.values);
  const auto above =
      static_cast<std::uint64_t>(std::count_if(values.begin(), values.end(), [&](double v) { return v > limit; }));
  const auto by = [&](const WeibullDraw& draw) { return draw.positive * draw.law.exceedance(limit); };
  return {by({fit.law, positive}), middle_of_draws(fit.draws, by),
          static_cast<double>(above) / static_cast<double>(values.size()),
          probability_bounds(above, values.size(), kConfidence)};
}

}  // namespace talus
