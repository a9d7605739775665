#pragma once
#include "talus/fit/diagnose/diagnosis.hpp"

namespace talus {

/// Extent of one run of the loop.
struct LoopScope {
  /// For a repetition: half the trials in the fit of the ground; fits only the effects that may be chosen, goes on with
  /// the best two, and leaves out the last, longest fits.
  bool brief = false;
  bool first_round = false;  ///< ends with the verdict of the first round
};

/// Cost of a brief loop, as a share of that of a whole one.
constexpr double kBrief = 0.45;

/// Fit, test and choice on the fitting rows of a campaign. Throws FitInterrupted when `proceed` returns false.
Diagnosis run_loop(const Campaign& campaign, const Model& start, const DiagnoseOptions& options,
                   const LoopScope& scope);

/// The parts of a diagnosis, one after the other: what each of them shows as progress.
class DiagnosisWork {
 public:
  explicit DiagnosisWork(const DiagnoseOptions& options);

  const DiagnoseOptions& options() const { return options_; }
  /// Options of the next part.
  DiagnoseOptions next(bool brief);

 private:
  DiagnoseOptions options_;
  double total_, begun_ = 0.0;
};

}  // namespace talus
