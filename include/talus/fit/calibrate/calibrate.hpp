#pragma once
#include "talus/fit/calibrate/fit_problem.hpp"

namespace talus {

/// Fits the free parameters to the asked rows of a campaign.
///
/// @param start  model whose other parameters keep their values
/// @param free   at least one
/// @param rows   true for each block that is used; size: blocks. Spreads come from all fitting rows
///
/// Minimises the mean normalised score, its groups weighed (`weigh_groups`), plus the prior with NLopt's LN_BOBYQA
/// (Powell 2009; quadratic models, no derivatives) from the start and from the best of a low-discrepancy set. The noise
/// of the trials ends such a search early; rounds of a least-squares quadratic model around the best point
/// (`LocalModel`) continue from there. Places are compared with new trials, because the lowest of many noisy values is
/// too low. The result is the same for any number of threads.
Fit fit_parameters(const Campaign& campaign, const Model& start, std::span<const Parameter> free,
                   const std::vector<bool>& rows, const FitOptions& options);
/// The same for the campaigns of a problem: one objective over the rows of all.
Fit fit_parameters(const FitProblem& problem, const FitOptions& options);

}  // namespace talus
