#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "talus/fit/score/bootstrap.hpp"
#include "talus/io/campaign/campaign_file.hpp"

namespace talus::io {

/// The score of some blocks of a campaign, with intervals.
struct ScoredRows {
  std::string rows;  ///< "fit" or "holdout"
  std::size_t blocks = 0;
  Score score;
  ScoreIntervals intervals;
};

/// "fitting" or "held-out", for "fit" and "holdout".
std::string rows_in_words(const std::string& rows);

/// Scores the asked blocks and bootstraps over them.
ScoredRows scored(const std::string& rows, const Campaign& campaign, std::span<const BlockRuns> runs,
                  const std::vector<bool>& ask);

/// Settings of the scores.
struct ScoreSettings {
  std::string campaign;  ///< its name
  std::uint32_t trials = 100;
  std::uint64_t seed = 1;
  std::string surface;  ///< of the campaign's terrain
};

/// One warning for each group in which more than half of the rows score as the climatology. Such rows do not score the
/// model, so that a fit can hide its errors there.
///
/// @param rows  "fit" or "holdout"
std::vector<std::string> unseen_warnings(const std::string& rows, const Score& score);

/// The scores as a table for people: one line per group, the rows beside the score.
std::string score_table(const ScoreSettings& settings, std::span<const ScoredRows> scores);
/// The same as JSON. The text ends with a line end.
std::string score_json(const ScoreSettings& settings, std::span<const ScoredRows> scores);

/// Writes the simulated measurements, errors included, one row per block and trial: `stops.csv`
/// (block,trial,end,x,y,mass_share), `passages.csv` (block,trial,screen,speed_ms,jump_height_m,angular_velocity_rads)
/// and, if the campaign has samples, `samples.csv` (block,trial,sample,speed_ms,angular_velocity_rads). Numbers are the
/// shortest that read back the same. Throws std::runtime_error.
void write_runs(const std::filesystem::path& folder, const LoadedCampaign& loaded, std::span<const BlockRuns> runs);

}  // namespace talus::io
