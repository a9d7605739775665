#pragma once
#include <Eigen/Core>

namespace talus {

/// Second-order polynomials fitted to noisy values at many places by weighted least squares:
///
///   f(u) = c + g . u + 1/2 u' H u
///
/// Linear in the values: the coefficients of many functions at the same places cost one factorisation.
class QuadraticFit {
 public:
  /// Added to the normal equations, so that few places are enough: second derivatives that they do not show are zero.
  struct Ridge {
    double pure, mixed;  ///< for u_i^2 and for u_i u_j: (noise of a value / typical second derivative)^2
  };

  /// @param places   one per column; size: directions x places
  /// @param weights  of the places, >= 0; size: places
  QuadraticFit(const Eigen::MatrixXd& places, const Eigen::VectorXd& weights, const Ridge& ridge);

  /// Coefficients of functions from their values: one function per column.
  /// @param values  size: places x functions. @return size: coefficients x functions
  Eigen::MatrixXd coefficients(const Eigen::MatrixXd& values) const;
  /// Values of a function at the places. Size: places.
  Eigen::VectorXd at_places(const Eigen::VectorXd& coefficients) const { return features_ * coefficients; }

  Eigen::Index directions() const { return directions_; }
  /// Number of coefficients that the values decide: all, less what the ridge holds back.
  double coefficients_used() const { return features_.cwiseProduct(solver_.transpose()).sum(); }
  /// g of a function; size: directions.
  Eigen::VectorXd gradient(const Eigen::VectorXd& coefficients) const { return coefficients.segment(1, directions_); }
  /// H of a function, with its negative curvatures set to zero; size: directions x directions.
  Eigen::MatrixXd curvature(const Eigen::VectorXd& coefficients) const;

 private:
  Eigen::Index directions_;
  Eigen::MatrixXd features_, solver_;  // places x coefficients, coefficients x places
};

/// The minimum over a box of g . u + 1/2 u' H u, H positive definite, by coordinate descent; 200 sweeps at most.
Eigen::VectorXd minimum_in_box(const Eigen::VectorXd& g, const Eigen::MatrixXd& h, const Eigen::VectorXd& low,
                               const Eigen::VectorXd& high);

}  // namespace talus
