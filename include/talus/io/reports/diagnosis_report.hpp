#pragma once
#include "talus/fit/diagnose/diagnosis.hpp"
#include "talus/io/reports/fit_record.hpp"

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
  HoldoutError whole;                                 ///< base against the last model
  std::vector<HoldoutError> rounds;                   ///< each effect found, against the model before it
  std::vector<std::vector<HoldoutError>> candidates;  ///< as DiagnosisRound::candidates
  Score holdout;                                      ///< of the last model
  double seconds = 0.0;
};

/// Simulates and scores the held-out rows with every model of a diagnosis. Throws FitInterrupted if `options.proceed`
/// returns false.
void open_holdout(const Campaign& campaign, DiagnosisRecord& record);

/// The text of diagnosis.json. Its keys: docs/closing-the-loop.md, "Diagnosis".
std::string diagnosis_json(const DiagnosisRecord& record);

}  // namespace talus::io
