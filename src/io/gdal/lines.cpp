#include "talus/io/gdal/lines.hpp"

#include <algorithm>

#include "layer.hpp"
#include "talus/base/error.hpp"

namespace talus::io {
namespace {

/// Reads the lines of a layer, feature by feature, for screens and barriers.
class LineReader {
 public:
  /// @param meant  "lines that blocks may cross", for messages
  LineReader(std::string role, const std::string& path, const Terrain& terrain, std::string meant)
      : path_(path),
        meant_(std::move(meant)),
        grid_(terrain.heights.grid),
        layer_(std::move(role), path, terrain),
        id_(layer_.field("id")) {}

  Layer& layer() { return layer_; }

  /// The field `id`, else the number of the feature.
  std::string id_of(const OGRFeature& feature) const {
    const std::string id = id_ < 0 ? "" : layer_.code(feature, id_);
    return id.empty() ? std::to_string(feature.GetFID()) : id;
  }

  /// Appends the lines of a feature.
  void read(const OGRFeature& feature, std::vector<std::vector<Eigen::Vector2d>>& lines) {
    ++features_;
    const Parts parts = layer_.parts(feature);
    if (!parts.polygons.empty() || !parts.points.empty() || parts.lines.empty())
      throw InputError(layer_.label(feature) + ": " + (parts.empty() ? "has no geometry" : "is no line") +
                       ", must be " + meant_);
    for (const OGRLineString& line : parts.lines) {
      if (line.getNumPoints() < 2 || line.get_Length() == 0.0)
        throw InputError(layer_.label(feature) + ": line has no length, must have two places at least");
      std::vector<Eigen::Vector2d>& places = lines.emplace_back();
      for (int i = 0; i < line.getNumPoints(); ++i) places.emplace_back(line.getX(i), line.getY(i));
    }
    const OGREnvelope box = parts.envelope();
    if (box.MaxX < 0.0 || box.MinX > grid_.width() || box.MaxY < 0.0 || box.MinY > grid_.height())
      off_map_.push_back(feature.GetFID());
  }

  /// Throws InputError if the layer is empty. Fills the warnings and reprojections of `out`.
  template <class Out>
  void finish(Out& out) {
    if (features_ == 0) throw InputError(path_ + ": has no features, must be " + meant_);
    if (!off_map_.empty())
      out.warnings.push_back(path_ + ": lines wholly off the DEM, which nothing will cross: features " +
                             list_of(off_map_));
    out.reprojections = layer_.reprojections();
    for (std::string& line : layer_.warnings()) out.warnings.push_back(std::move(line));
  }

 private:
  std::string path_, meant_;
  const Grid& grid_;
  Layer layer_;
  int id_;
  std::size_t features_ = 0;
  std::vector<std::int64_t> off_map_;
};

}  // namespace

ScreenLayer read_screens(const std::string& path, const Terrain& terrain) {
  LineReader reader("screens", path, terrain, "lines that blocks may cross");
  ScreenLayer out;
  while (const Feature feature = reader.layer().next()) {
    const std::string id = reader.id_of(*feature);
    auto screen = std::find_if(out.screens.begin(), out.screens.end(), [&](const Screen& s) { return s.id == id; });
    if (screen == out.screens.end()) screen = out.screens.insert(screen, Screen{id, {}});
    reader.read(*feature, screen->lines);
  }
  reader.finish(out);
  return out;
}

BarrierLayer read_barriers(const std::string& path, const Terrain& terrain) {
  LineReader reader("barriers", path, terrain, "lines with the fields height (m) and capacity (kJ)");
  BarrierLayer out;
  while (const Feature feature = reader.layer().next()) {
    const auto number = [&](const char* field, std::string_view key) {
      const auto value = reader.layer().number(*feature, field, bounds_of(key));
      if (!value)
        throw InputError(reader.layer().label(*feature) + ": has no " + field +
                         ", must have height (m) and capacity (kJ)");
      return *value;
    };
    Barrier& barrier = out.barriers.emplace_back();
    barrier.id = reader.id_of(*feature);
    barrier.height = number("height", "barriers.height");
    barrier.capacity = 1e3 * number("capacity", "barriers.capacity");
    reader.read(*feature, barrier.lines);
  }
  reader.finish(out);
  return out;
}

}  // namespace talus::io
