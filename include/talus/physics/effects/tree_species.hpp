#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// How much energy the stem of a kind of tree takes, relative to silver fir of the same diameter [-]; nothing if the
/// kind is not known. docs/effects.md, "forest-stems".
///
/// @param name  in any case of letters, with blanks or underscores
std::optional<double> factor_of_species(std::string_view name);

/// Names of all kinds, for messages.
std::vector<std::string> names_of_species();

/// Which kind to give for trees with names of their own, for messages: "; spruce, larch ... are conifer, ...".
std::string_view help_on_species();

}  // namespace talus
