#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "markup.hpp"

namespace talus::io {

/// Hazard of single objects, as `talus hazard --objects` has written it.
struct ObjectsPart {
  struct Point {
    double energy = 0.0, frequency = 0.0;  ///< [kJ], [1/year]
  };
  /// Number of a class, and of those at the bounds of the frequencies; nothing in a table without classes.
  struct Class {
    std::optional<std::size_t> here = {}, low = {}, high = {};
  };
  /// An object that was assessed.
  struct Object {
    std::string name, sources;
    double frequency = 0.0, low = 0.0;  ///< [1/year]
    std::optional<double> high;         ///< nothing where a part of the object is not assessed
    double without_height = 0.0;        ///< that part: a share, where the DEM has no height
    std::vector<std::string> years;     ///< return period by threshold, with its bounds [years], in words
    std::vector<Point> curve;
    Class hazard_class = {}, entry_class = {};  ///< by the largest energies, by those at the first touch
  };
  std::vector<std::string> thresholds;  ///< [kJ]
  std::vector<Object> objects;          ///< the most often hit first
  std::size_t left_out = 0;
  std::string note;
  std::vector<std::string> not_assessed;  ///< names of objects without figures: the DEM has no height where they lie
  std::size_t not_assessed_left_out = 0;
  bool with_rotation = false;  ///< of all energies
};

/// Throws InputError if a table is there and cannot be understood. No objects without tables.
/// @param with_rotation  the run counts the energy with rotation
ObjectsPart read_objects_part(const std::filesystem::path& folder, bool with_rotation = false);
/// @param pieces   blocks of the run broke
/// @param classes  names of the classes, by number
Markup objects_html(const ObjectsPart& part, bool pieces, const std::vector<std::string>& classes = {});

}  // namespace talus::io
