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

/// Results of `talus diagnose`, with the errors on the held-out rows.
struct DiagnosisRecord : FitRecord {
  DiagnoseOptions options;
  Diagnosis diagnosis;
  std::vector<BeforeAfter> errors;                    ///< of the fitting and the held-out rows: base, last model
  HoldoutError whole;                                 ///< base against the last model
  HoldoutError headline;                              ///< the same, of the groups with ten held-out rows and more
  std::vector<HoldoutError> rounds;                   ///< each effect found, against the model before it
  std::vector<std::vector<HoldoutError>> candidates;  ///< as DiagnosisRound::candidates
  double seconds = 0.0;      ///< by the clock
  double cpu_seconds = 0.0;  ///< of all threads; the phases of the diagnosis are parts of it
};

/// Simulates and scores the held-out rows with every model of a diagnosis, and judges the first and the last model on
/// the rows of both kinds. Throws FitInterrupted if `options.proceed` returns false.
void open_holdout(const Campaign& campaign, DiagnosisRecord& record);

/// Names of the groups of fewer than ten held-out rows, with their rows: they stay out of the headline.
std::vector<std::string> small_groups(const DiagnosisRecord& record);

/// Lines for the terminal: the effects that these data could not have shown at any amount, and those that speeds at
/// more screens would show. Empty where there are none.
std::string limits_lines(std::span<const DetectionLimit> limits);

/// Where the processor time went, in one line: phases and effects of at least 5 %, largest first.
std::string time_line(const DiagnosisRecord& record);

/// The text of diagnosis.json. Its keys: docs/closing-the-loop.md, "Diagnosis".
std::string diagnosis_json(const DiagnosisRecord& record);

}  // namespace talus::io
