#include "robust_density.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "fitting_values.hpp"
#include "talus/base/sample.hpp"
#include "talus/base/vector.hpp"

namespace talus {
namespace {

/// Silverman's width for normal kernels: 1.06 n^(-1/5) times the smaller of the standard deviation and that of a normal
/// distribution with the same quartiles (where these differ).
double kernel_width(std::span<const double> values, double least) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const double sd = std::sqrt(variance_of(values));
  const double quartiles = (quantile(sorted, 0.75) - quantile(sorted, 0.25)) / 1.349;
  const double scale = quartiles > 0.0 ? std::min(sd, quartiles) : sd;
  return std::max(least, 1.06 * scale * std::pow(static_cast<double>(values.size()), -0.2));
}

double mixed(double kernels, double broad, double unit) {
  return std::log(((1.0 - kBroadShare) * kernels + kBroadShare * broad) * unit);
}

struct MeanAndCovariance {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

MeanAndCovariance moments_of(std::span<const Eigen::Vector2d> places) {
  MeanAndCovariance m;
  const auto n = static_cast<double>(places.size());
  for (const Eigen::Vector2d& place : places) m.mean += place / n;
  for (const Eigen::Vector2d& place : places) m.covariance += (place - m.mean) * (place - m.mean).transpose() / n;
  return m;
}

}  // namespace

double log_density(std::span<const double> simulated, std::span<const double> broad, double y, double unit) {
  const double width = kernel_width(simulated, kLeastWidth * unit);
  double kernels = 0.0;
  for (const double value : simulated) kernels += std::exp(-0.5 * std::pow((y - value) / width, 2));
  kernels /= static_cast<double>(simulated.size()) * width * std::sqrt(2.0 * kPi);
  const double scale = std::max(kLeastWidth * unit, std::sqrt(variance_of(broad)));
  const double t = (y - mean_of(broad)) / scale;
  return mixed(kernels, 2.0 / (kPi * std::sqrt(3.0) * scale * std::pow(1.0 + t * t / 3.0, 2)), unit);
}

double log_density(std::span<const Eigen::Vector2d> simulated, std::span<const Eigen::Vector2d> broad,
                   const Eigen::Vector2d& y, double unit) {
  const Eigen::Matrix2d least = std::pow(kLeastWidth * unit, 2) * Eigen::Matrix2d::Identity();
  const double narrower = std::pow(static_cast<double>(simulated.size()), -1.0 / 3.0);  // n^(-2 / (d + 4)), d = 2
  const Eigen::Matrix2d width = narrower * moments_of(simulated).covariance + least;
  const Eigen::Matrix2d inverse = width.inverse();
  double kernels = 0.0;
  for (const Eigen::Vector2d& place : simulated) kernels += std::exp(-0.5 * (y - place).dot(inverse * (y - place)));
  kernels /= static_cast<double>(simulated.size()) * 2.0 * kPi * std::sqrt(width.determinant());
  const MeanAndCovariance b = moments_of(broad);
  const Eigen::Matrix2d scale = b.covariance + least;
  const double square = (y - b.mean).dot(scale.inverse() * (y - b.mean));
  const double t = std::pow(1.0 + square / 3.0, -2.5) / (2.0 * kPi * std::sqrt(scale.determinant()));
  return mixed(kernels, t, unit * unit);
}

double log_probability(double hits, double trials, double p, bool happened) {
  const double share = (hits + 0.5) / (trials + 1.0);
  const double event = (1.0 - kBroadShare) * share + kBroadShare * p;
  return std::log(happened ? event : 1.0 - event);
}

}  // namespace talus
