#pragma once
#include "io/files/json.hpp"

namespace talus::io {

/// Whether a run.json is of `talus profile`: among its inputs is a profile, or a line over a DEM. Never throws.
bool is_of_profile(const Json& run);

/// The plan that hazard_tally.gz of a run has: that of all its rounds together. Empty if the record has none.
std::string plan_of_tally(const Json& run);

/// Whether a number of the ground is of a model that was fitted.
bool has_fitted_ground(const Json& run);

/// Whether thresholds and hazard of a run count the energy with rotation, from its run.json. Earlier records: no.
bool counts_rotation(const Json& run);

}  // namespace talus::io
