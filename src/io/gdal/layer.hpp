#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dataset.hpp"
#include "talus/base/input_faults.hpp"
#include "talus/io/gdal/rasters.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "vector_file.hpp"

namespace talus::io {

/// The simple geometries of a feature in local metres: without curves, heights or invalid polygons.
struct Parts {
  std::vector<OGRPolygon> polygons;
  std::vector<OGRLineString> lines;
  std::vector<Eigen::Vector2d> points;

  bool empty() const { return polygons.empty() && lines.empty() && points.empty(); }
  OGREnvelope envelope() const;
};

/// A field that is read: what it holds, and what was found in it.
struct FieldUse {
  std::string name;   ///< what it holds: "release_height"
  std::string field;  ///< its own name: "HEIGHT"
  std::string unit;   ///< empty for none
  int index = -1;
  bool is_text = false;    ///< what it holds is text
  bool from_text = false;  ///< numbers in a text field
  bool zero_if_empty = false;
  std::size_t count = 0;  ///< of features with a value
  double low = 0.0, high = 0.0;

  void add(double value);
  std::string range() const;
  /// "diameter 0.5 to 2 m from Durchmesser (2 of 3 features, 1 empty)".
  std::string text(std::size_t features) const;
};

/// A layer of a vector file, feature by feature on the grid of the DEM: the one that is named (`NamedLayer`), or the
/// only one with geometry.
class Layer {
 public:
  /// @param role  "sources", for the record of the transformation
  Layer(std::string role, const std::string& path, const Terrain& terrain);

  /// The next feature; null at the end.
  Feature next();
  /// The geometries of a feature. Empty if it has none.
  Parts parts(const OGRFeature& feature);
  /// The same of a feature that must be polygons: throws InputError if it has lines or points.
  /// @param purpose  for the message: ": blocks were mapped inside"
  Parts polygons(const OGRFeature& feature, const std::string& purpose = "");

  /// Index of a field that is spelt so, else of the only one that is in another case of letters, also if a Shapefile
  /// has cut its name, this or an earlier one; -1 if there is none. Throws InputError if several differ from it only in
  /// their case.
  /// @param way_out  what the user may do then
  int field(const std::string& name, const std::string& way_out = "rename all but one") const;
  std::vector<std::string> field_names() const;
  bool names_are_utf8() const;
  const OGRFeatureDefn& fields() const { return *layer_->GetLayerDefn(); }
  /// "cliffs.shp: feature 12", of a CSV "trees.csv: row 12 below the header", for messages.
  std::string label(const OGRFeature& feature) const;
  /// The value of a numeric field, or of any field of a CSV; nothing if it is NULL or the field is not there (-1).
  /// Throws InputError if it is no number, or out of bounds.
  /// @param name      of the field, for messages
  /// @param may_lack  whether messages offer to leave the field empty
  std::optional<double> number(const OGRFeature& feature, int index, const std::string& name, const Bounds& bounds,
                               bool may_lack = true) const;
  /// The text of a field of any type, without blanks around it; empty if it is NULL or the field is not there (-1).
  /// Throws InputError if it is not UTF-8.
  std::string text(const OGRFeature& feature, int field) const;
  /// The code in a text or whole-number field, as `text` gives it. Throws InputError for fields of other types.
  std::string code(const OGRFeature& feature, int field) const;

  /// Whether it is a text table, whose fields are all text.
  bool is_csv() const;
  /// Whether a field is a text field; of a CSV, whose cells are all text, no.
  bool holds_text(int field) const;

  /// The faults of features so far: `for_each_feature` reports them together.
  FaultList& faults() { return faults_; }

  const std::string& crs_wkt() const { return crs_wkt_; }
  const std::vector<Reprojection>& reprojections() const { return transformer_->used(); }
  /// Warnings of the opening, the geometries and the transformation.
  std::vector<std::string> warnings() const;
  /// Adds these and the transformations to what is read from the layer.
  template <class Out>
  void tell(Out& out) const {
    const std::vector<Reprojection>& used = reprojections();
    out.reprojections.insert(out.reprojections.end(), used.begin(), used.end());
    for (std::string& line : warnings()) out.warnings.push_back(std::move(line));
  }

 private:
  std::vector<OGRLayer*> layers_with_geometry() const;
  [[noreturn]] void refuse_without_geometry();
  void choose_layer();
  /// Index of a field whose name a Shapefile has cut; -1 if there is none.
  int cut_field(const std::string& name) const;
  /// Throws InputError if one of the cells of a CSV is in this column.
  void refuse_odd(const std::map<std::string, CsvCell>& cells, const std::string& name, const std::string& unit) const;
  void collect(OGRGeometry& geometry, Parts& parts, const std::string& where);
  void move(OGRSimpleCurve& line, const std::string& where);
  /// Why a polygon in local metres is invalid, with the place in map coordinates.
  std::string fault_on_map(const OGRPolygon& polygon) const;
  void add_valid(const OGRPolygon& polygon, Parts& parts, const std::string& where);

  std::string path_, crs_wkt_;
  const Terrain& terrain_;
  Dataset dataset_;
  OGRLayer* layer_ = nullptr;
  std::optional<Transformer> transformer_;
  OddCells odd_;              // of a CSV
  bool north_first_ = false;  // the file has its coordinates in the order of the axes: latitude first
  std::vector<std::string> warnings_;
  std::size_t mended_ = 0;
  FaultList faults_;
};

/// Calls `read(feature)` for every feature of a layer, also after a fault. Throws InputFaults, with the faults of all
/// features, after the last one.
template <class Read>
void for_each_feature(Layer& layer, Read read) {
  while (Feature feature = layer.next()) layer.faults().attempt([&] { read(feature); });
  layer.faults().stop();
}

/// A window of the grid, with a mark on each cell of a geometry. Rows from the north.
struct CellMask {
  int column = 0, north_row = 0, columns = 0, rows = 0;  ///< north_row: row 0 in the south
  std::vector<std::uint8_t> marks;
};

/// Which cells are those of a geometry.
enum class CellRule {
  Covered,  ///< whose centre it covers, or has on its southern or northern edge
  Once,     ///< whose centre it covers: one on the edge of two polygons belongs to one of them
  Touched   ///< that it touches
};

/// Marks the cells of a geometry in local metres. The windows of a geometry are the same for each rule.
CellMask mask_of(const OGRGeometry& geometry, const Grid& grid, CellRule rule);

/// Calls `visit(column, row)` (row 0 in the south) for the marked cells, row by row from the north-west.
template <class Visit>
void for_each_cell(const CellMask& mask, Visit visit) {
  const std::uint8_t* mark = mask.marks.data();
  for (int j = 0; j < mask.rows; ++j)
    for (int i = 0; i < mask.columns; ++i)
      if (*mark++ != 0) visit(mask.column + i, mask.north_row - j);
}
/// Visits the cells of a geometry in the same order.
template <class Visit>
void for_each_cell(const OGRGeometry& geometry, const Grid& grid, CellRule rule, Visit visit) {
  for_each_cell(mask_of(geometry, grid, rule), visit);
}

/// "cliffs.gpkg: fields read: diameter 0.5 to 2 m (2 of 3 features, 1 empty), name (3 of 3 features); others: area".
///
/// @param there  all fields of the layer
std::string fields_note(const std::string& path, const std::vector<FieldUse>& fields, std::size_t features,
                        const std::vector<std::string>& there);

}  // namespace talus::io
