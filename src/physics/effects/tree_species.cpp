#include "talus/physics/effects/tree_species.hpp"

#include <algorithm>
#include <array>

#include "talus/base/text.hpp"

namespace talus {
namespace {

struct TreeSpecies {
  std::string_view name;
  double factor;  ///< energy that its stem takes, relative to silver fir of the same diameter [-]
};

// Silver fir is the reference of Dorren & Berger (2006). The factors of the two groups are those of Rockyfor3D, from
// memory: docs/effects.md, "forest-stems".
constexpr std::array<TreeSpecies, 4> kSpecies{{
    {"silver fir", 1.0},
    {"abies alba", 1.0},
    {"conifer", 0.93},
    {"broadleaf", 1.59},
}};

std::string plain(std::string_view name) {
  std::string text = lowercase(name);
  std::ranges::replace(text, '_', ' ');
  return text;
}

}  // namespace

std::optional<double> factor_of_species(std::string_view name) {
  const std::string wanted = plain(name);
  for (const TreeSpecies& species : kSpecies)
    if (species.name == wanted) return species.factor;
  return std::nullopt;
}

std::vector<std::string> names_of_species() {
  std::vector<std::string> names;
  names.reserve(std::size(kSpecies));
  for (const TreeSpecies& species : kSpecies) names.emplace_back(species.name);
  return names;
}

std::string_view help_on_species() {
  return "; give spruce, larch, pine, Douglas fir and other conifers as conifer, beech, maple, oak, ash, birch and "
         "other broad-leaved trees as broadleaf";
}

}  // namespace talus
