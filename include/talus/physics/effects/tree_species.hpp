#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// A kind of tree and how much energy its stem takes, relative to silver fir of the same diameter.
struct TreeSpecies {
  std::string_view name;
  double factor;  ///< [-]
};

/// The kinds that a list of trees may name. docs/effects.md, "forest-stems".
std::span<const TreeSpecies> tree_species();

/// The factor of a kind, in any case of letters, with blanks or underscores; nothing if it is not known.
std::optional<double> factor_of_species(std::string_view name);

/// Names of all kinds, for messages.
std::vector<std::string> names_of_species();

/// Which kind to give for trees with names of their own, for messages: "; spruce, larch ... are conifer, ...".
std::string_view help_on_species();

}  // namespace talus
