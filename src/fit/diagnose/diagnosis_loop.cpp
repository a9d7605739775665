#include "diagnosis_loop.hpp"

#include <algorithm>

namespace talus {

DiagnosisWork::DiagnosisWork(const DiagnoseOptions& options) : options_(options) {
  const double brief =
      options.base_fits_at_most() - 1 +
      (options.nested && options.naming_in_folds.value_or(true) ? static_cast<double>(options.outer_folds) : 0.0);
  total_ = 1.0 + kBrief * brief;
}

DiagnoseOptions DiagnosisWork::next(bool brief) {
  const double weight = brief ? kBrief : 1.0, begun = begun_, total = std::max(total_, begun_ + weight);
  begun_ += weight;
  DiagnoseOptions part = options_;
  if (options_.proceed)
    part.proceed = [proceed = options_.proceed, begun, weight, total](double share) {
      return proceed((begun + weight * share) / total);
    };
  return part;
}

}  // namespace talus
