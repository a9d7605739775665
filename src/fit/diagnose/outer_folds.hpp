#pragma once
#include "diagnosis_loop.hpp"

namespace talus {

/// Why a campaign cannot be cross-validated in these folds: what a fold leaves is too little to be fitted. Empty if it
/// can.
std::string lack_of_fitting_rows(const Campaign& campaign, const OuterFolds& folds);
/// Throws InputError with it.
void require_fitting_rows(const Campaign& campaign, const OuterFolds& folds);

/// The folds of the fitting blocks, before any is simulated.
NestedValidation folds_to_validate(const Campaign& campaign, const DiagnoseOptions& options, std::uint32_t trials);

/// Simulates the blocks of a fold with what was found without them: the ground alone, and the last model. All folds and
/// models have the same random numbers.
void simulate_fold(const Campaign& campaign, const DiagnoseOptions& options, std::uint32_t fold, const Model& base,
                   const Model& found, NestedValidation& nested);

/// The blocks and groups of a fold.
OuterFold left_out(const Campaign& campaign, const OuterFolds& folds, std::uint32_t fold);

/// Notes the effects that were found without a fold; "none" or "unexplained" where there is none.
template <class Round>
void note_found(OuterFold& loop, const std::vector<Round>& rounds) {
  for (const Round& round : rounds) {
    if (!names_effect(round.effect) && !loop.effects.empty()) continue;
    loop.effects.push_back(round.effect);
    loop.where.push_back(round.where);
  }
}

/// Simulates the blocks of each fold with what is found without them: by the whole loop, or, where the folds do not
/// choose (`DiagnoseOptions::naming_in_folds`), by refitting the numbers of what all rows have found.
///
/// @param whole  the diagnosis of all fitting rows
NestedValidation nested_validation(const Campaign& campaign, const Model& start, DiagnosisWork& work,
                                   const Diagnosis& whole);

}  // namespace talus
