#include "talus/fit/calibrate/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlopt.hpp>

#include "local_model.hpp"
#include "talus/base/elementary.hpp"

namespace talus {
namespace {

/// The search of one fit. Keeps the evaluations of its designs; not those of BOBYQA, which dwells where noise lowered
/// the objective.
class Search {
 public:
  Search(const FitProblem& problem, const FitOptions& options) : problem_(problem), options_(options) {
    const auto& free = problem.free;
    const auto n = static_cast<Eigen::Index>(free.size());
    lower_.resize(n);
    upper_.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      lower_[i] = free[i].z(free[i].lower);
      upper_[i] = free[i].z(free[i].upper);
    }
    const int screened = options.starts > 1 ? kScreened * static_cast<int>(n) : 0;
    planned_ = screened + 1 + options.starts * search_length() + options.rounds * design_length();
    fit_.evaluations.assign(options.known.begin(), options.known.end());
    designed_ = LocalModel::first_unused(options.known, options.trials);
    compared_ = static_cast<std::uint32_t>(options.known.size());
  }

  Fit run() {
    try {
      std::vector<Eigen::VectorXd> places{problem_.start()};
      if (options_.starts > 0)
        for (const Eigen::VectorXd& z : choose_starts()) places.push_back(descend(z));
      move_to_best(places);
      fit_.score = score_of(fit_.z);  // the local model needs its groups and rows
      fit_.spread = options_.spread.size() > 0 ? options_.spread
                                               : LocalModel::first_spread(std::ssize(problem_.free), options_.rules);
      for (int round = 0; round < options_.rounds; ++round)
        if (refine() < options_.enough) break;
    } catch (const nlopt::forced_stop&) {  // `proceed` returned false
      fit_.interrupted = true;
    }
    if (!fit_.interrupted) fit_.score = score_of(fit_.z);
    fit_.tried = done_;
    return std::move(fit_);
  }

 private:
  static constexpr int kScreened = 6;  // points per parameter among which the starts are chosen
  static constexpr std::uint32_t kComparisons = 3'000'000'000;  // first trial of comparisons

  int search_length() const { return 6 * static_cast<int>(problem_.free.size()) + 10; }
  int design_length() const {
    return options_.design > 0 ? options_.design : LocalModel::round_length(std::ssize(problem_.free));
  }

  Evaluation at(const Eigen::VectorXd& z, const TrialRange& trials) {
    ++done_;
    if (options_.proceed && !options_.proceed(std::min(1.0, static_cast<double>(done_) / planned_)))
      throw nlopt::forced_stop();
    return evaluate(problem_, options_, z, trials);
  }

  /// Moves to the best of some places. They are compared with new trials: the lowest of many noisy values is too low,
  /// and no other place could ever be better. @return gain over the first of them
  double move_to_best(std::span<const Eigen::VectorXd> places) {
    const TrialRange fresh{options_.comparison_trials, kComparisons + options_.comparison_trials * compared_++};
    double first = 0.0;
    fit_.objective = std::numeric_limits<double>::infinity();
    for (const Eigen::VectorXd& z : places) {
      const double objective = at(z, fresh).objective;
      if (&z == &places.front()) first = objective;
      if (objective < fit_.objective) fit_.z = z, fit_.objective = objective;
    }
    fit_.model = problem_.model(problem_.sites.front(), fit_.z);
    return first - fit_.objective;
  }

  /// One round of the local model: a design, then a step if it is an improvement. @return the improvement
  double refine() {
    for (const Eigen::VectorXd& z :
         LocalModel::design(problem_, options_.seed, fit_.z, fit_.spread, design_length(), designed_))
      fit_.evaluations.push_back(at(z, {options_.trials, LocalModel::trials_of(designed_++, options_.trials)}));
    const LocalModel model(problem_, options_, fit_, fit_.spread);
    const Eigen::VectorXd step = model.step(fit_.spread) - fit_.z;
    const Eigen::VectorXd from = fit_.z;
    const double gain =
        move_to_best(std::vector<Eigen::VectorXd>{from, from + step, from + 0.5 * step, from + 0.25 * step});
    fit_.spread = model.next_spread();
    return gain;
  }

  Score score_of(const Eigen::VectorXd& z) const {
    return score_at(problem_, options_, z, {options_.comparison_trials});
  }

  /// The start itself, and the best of an additive recurrence in the middle of the box, well apart from each other.
  std::vector<Eigen::VectorXd> choose_starts() {
    const auto n = static_cast<Eigen::Index>(problem_.free.size());
    std::vector<Eigen::VectorXd> starts{problem_.start()};
    if (options_.starts <= 1) return starts;
    double root = 2.0;  // of x^(n + 1) = x + 1: the generalised golden ratio (Roberts 2018)
    for (int k = 0; k < 40; ++k) root = power(1.0 + root, 1.0 / static_cast<double>(n + 1));
    std::vector<std::pair<double, Eigen::VectorXd>> tried;
    for (int k = 1; k <= kScreened * static_cast<int>(n); ++k) {
      Eigen::VectorXd z(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const double u = std::fmod(0.5 + k * power(root, -static_cast<double>(i + 1)), 1.0);
        z[i] = std::clamp(3.0 * u - 1.5, lower_[i], upper_[i]);
      }
      tried.emplace_back(at(z, {options_.trials}).objective, z);
    }
    std::stable_sort(tried.begin(), tried.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [objective, z] : tried) {
      const bool apart = std::all_of(starts.begin(), starts.end(),
                                     [&place = z](const auto& other) { return (place - other).norm() > 1.0; });
      if (apart && static_cast<int>(starts.size()) < options_.starts) starts.push_back(z);
    }
    return starts;
  }

  /// The best place that NLopt's BOBYQA finds from z.
  Eigen::VectorXd descend(const Eigen::VectorXd& z) {
    const auto n = static_cast<unsigned>(problem_.free.size());
    // BOBYQA needs two parameters.
    nlopt::opt search(n > 1 ? nlopt::LN_BOBYQA : nlopt::LN_SBPLX, n);
    search.set_lower_bounds({lower_.begin(), lower_.end()});
    search.set_upper_bounds({upper_.begin(), upper_.end()});
    search.set_min_objective(
        [](const std::vector<double>& x, std::vector<double>&, void* self) {
          auto& me = *static_cast<Search*>(self);
          return me.at(Eigen::Map<const Eigen::VectorXd>(x.data(), std::ssize(x)), {me.options_.trials}).objective;
        },
        this);
    std::vector<double> steps;  // BOBYQA wants room for two of them between the bounds
    for (unsigned i = 0; i < n; ++i) steps.push_back(std::min(0.5, 0.4 * (upper_[i] - lower_[i])));
    search.set_initial_step(steps);
    search.set_xtol_abs(0.02);
    search.set_maxeval(search_length());
    std::vector<double> x(z.begin(), z.end());
    double objective = 0.0;
    try {
      search.optimize(x, objective);
    } catch (const nlopt::roundoff_limited&) {  // the noise of the trials: the best point so far stands
    }
    return Eigen::Map<const Eigen::VectorXd>(x.data(), std::ssize(x));
  }

  const FitProblem& problem_;
  const FitOptions& options_;
  Eigen::VectorXd lower_, upper_;
  Fit fit_;
  std::uint32_t designed_ = 0, compared_ = 0;
  int done_ = 0, planned_ = 1;
};

}  // namespace

Fit fit_parameters(const Campaign& campaign, const Model& start, std::span<const Parameter> free,
                   const std::vector<bool>& rows, const FitOptions& options) {
  return fit_parameters({campaign, start, free, rows}, options);
}

Fit fit_parameters(const FitProblem& problem, const FitOptions& options) {
  return Search(problem, options).run();
}

}  // namespace talus
