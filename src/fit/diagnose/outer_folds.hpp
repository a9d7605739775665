#pragma once
#include "diagnosis_loop.hpp"

namespace talus {

/// Throws InputError if what a fold leaves is too little to be fitted.
void require_fitting_rows(const Campaign& campaign, const OuterFolds& folds);

/// Repeats the loop without each fold and simulates the fold's blocks with what it found.
///
/// @param whole  the diagnosis of all fitting rows: its candidates, and the effects that folds take which do not choose
NestedValidation nested_validation(const Campaign& campaign, const Model& start, DiagnosisWork& work,
                                   const OuterFolds& folds, const Diagnosis& whole);

}  // namespace talus
