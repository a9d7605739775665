#pragma once
#include <Eigen/Core>

namespace talus {

/// Sums of the products of numbers that were seen together, and how often they were.
class PooledProducts {
 public:
  explicit PooledProducts(Eigen::Index size) : sums_(Eigen::MatrixXd::Zero(size, size)), counts_(sums_) {}

  /// @param values  NaN: not seen
  void add(const Eigen::VectorXd& values) {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(values.size());
    const Eigen::VectorXd seen = values.array().isNaN().select(none, 1.0);
    const Eigen::VectorXd clean = values.array().isNaN().select(none, values);
    sums_ += clean * clean.transpose();
    counts_ += seen * seen.transpose();
  }

  /// Mean product of each pair; 0 of those that were never seen together.
  Eigen::MatrixXd means() const { return sums_.cwiseQuotient(counts_.cwiseMax(1.0)); }

 private:
  Eigen::MatrixXd sums_, counts_;
};

}  // namespace talus
