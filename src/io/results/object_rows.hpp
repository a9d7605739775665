#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/gdal/geopackage.hpp"
#include "talus/io/results/vector_style.hpp"
#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/products/hazard_matrix.hpp"
#include "talus/products/objects.hpp"

namespace talus::io {

/// Figures of an object, with the names of their columns. NaN and infinity are written as NULL or an empty field.
using Figures = std::vector<std::pair<std::string, double>>;

/// @param without_height  share of the object where the DEM has no height: if that is all, its figures are not known,
///                        although blocks may touch its rim; if it is some of it, the upper bounds are not known
Figures figures_of(const HazardRules& rules, const ObjectHits& hits, double without_height, const HazardMatrix& matrix);

/// Name and text of the column that objects have if their energies count the rotation.
inline constexpr const char *kEnergiesColumn = "energies", *kEnergiesWithRotation = "with rotation";

/// Attributes of the input that are copied: those that are not named as a column of the results.
std::vector<int> copied_attributes(OGRFeature& model, const Figures& figures, bool with_rotation);

/// Row of an object, in the layer and in the table.
struct ObjectRow {
  const std::string& name;
  OGRFeature& from;  // of the input
  const Figures& figures;
  const std::string& sources;
  bool with_rotation;  // its energies
};

/// The layer `objects`: name of the object, attributes of the input, figures, energies if with rotation, sources.
class ObjectsWriter {
 public:
  /// @param model  a feature of the input
  ObjectsWriter(const std::filesystem::path& file, const LoadedScenario& loaded, OGRFeature& model,
                const Figures& figures);

  void write(const ObjectRow& object, const OGRGeometry& geometry);
  void finish(StyledLayer style);

 private:
  GeoPackage file_;
  std::vector<int> attributes_;
  OGRLayer* layer_ = nullptr;
};

/// The table objects.csv: the layer `objects` without its geometry.
class ObjectsTable {
 public:
  void add(const ObjectRow& object);
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Rows of objects_curves.csv: how often each energy is exceeded.
///
/// @param object   its name as a field of a table;  bounded: false if the upper bounds are not known
std::string curve_rows(const std::string& object, const HazardCurve& curve, const EnergyBins& bins, bool bounded);

}  // namespace talus::io
