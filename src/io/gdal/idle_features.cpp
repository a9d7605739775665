#include "idle_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "talus/base/text.hpp"

namespace talus::io {

namespace {

/// Whether two features share more than some area [m2]: a common edge through centres of cells is none.
bool overlap(const Parts& one, const Parts& other, double least) {
  double area = 0.0;
  for (const OGRPolygon& a : one.polygons)
    for (const OGRPolygon& b : other.polygons) {
      if (a.Intersects(&b) == 0) continue;
      const std::unique_ptr<OGRGeometry> common(a.Intersection(&b));
      if (common) area += OGR_G_Area(OGRGeometry::ToHandle(common.get()));
    }
  return area > least;
}

}  // namespace

CoveredCells mark_cells(const Parts& feature, std::uint8_t value, const Terrain& terrain, Raster<std::uint8_t>& cells) {
  CoveredCells covered;
  for (const OGRPolygon& polygon : feature.polygons)
    for_each_cell(polygon, terrain.heights.grid, CellRule::Covered, [&](int column, int row) {
      std::uint8_t& cell = cells.at(column, row);
      covered.taken += cell != 0 && cell != value ? 1U : 0U;
      cell = value;
      ++covered.all;
      covered.with_height += std::isnan(terrain.heights.at(column, row)) ? 0U : 1U;
    });
  return covered;
}

void IdleFeatures::mark(const std::string& name, const Parts& feature, const std::function<std::uint8_t()>& value,
                        Raster<std::uint8_t>& cells) {
  if (feature.empty()) return without_geometry_.push_back(name);
  const Grid& grid = terrain_.heights.grid;
  const OGREnvelope box = feature.envelope();
  box_.Merge(box);
  if (box.MaxX <= 0.0 || box.MinX >= grid.width() || box.MaxY <= 0.0 || box.MinY >= grid.height())
    return off_.push_back(name);
  const std::uint8_t given = value();
  const CoveredCells covered = mark_cells(feature, given, terrain_, cells);
  if (covered.taken > 0 && std::ranges::any_of(earlier_, [&](const auto& other) {
        return other.second != given && overlap(feature, other.first, 0.01 * grid.cell_x * grid.cell_y);
      }))
    takers_.push_back(name), taken_ += covered.taken;
  if (given != 0 && covered.all > 0) earlier_.emplace_back(feature, given);
  if (covered.all == 0)
    narrow_.push_back(name);
  else if (covered.with_height == 0)
    without_height_.push_back(name);
  else if (given != 0)
    marked_.emplace_back(name, given);
}

void IdleFeatures::warn(const Raster<std::uint8_t>& cells, std::vector<std::string>& warnings) const {
  const auto add = [&](const std::vector<std::string>& names, const std::string& what, const std::string& way_out) {
    if (!names.empty()) warnings.push_back(path_ + ": " + kind_ + " " + what + ": FID " + listed(names) + way_out);
  };
  const Grid& grid = terrain_.heights.grid;
  add(without_geometry_, "without geometry, which have no effect", "");
  add(off_, "wholly off the DEM, which have no effect", "");
  add(without_height_, "where the DEM has no heights, which have no effect", "");
  std::array<bool, 256> left{};
  if (!marked_.empty())
    for (const std::uint8_t value : cells.values) left[value] = true;
  std::vector<std::string> under;
  for (const auto& [name, value] : marked_)
    if (!left[value]) under.push_back(name);
  add(under, "covered by later ones, so that none of their name is left", ": the last in the file counts");
  add(takers_, "that overlap others, in " + std::to_string(taken_) + (taken_ == 1 ? " cell" : " cells"),
      ": the last in the file counts there");
  add(narrow_, "that cover no cell of the DEM (its centre counts) and have no effect",
      ": draw them wider than a cell, " + with_digits(std::max(grid.cell_x, grid.cell_y), 3) + " m");
}

}  // namespace talus::io
