#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "talus/fit/score/coverage.hpp"
#include "talus/fit/score/deposit_score.hpp"
#include "talus/fit/score/intervals.hpp"
#include "talus/fit/score/tail.hpp"
#include "talus/io/campaign/campaign_file.hpp"

namespace talus::io {

/// The score of some blocks of a campaign, with intervals, and what it is to be judged by.
struct ScoredRows {
  std::string rows;  ///< "fit", "holdout" or "out-of-fold"
  std::size_t blocks = 0;
  Score score;
  ScoreIntervals intervals;
  Score climatology;  ///< of the same rows
  Interval climatology_interval;
  Score compared;   ///< as `score`, but rows with too few simulated values score exactly as the climatology
  Reduction skill;  ///< by which the model, as `compared`, lowers the climatology's error
  Score ways;       ///< of the climatology that knows the releases: ScoreOptions::ways_from_release
  Interval ways_interval;
  Reduction skill_over_ways;
  /// Numbers that were fitted to these rows, those that the prior holds counted as less than one (`effective_numbers`);
  /// NaN: some, not counted.
  double fitted = 0.0;
  double tail_begin = 0.0;  ///< run-out beyond which the tail is scored [m]
  Score tail, tail_climatology;
  Reduction tail_skill;  ///< as `skill`, of the tail
  Interval tail_interval;
  std::vector<Coverage> coverage;
  LeavingTest leaving_trials;
  Score log_score, log_climatology;      ///< minus log densities [nats]
  std::optional<DepositCheck> deposits;  ///< of blocks that were mapped where they lie
  /// Blocks at rest of which more than a quarter of the trials leave the DEM; of mapped ones more than half.
  std::size_t leaving = 0;
  std::vector<std::string> not_counted;  ///< quantities that were measured, but too seldom to be scored, with numbers
};

/// The score of the model before and after a fit, on rows of one kind.
struct BeforeAfter {
  ScoredRows before, after;
  Reduction reduction;
  Reduction tail_reduction;
  NatsGained nats;
  UsedClusters clusters;  ///< that the intervals rest on
};

/// Whether more than half of a score, or of the rows of one group, is of rows that score as the climatology, as the
/// model seldom simulates what was measured: it says little of the model.
bool hardly_simulated(const Score& score);

/// "fitting", "held-out" or "out-of-fold", for "fit", "holdout" and "out-of-fold".
std::string rows_in_words(const std::string& rows);

/// Scores the asked blocks and the climatology with intervals, and counts their ranks.
///
/// @param folds  see ScoreOptions
ScoredRows scored(const std::string& rows, const Campaign& campaign, std::span<const BlockRuns> runs,
                  const std::vector<bool>& ask, const std::vector<std::uint32_t>& folds = {});

/// Settings of the scores.
struct ScoreSettings {
  std::string campaign;  ///< its name
  std::uint32_t trials = 100;
  std::uint64_t seed = 1;
  std::string surface;                     ///< of the campaign's terrain
  std::vector<std::string> warnings = {};  ///< of the input and of the scores
};

/// Compares the scores of two models on the same rows.
BeforeAfter compared(const Campaign& campaign, ScoredRows before, ScoredRows after);

/// One warning for each group in which more than half of the rows score as the climatology: such rows do not score the
/// model, so that a fit can hide its errors there.
std::vector<std::string> unscored_warnings(const ScoredRows& scored);

/// These, one each for too many and too few blocks that leave the DEM, and one for each share of measured values below
/// a simulated percentile that a right model does not give.
std::vector<std::string> score_warnings(const ScoredRows& scored);

/// Whether the model beats the climatology, in words: "no skill: ..." where it does not. Empty where nothing was
/// scored.
std::string skill_sentence(const ScoredRows& scored);

/// The skill that this sentence judges, over the better climatology. Of rows that were fitted the lower end of its
/// interval is less what fitting gains on them without any skill. NaN where it cannot be told.
Reduction judged_skill(const ScoredRows& scored);

/// The skill of a fitted model in groups of ten rows and more, as the headline of a diagnosis: on rows that it has not
/// seen, or, where these tell nothing, on those that were fitted. NaN of mapped deposits: their climatology, blocks
/// anywhere on the mapped ground, is no measure of a map.
///
/// @param clusters  of the blocks (`clusters_of`)
Reduction skill_of_model(const ScoredRows& fitting, const ScoredRows& unseen, std::span<const std::uint32_t> clusters);

/// The same without the groups of fewer than ten rows: score, climatology and skill. Nothing else of it changes.
ScoredRows in_large_groups(ScoredRows scored, std::span<const std::uint32_t> clusters);
/// The error in the far run-outs in words. Empty where it was not scored.
std::string tail_sentence(const ScoredRows& scored);
/// Its skill in words. Only where the tail was scored, and simulated.
std::string tail_against_climatology(const ScoredRows& scored);

/// Both, and the counts of the spread, as lines for the terminal.
std::string judgement_lines(const ScoredRows& scored);

/// Drawing (SVG) of the histograms of ranks after a fit, by kind of rows. Empty where nothing was counted.
std::string ranks_picture(std::span<const BeforeAfter> errors);

/// A line for a fit of which a share of the trajectories did not end within so many vertices.
std::string cut_short_line(double share, std::uint32_t most_vertices);

/// The scores as a table for people: one line per group, the rows beside the score.
std::string score_table(const ScoreSettings& settings, std::span<const ScoredRows> scores);
/// The same as JSON. The text ends with a line end.
std::string score_json(const ScoreSettings& settings, std::span<const ScoredRows> scores);

}  // namespace talus::io
