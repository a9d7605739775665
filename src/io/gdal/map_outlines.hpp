#pragma once
#include <string>
#include <vector>

#include "talus/base/vector.hpp"

namespace talus::io {

/// A line, the rim of an area, or a point, in the coordinates of its layer.
struct Outline {
  std::string name;
  std::vector<Eigen::Vector2d> places;
  bool closed = false;
};

/// The geometries of a layer that Talus has written, by the field `field`. At most `most` places in all: `cut` says
/// whether there are more. Throws InputError if the file cannot be read.
struct Outlines {
  std::vector<Outline> list;
  bool cut = false;
};
Outlines read_outlines(const std::string& path, const char* layer, const char* field, std::size_t most);

}  // namespace talus::io
