#pragma once
#include <string>

#include "io/files/json.hpp"
#include "markup.hpp"
#include "talus/io/reports/score_report.hpp"

/// Calibration of the spread in words, numbers and pictures. docs/closing-the-loop.md, "Calibration of the spread".
namespace talus::io {

/// Lines for the terminal: per observable the shares below the simulated P5, P50 and P95, with what a right model
/// gives. Empty where nothing was counted.
std::string coverage_lines(const ScoredRows& scored);
/// The same as a Markdown table.
std::string coverage_markdown(const std::vector<Coverage>& list);
/// The same as JSON, with the histogram of ranks.
Json json_of(const std::vector<Coverage>& list);
/// The same as an HTML table.
Markup coverage_html(const std::vector<Coverage>& list);
/// How many blocks leave the DEM by the model, and how many can have. Empty where none does, or nobody can say.
std::string leaving_sentence(const ScoredRows& scored);
/// Words on the test alone: "by the model 8.4 of 50 blocks leave the DEM, none did: p 9e-05".
std::string leaving_text(const LeavingTest& test);
/// Says where the model lets too few blocks leave the DEM, by a tenth of them and three at least, if all without a
/// place of rest left it. Empty elsewhere.
std::string too_few_leave(const ScoredRows& scored);
/// Says where the middle run-out of the model is too short or too long. Empty where the share beyond it is that of a
/// right model (95 %).
std::string runout_side(const ScoredRows& scored);
Json json_of(const LeavingTest& test);
/// Warnings, one for each share that a right model does not give.
std::vector<std::string> coverage_warnings(const ScoredRows& scored);
/// Whether ranks were counted after a fit, so that there is a picture of them (`ranks_picture`).
bool has_ranks(std::span<const BeforeAfter> errors);
/// Histograms of ranks as drawings, one per observable; the grey band holds 95 % of the bars of a right model.
Markup rank_histograms(const std::vector<Coverage>& list);

}  // namespace talus::io
