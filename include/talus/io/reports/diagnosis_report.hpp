#pragma once
#include "talus/fit/diagnose/diagnosis.hpp"
#include "talus/io/reports/fit_record.hpp"
#include "talus/io/reports/score_report.hpp"

namespace talus::io {

/// The error on the held-out rows before and after an effect, with the same random numbers.
struct HoldoutError {
  double before = kNotGiven, after = kNotGiven;
  Reduction reduction;  ///< of `before`
};

/// The scores of a candidate of the first round on rows that it has not seen, against the ground alone.
struct CandidateEvidence {
  std::string rows;  ///< "holdout" or "out-of-fold"
  Score score, log_score, ground, log_ground;
};

/// Results of `talus diagnose`, with the errors on the rows that no fit has seen: the held-out ones where there are
/// any, else all, each out of its fold.
struct DiagnosisRecord : FitRecord {
  DiagnoseOptions options;
  Diagnosis diagnosis;
  std::vector<BeforeAfter> errors;      ///< of the fitting, the held-out and the out-of-fold rows: base, last model
  std::size_t unseen = 1;               ///< index of the errors that the headline is about
  std::vector<std::uint32_t> clusters;  ///< of the blocks (`clusters_of`)
  std::vector<std::vector<CandidateEvidence>> evidence;  ///< by candidate of the first round
  HoldoutError whole;                                    ///< base against the last model, on the unseen rows
  HoldoutError headline;                                 ///< the same, of the groups with ten unseen rows and more
  std::vector<HoldoutError> rounds;                      ///< each effect found, against the model before it
  std::vector<std::vector<HoldoutError>> candidates;     ///< as DiagnosisRound::candidates
  double seconds = 0.0;                                  ///< by the clock
  double cpu_seconds = 0.0;  ///< of all threads; the phases of the diagnosis are parts of it
  std::string start_name;    ///< of the ground: a preset, everywhere, or the file of a model
};

/// Simulates and scores the held-out rows with every model of a diagnosis, and judges the first and the last model on
/// the fitting rows, the held-out ones and, out of their folds, all. Throws FitInterrupted if `options.proceed` returns
/// false.
void open_holdout(const Campaign& campaign, DiagnosisRecord& record);

/// Skill of a model of the diagnosis, as `skill_of_model`. Where the choice of the effect has seen the unseen rows, the
/// lower end of the interval of what was found is 0 at most.
Reduction skill_of_ground(const DiagnosisRecord& record);
Reduction skill_of_found(const DiagnosisRecord& record);

/// Whether the unseen rows have taken part in the choice of an effect, though not in the fits: quick folds.
bool choice_has_seen(const DiagnosisRecord& record);

/// The verdict over all base fits, the log score and what the folds found, as lines for the terminal.
std::string repeated_lines(const DiagnosisRecord& record);

/// Warnings of what a costly diagnosis left out (`DiagnosisRules::enough`), with the flag that asks for it; of few
/// blocks or trials; of a ground far from its start; of folds that split groups; of a model that no file can hold.
std::vector<std::string> diagnosis_warnings(const DiagnosisRecord& record);

/// Names of the groups of fewer than ten unseen rows, with their rows: they stay out of the headline.
std::vector<std::string> small_groups(const DiagnosisRecord& record);

/// Lines for the terminal: the effects that these data could not have shown at any amount, and those that speeds at
/// more screens would show. Empty where there are none.
std::string limits_lines(std::span<const DetectionLimit> limits);

/// The row of the residual table that is most significant, in words: "lateral depends on release height (p 8e-05,
/// corrected for the number of rows)". Empty where it is not below the level: a round is `unexplained` by this row or
/// by a family.
std::string residual_text(const DiagnosisRound& round, double level);

/// Where the processor time went, in one line: phases and effects of at least 5 %, largest first.
std::string time_line(const DiagnosisRecord& record);

/// The text of diagnosis.json. Its keys: docs/closing-the-loop.md, "Diagnosis".
std::string diagnosis_json(const DiagnosisRecord& record);

}  // namespace talus::io
