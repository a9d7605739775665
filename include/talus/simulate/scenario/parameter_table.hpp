#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// A number of the input: what it is called, what it means and which values are allowed. In the units of the files.
struct Bounds {
  std::string_view key;      ///< "blocks.density"; of a ground "En50"
  std::string_view unit;     ///< "kg/m3"; "1" where there is none
  std::string_view meaning;  ///< a few words, without a full stop
  double min, max;
  enum Ends { Closed, AboveMin, Between } ends = Closed;  ///< AboveMin: not min itself; Between: neither end
  bool whole = false;                                     ///< a whole number
};

/// A number of the input that is one number of `Owner`, in the units of the files: degrees, not radians.
/// Its default is what a fresh `Owner` holds (of a ground: what the preset says).
template <class Owner>
struct Field : Bounds {
  double (*get)(const Owner&);
  void (*set)(Owner&, double);
  double off = kNotGiven;  ///< the value at which it does nothing; NaN: it is no strength
};

/// The parameters of a ground: theta_scale, psi_scale, En50, Et50, phi, shape_min, shape_max.
std::span<const Field<Ground>> ground_fields();

/// The scalars of a run: seed, trajectories, blocks.density, model.*, output.trajectories.
std::span<const Field<Scenario>> scenario_fields();

/// The numbers of the effects, by name: "vegetation-drag.coefficient". In the scenario below "effects.".
std::span<const Field<Effects>> effect_fields();

/// The names of the effects, in the order of `effect_fields`.
std::span<const std::string_view> effect_names();

/// Where an effect acts, by its name; null for air-drag, which acts everywhere.
EffectArea* extent_of(Effects& effects, std::string_view name);

/// The numbers that are lists, ranges or attributes of features: blocks.diameter, sources.release_height and so on.
std::span<const Bounds> list_bounds();

/// The entry of `list_bounds` of this key, which must be there.
const Bounds& bounds_of(std::string_view key);

/// What is wrong with a value: "must be 500 to 8000 kg/m3 (mass per volume of the rock)"; nothing where it is allowed.
std::optional<std::string> fault_of(const Bounds& bounds, double value);

}  // namespace talus
