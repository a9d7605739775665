#pragma once
#include "diagnosis_loop.hpp"

namespace talus {

/// The verdict of the first round.
BaseFitVerdict verdict_of(const Diagnosis& diagnosis, std::uint64_t seed);

/// A diagnosis, with the verdicts of `base_fits` independent fits of the ground, each with random numbers of its own.
/// Reports the whole diagnosis of the given seed; where most fits give another verdict, that of the first fit that
/// gives it.
Diagnosis repeated_diagnosis(const Campaign& campaign, const Model& start, DiagnosisWork& work);

}  // namespace talus
