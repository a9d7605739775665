#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/products/hazard_matrix.hpp"
#include "talus/products/objects.hpp"

namespace talus::io {

/// Width of an object above which it is asked whether it is in metres [m]: no house and no road is as wide.
inline constexpr double kWidestObject = 100.0;

/// How the objects are read.
struct ObjectFields {
  double line_width = 0.0;  ///< of lines without a width of their own [m]
  std::string width{};      ///< field of the width of a line [m]; empty: `width`, if there is one
  std::string name{};       ///< field of the name; empty: `name`, else `id`, else `object`, if there is one
};

/// Polygons and lines of a vector file with their attributes, in local metres.
class ObjectLayer {
 public:
  /// Reads them in any coordinate system. Throws InputError for points, for a width that is none, for a field that is
  /// asked for and not there, and if no object lies where the DEM has heights. Warns of features without geometry,
  /// which are left out, and of each object that lies partly, or wholly, where the DEM has none: blocks do not get
  /// there.
  ObjectLayer(const std::string& path, const LoadedScenario& loaded, const ObjectFields& fields = {});
  ~ObjectLayer();

  const std::vector<HazardObject>& objects() const;
  const std::vector<std::string>& warnings() const;
  /// How wide the lines are, in words; empty if there are none.
  std::string lines_text() const;
  /// That the objects have numbers for names, and which fields could name them; empty if a field names them.
  std::string names_text() const;

  /// A warning of the fields that `write` does not copy, as the results have columns of these names; empty if there are
  /// none.
  std::string not_copied_text(const HazardRules& rules, const HazardMatrix& matrix) const;

  /// How often each object is hit, in words, a line each, the most often hit first; at most `most` of them.
  std::vector<std::string> hits_text(const HazardRules& rules, const std::vector<ObjectHits>& hits,
                                     std::size_t most = 12) const;

  /// Writes objects.gpkg (the geometries in the system of the DEM, their attributes, and the hazard), objects.csv (the
  /// same as a table), objects_curves.csv (how often each energy is exceeded) and objects_sources.csv (from which
  /// sources).
  ///
  /// @param hits  by object
  /// @param matrix  of the columns hazard_class and energy_T<years>
  /// Throws std::runtime_error on a full disk.
  void write(const std::filesystem::path& folder, const LoadedScenario& loaded, const HazardRules& rules,
             const std::vector<ObjectHits>& hits, const HazardMatrix& matrix) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace talus::io
