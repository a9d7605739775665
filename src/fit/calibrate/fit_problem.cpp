#include "talus/fit/calibrate/fit_problem.hpp"

#include <algorithm>

#include "talus/fit/score/bootstrap.hpp"
#include "talus/fit/score/joined_scores.hpp"

namespace talus {

FitProblem::FitProblem(const Campaign& campaign, const Model& start, std::span<const Parameter> free_parameters,
                       const std::vector<bool>& rows_used)
    : sites{{"", campaign, start, rows_used, {}}}, free(free_parameters) {
  for (std::size_t i = 0; i < free.size(); ++i) sites.front().parameters.push_back({i, free[i].get, free[i].set});
}

FitProblem::FitProblem(std::vector<FitSite> all, std::span<const Parameter> free_parameters)
    : sites(std::move(all)), free(free_parameters) {}

double FitProblem::prior(const FitOptions& options) const {
  const std::vector<bool> used = rows();
  return options.prior_weight / static_cast<double>(std::count(used.begin(), used.end(), true));
}

std::vector<bool> FitProblem::rows() const {
  std::vector<bool> all;
  for (const FitSite& site : sites) all.insert(all.end(), site.rows.begin(), site.rows.end());
  return all;
}

std::vector<std::uint32_t> FitProblem::streams() const {
  std::vector<std::uint32_t> all;
  for (const FitSite& site : sites) {
    const std::vector<std::uint32_t> own = bootstrap_streams(site.campaign, site.name);
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

Eigen::VectorXd FitProblem::start() const {
  Eigen::VectorXd z = Eigen::VectorXd::Zero(std::ssize(free));
  std::vector<bool> known(free.size(), false);
  for (const FitSite& site : sites)
    for (const SiteParameter& own : site.parameters) {
      if (known[own.number]) continue;  // shared: the first site that has it decides
      known[own.number] = true;
      const Parameter& p = free[own.number];
      z[static_cast<Eigen::Index>(own.number)] = p.within(p.z(own.get(site.start)));
    }
  return z;
}

Model FitProblem::model(const FitSite& site, const Eigen::VectorXd& z) const {
  Model model = site.start;
  for (const SiteParameter& own : site.parameters)
    own.set(model, free[own.number].value(z[static_cast<Eigen::Index>(own.number)]));
  return model;
}

std::vector<Model> FitProblem::models(const Eigen::VectorXd& z) const {
  std::vector<Model> all;
  all.reserve(sites.size());
  for (const FitSite& site : sites) all.push_back(model(site, z));
  return all;
}

Score score_at(const FitProblem& problem, const FitOptions& options, const Eigen::VectorXd& z, const TrialRange& trials,
               std::size_t fewest) {
  std::vector<SiteScore> scores;
  scores.reserve(problem.sites.size());
  for (const FitSite& site : problem.sites) {
    const ObserveOptions how{.trials = trials.count,
                             .seed = options.seed,
                             .first_trial = trials.first,
                             .threads = options.threads,
                             .blocks = site.rows,
                             .effort = effort_of(options.rules),
                             .traced = options.traced};
    const std::vector<BlockRuns> runs = observe(site.campaign, problem.model(site, z), how);
    scores.push_back(
        {site.name, score(site.campaign, runs, site.rows, fit_scoring(fewest)), site.campaign.blocks.size()});
  }
  return weigh_groups(joined_scores(scores));
}

Evaluation evaluate(const FitProblem& problem, const FitOptions& options, const Eigen::VectorXd& z,
                    const TrialRange& trials) {
  const Score s = score_at(problem, options, z, trials, fewest_simulated_of(trials.count));
  Evaluation evaluation{z, Eigen::VectorXd(std::ssize(s.rows)), trials.count, s.total};
  for (std::size_t r = 0; r < s.rows.size(); ++r) evaluation.rows[static_cast<Eigen::Index>(r)] = s.rows[r].score;
  evaluation.objective += problem.prior(options) * z.squaredNorm();
  return evaluation;
}

}  // namespace talus
