#pragma once
#include "talus/fit/score/score.hpp"

namespace talus {

/// Run-out of a block: the plan distance from its nominal place of release to its stop [m]. NaN: no stop was measured.
/// Mapped blocks have no release: theirs is counted from the nearest source (`run_out`).
double runout_of(const Campaign& campaign, const MeasuredBlock& block);
/// Run-outs of its trials [m], counted alike; NaN for those that did not stop on the terrain.
std::vector<double> runouts_of(const Campaign& campaign, const MeasuredBlock& block, const BlockRuns& runs);

/// Median of the measured run-outs of the fitting rows [m]: the tail begins there. NaN where none was measured.
double tail_begin(const Campaign& campaign);

/// The error in the far run-outs, which a hazard map is for: one group, the threshold-weighted CRPS (`fair_tail_crps`)
/// of the run-out beyond `tail_begin`, over the standard deviation of the fitting rows' run-outs cut off there. To it
/// all nearer stops are alike. Rows with too few simulated values score as the climatology. Without groups where fewer
/// than five rows were measured.
///
/// @param runs   empty: the climatology is scored
/// @param folds  see ScoreOptions
Score tail_score(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
                 std::span<const std::uint32_t> folds = {});
/// That of the climatology: for each block the run-outs of the other fitting rows. If the blocks were mapped where they
/// lie: those of places anywhere in the mapped region.
Score tail_score_of_climatology(const Campaign& campaign, const std::vector<bool>& ask,
                                std::span<const std::uint32_t> folds = {});

}  // namespace talus
