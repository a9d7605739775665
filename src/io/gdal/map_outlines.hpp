#pragma once
#include <initializer_list>
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

/// The geometries of a layer that Talus has written, named by the first of `fields` that is there, else by number. At
/// most `most` places in all: `cut` says whether there are more. Throws InputError if the file cannot be read.
struct Outlines {
  std::vector<Outline> list;
  bool cut = false;
};
Outlines read_outlines(const std::string& path, const char* layer, std::initializer_list<const char*> fields,
                       std::size_t most);

}  // namespace talus::io
