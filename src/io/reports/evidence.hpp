#pragma once
#include <span>
#include <string>

#include "io/files/json.hpp"
#include "markup.hpp"
#include "talus/fit/diagnose/residual_table.hpp"
#include "talus/io/reports/score_report.hpp"

/// What a fit is to be judged by beside its error: the climatology, the rows, the tail, the spread.
namespace talus::io {

/// The rows of a group; with a star where they are so few that it stays out of a headline.
std::string rows_text(const GroupScore& group);

/// `residual` of a diagnosis: the most significant rows of the table.
Json residual_json(std::span<const ResidualRow> rows);
/// `coverage` of a report: {"before": {"fit": [...], "holdout": [...]}, "after": ...}.
Json coverage_json(std::span<const BeforeAfter> errors);
/// `tail` of a report: the error in the far run-outs before and after, by kind of rows.
Json tail_json(std::span<const BeforeAfter> errors);
/// The scores of a model on some rows.
struct JudgedModel {
  const Score& score;
  const Score& log_score;
};
/// A model as evidence: its error, its log score (logarithm of the density: higher is better), both against a reference
/// with paired intervals, and the rows of each group.
///
/// @param clusters  by block (`clusters_of`)
Json judged_json(const JudgedModel& model, const JudgedModel& reference, std::span<const std::uint32_t> clusters);
/// `evidence` of a report: the climatology, the first model and the last one, against the first model.
///
/// @param names  of the two models
Json evidence_json(std::span<const BeforeAfter> errors, std::span<const std::uint32_t> clusters, const char* before,
                   const char* after);

/// "1.2 to 7.5": an interval times `unit`, with so many decimals.
std::string interval_text(const Interval& interval, double unit, int decimals);
/// " m/s"; empty for a number without a unit, whose unit is called "1" in places.
std::string unit_text(const std::string& unit);
/// A score with three decimals: "0.743"; "-" for NaN.
std::string score_text(double score);
/// A gain with its 95 % interval; empty where it is NaN.
std::string gain_text(double gain, const Interval& interval);
/// Skill, tail and spread after a fit, as Markdown.
/// @param ranks  file with the histograms of ranks (`ranks_picture`)
std::string judgement_markdown(const BeforeAfter& error, const std::string& ranks);
/// The error in the far run-outs before and after in a sentence. Empty where it was not scored.
std::string tail_before_after(const BeforeAfter& error);
/// Error by group as an HTML table: before, after, climatology, rows.
Markup groups_html(const BeforeAfter& error);

}  // namespace talus::io
