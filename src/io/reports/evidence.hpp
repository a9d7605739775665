#pragma once
#include <span>
#include <string>

#include "io/files/json.hpp"
#include "talus/io/reports/score_report.hpp"

/// What a fit is to be judged by beside its error: the climatology, the rows, the tail, the spread.
namespace talus::io {

/// The rows of a group; with a star where they are so few that it stays out of a headline.
std::string rows_text(const GroupScore& group);

/// `coverage` of a report: {"before": {"fit": [...], "holdout": [...]}, "after": ...}.
Json coverage_json(std::span<const BeforeAfter> errors);
/// `tail` of a report: the error in the far run-outs before and after, by kind of rows.
Json tail_json(std::span<const BeforeAfter> errors);
/// `evidence` of a report: the error of the climatology, of the first model and of the last one, with the rows of each
/// group.
///
/// @param names  of the two models
Json evidence_json(std::span<const BeforeAfter> errors, const char* before, const char* after);

/// Skill, tail and spread after a fit, as Markdown.
std::string judgement_markdown(const BeforeAfter& error);
/// The error in the far run-outs before and after in a sentence. Empty where it was not scored.
std::string tail_before_after(const BeforeAfter& error);
/// Error by group as an HTML table: before, after, climatology, rows.
std::string groups_html(const BeforeAfter& error);

}  // namespace talus::io
