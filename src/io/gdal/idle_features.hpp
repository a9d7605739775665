#pragma once
#include <string>
#include <vector>

#include "layer.hpp"

namespace talus::io {

/// Polygons of a layer that act in no cell of the DEM.
class IdleFeatures {
 public:
  /// @param kind  what the polygons are, for messages: "zones"
  IdleFeatures(std::string path, std::string kind, const Terrain& terrain)
      : path_(std::move(path)), kind_(std::move(kind)), terrain_(terrain) {}

  /// @param name  of a feature: its number, with what else it is called: "4 (road)"
  void without_geometry(const std::string& name) { without_geometry_.push_back(name); }
  /// Whether a feature lies wholly off the DEM. @param box  in local metres
  bool off(const std::string& name, const OGREnvelope& box);
  /// @param cells  that a feature covers @param heights  the number of them that have a height
  void placed(const std::string& name, std::uint64_t cells, std::uint64_t heights);

  /// Whether all features with a geometry are off the DEM, and there is one.
  bool all_off(std::size_t features) const {
    return !off_.empty() && off_.size() + without_geometry_.size() == features;
  }
  /// The box around all features that have a geometry [m, local].
  const OGREnvelope& box() const { return box_; }
  /// A line for each way in which features have no effect.
  void warn(std::vector<std::string>& warnings) const;

 private:
  std::string path_, kind_;
  const Terrain& terrain_;
  OGREnvelope box_;
  std::vector<std::string> without_geometry_, off_, narrow_, without_height_;
};

}  // namespace talus::io
