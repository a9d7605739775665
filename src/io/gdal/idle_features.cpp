#include "idle_features.hpp"

#include <algorithm>

#include "talus/base/text.hpp"

namespace talus::io {

bool IdleFeatures::off(const std::string& name, const OGREnvelope& box) {
  const Grid& grid = terrain_.heights.grid;
  box_.Merge(box);
  const bool is_off = box.MaxX <= 0.0 || box.MinX >= grid.width() || box.MaxY <= 0.0 || box.MinY >= grid.height();
  if (is_off) off_.push_back(name);
  return is_off;
}

void IdleFeatures::placed(const std::string& name, std::uint64_t cells, std::uint64_t heights) {
  if (cells == 0)
    narrow_.push_back(name);
  else if (heights == 0)
    without_height_.push_back(name);
}

void IdleFeatures::warn(std::vector<std::string>& warnings) const {
  const auto add = [&](const std::vector<std::string>& names, const std::string& what, const std::string& way_out) {
    if (!names.empty()) warnings.push_back(path_ + ": " + kind_ + " " + what + ": FID " + list_of(names) + way_out);
  };
  const Grid& grid = terrain_.heights.grid;
  add(without_geometry_, "without geometry, which have no effect", "");
  add(off_, "wholly off the DEM, which have no effect", "");
  add(without_height_, "where the DEM has no heights, which have no effect", "");
  add(narrow_, "that cover no cell of the DEM (its centre counts) and have no effect",
      ": draw them wider than a cell, " + with_digits(std::max(grid.cell_x, grid.cell_y), 3) + " m");
}

}  // namespace talus::io
