#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "talus/base/bounds.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// The parameters of a ground: theta_scale, psi_scale, En50, Et50, phi, shape_min, shape_max.
std::span<const Field<Ground>> ground_fields();

/// The scalars of a run: seed, trajectories, day, blocks.density, model.*, output.trajectories.
std::span<const Field<Scenario>> scenario_fields();

/// The numbers that are lists, ranges or attributes of features: blocks.diameter, sources.release_height and so on.
std::span<const Bounds> list_bounds();

/// The entry of `list_bounds` of this key, which must be there.
const Bounds& bounds_of(std::string_view key);

/// The rule that a value breaks, "must be 500 to 8000 kg/m3 (mass per volume of the rock)"; nothing if it is allowed.
std::optional<std::string> fault_of(const Bounds& bounds, double value);

}  // namespace talus
