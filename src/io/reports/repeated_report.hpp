#pragma once
#include <string>

#include "io/files/json.hpp"
#include "markup.hpp"
#include "talus/io/reports/diagnosis_report.hpp"

/// What a diagnosis found when it was repeated: with other random numbers, and without each fold.
/// docs/diagnosis-evidence.md.
namespace talus::io {

/// Warning of folds that split groups (`OuterFolds::splits_groups`).
inline constexpr const char* kSplitGroups =
    "the folds split groups: a block is judged by a fit to others of its group, and the error out of fold may be too "
    "low; groups stay together where every fitting block has one, there are at least as many as --folds, and none has "
    "more than half of the blocks";

/// Warning of a ground whose fit ended far from its start: tests of place and instrument raise more false alarms there.
/// Empty where it is near. docs/diagnosis-results.md.
///
/// @param way_out  what to do
std::string far_ground_warning(const FittedModel& base, const std::string& way_out);

/// Scores the blocks that were simulated out of their folds: rows "out-of-fold".
BeforeAfter out_of_fold_rows(const Campaign& campaign, const NestedValidation& nested);

/// The folds that found the same, with their number: "4 of 5 block-shape; 1 of 5 none".
std::string folds_text(const NestedValidation& nested);

/// Scores the nested cross-validation of a diagnosis and adds it to the errors and the evidence.
void judge_nested(const Campaign& campaign, DiagnosisRecord& record);

/// The effect of the first round; "undecided between X and Y" where the base fits differ.
std::string verdict_text(const Diagnosis& diagnosis);

/// `evidence`: climatology, ground, what was found, then the candidates of the first round.
Json evidence_of(const DiagnosisRecord& record);
/// `stability`.
Json stability_json(const Stability& stability);
/// `nested`: the folds with what each found.
Json nested_json(const DiagnosisRecord& record);

/// Stability and folds as HTML.
Markup repeated_html(const DiagnosisRecord& record);

}  // namespace talus::io
