#pragma once
#include "talus/fit/diagnose/diagnosis.hpp"

namespace talus {

/// Raises the trials per block of a small campaign, so that it has as many in all as one of `rules.many_blocks`. The
/// noise of a mean over all blocks is then the same. At most `rules.most_of_one` times as many per block, and at least
/// `rules.fewest_of_one`.
///
/// @param blocks  number of fitting blocks
TrialsPerBlock raised_for_few_blocks(TrialsPerBlock trials, std::size_t blocks, const DiagnosisRules& rules);

/// Finds the effect that explains what a model of the ground alone leaves unexplained in a campaign's fitting rows.
///
/// @param campaign  with at least one fitting block
///
/// (1) Fits the ground. (2) Tests all candidates (score test). (3) Fits every effect at its best place, together with
/// the ground where the test finds anything in it; the best of them for longer. (4) Chooses the effect that is
/// significant in the test and has the lowest error in a cross-validation over blocks. (5) Adds it to the model and
/// begins again. The held-out rows are never used. docs/closing-the-loop.md, "Diagnosis".
///
/// Throws FitInterrupted when `proceed` returns false.
Diagnosis diagnose(const Campaign& campaign, const Model& start, const DiagnoseOptions& options);

}  // namespace talus
