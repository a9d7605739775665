#pragma once
#include <algorithm>
#include <optional>

#include "talus/fit/calibrate/fit_problem.hpp"
#include "talus/fit/calibrate/quadratic.hpp"

namespace talus {

/// The place where a fit ended, its score, whose groups are weighed as the objective's are, and all that it evaluated.
struct EndOfFit {
  const Eigen::VectorXd& z;
  const Score& score;
  const std::vector<Evaluation>& evaluations;
};

/// A quadratic model of every row score around the optimum of a fit, by least squares over the evaluations near it. It
/// gives the next step, and how far other blocks, another prior and other random numbers would move the optimum.
class LocalModel {
 public:
  static constexpr std::uint32_t kDesigns = 2'000'000'000;  ///< first trial of designs

  /// @param fit     its score must outlive the model
  /// @param spread  covariance of the places it is fitted to; those far outside do not count
  LocalModel(const FitProblem& problem, const FitOptions& options, const EndOfFit& fit, const Eigen::MatrixXd& spread);
  LocalModel(const FitProblem& problem, const FitOptions& options, const Fit& fit, const Eigen::MatrixXd& spread)
      : LocalModel(problem, options, EndOfFit{fit.z, fit.score, fit.evaluations}, spread) {}

  /// Number of evaluations of one round.
  static int round_length(Eigen::Index parameters) { return std::max(60, 8 * static_cast<int>(parameters) + 10); }
  /// Covariance of the design of the first round.
  static Eigen::MatrixXd first_spread(Eigen::Index parameters, const SearchRules& rules);
  /// Places around the centre, normally distributed within the bounds. `first`: number of the first of them.
  static std::vector<Eigen::VectorXd> design(const FitProblem& problem, std::uint64_t seed,
                                             const Eigen::VectorXd& centre, const Eigen::MatrixXd& spread, int count,
                                             std::uint32_t first);

  /// First trial of place number `place`: each place has trials of its own, so that the model averages over them.
  static std::uint32_t trials_of(std::uint32_t place, std::uint32_t trials) { return kDesigns + place * trials; }

  /// Number of the first place whose trials no known evaluation has used, with so many trials for each place.
  static std::uint32_t first_unused(std::span<const Evaluation> known, std::uint32_t trials);

  /// The minimum of the model, within the bounds and two standard deviations of the spread.
  Eigen::VectorXd step(const Eigen::MatrixXd& spread) const;
  /// The optimum for other weights of the blocks (size: blocks), within two standard deviations of the spread. Slopes,
  /// curvatures and the weight of the prior are those of the blocks that count.
  Eigen::VectorXd optimum(std::span<const double> block_weights, const Eigen::MatrixXd& spread) const;
  /// The optimum of draw number `draw` of the posterior sample.
  Eigen::VectorXd draw(std::uint32_t draw) const;
  /// The covariance of the next design: in each direction as wide as the objective rises by `rules.rise`, so that a
  /// sharp direction does not hide the flat ones.
  Eigen::MatrixXd next_spread() const;
  /// Standard deviation of a total around the model, for FitOptions::trials.
  double noise() const { return noise_; }

 private:
  Eigen::MatrixXd curvature_of(const Eigen::VectorXd& total, double prior) const;

  const FitProblem& problem_;
  const FitOptions& options_;
  const Score& score_;
  double prior_;
  Eigen::VectorXd centre_, low_, high_;  // low, high: bounds from the centre
  std::optional<QuadraticFit> model_;
  Eigen::MatrixXd rows_;          // coefficients x row scores
  Eigen::VectorXd total_;         // coefficients of the total
  Eigen::VectorXd noise_factor_;  // noise of each evaluation over noise_
  Eigen::MatrixXd from_v_;        // gradient in z = this times the gradient in the coordinates of the spread
  Eigen::MatrixXd curvature_;     // in z, with the prior
  double noise_ = 0.0;
};

}  // namespace talus
