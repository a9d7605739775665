#include "talus/fit/calibrate/fit_problem.hpp"

#include <algorithm>

namespace talus {

double FitProblem::prior(const FitOptions& options) const {
  return options.prior_weight / static_cast<double>(std::count(rows.begin(), rows.end(), true));
}

Evaluation evaluate(const FitProblem& problem, const FitOptions& options, const Eigen::VectorXd& z,
                    const TrialRange& trials) {
  const ObserveOptions how{
      trials.count, options.seed, trials.first, options.threads, problem.rows, {}, effort_of(options.rules)};
  const Model model = model_at(problem.start, problem.free, z);
  const Score s = weigh_groups(
      score(problem.campaign, observe(problem.campaign, model, how), problem.rows, fewest_simulated_of(trials.count)));
  Evaluation evaluation{z, Eigen::VectorXd(std::ssize(s.rows)), trials.count, s.total};
  for (std::size_t r = 0; r < s.rows.size(); ++r) evaluation.rows[static_cast<Eigen::Index>(r)] = s.rows[r].score;
  evaluation.objective += problem.prior(options) * z.squaredNorm();
  return evaluation;
}

}  // namespace talus
