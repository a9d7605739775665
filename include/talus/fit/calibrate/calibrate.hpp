#pragma once
#include "talus/fit/calibrate/fit_problem.hpp"

namespace talus {

/// Fits the free parameters to the asked rows of a campaign.
///
/// @param start  what is not free stays as it is there
/// @param free   at least one
/// @param rows   which blocks are used; size: blocks. Spreads come from all fitting rows
///
/// Minimises the mean normalised score, its groups weighed (`weigh_groups`), plus the prior with NLopt's LN_BOBYQA
/// (Powell 2009; quadratic models, no derivatives) from the start and from the best of a low-discrepancy set. The noise
/// of the trials ends such a search early; rounds of a least-squares quadratic model around the best point
/// (`LocalModel`) continue from there. Places are compared with trials of their own: the lowest of many noisy values is
/// too low. The same result for any number of threads.
Fit fit_parameters(const Campaign& campaign, const Model& start, std::span<const Parameter> free,
                   const std::vector<bool>& rows, const FitOptions& options);

}  // namespace talus
