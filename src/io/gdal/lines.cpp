#include "talus/io/gdal/lines.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

#include "layer.hpp"
#include "off_map.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/terrain/no_height.hpp"

namespace talus::io {
namespace {

/// Lines that lie wholly off the DEM: one warning of all.
class LinesOff {
 public:
  explicit LinesOff(const Terrain& terrain) : terrain_(terrain) {}

  /// Keeps the name of lines if they lie wholly off the DEM. Returns whether they do.
  bool add(const std::string& name, const std::vector<std::vector<Eigen::Vector2d>>& lines) {
    OGREnvelope box;
    for (const auto& line : lines)
      for (const Eigen::Vector2d& place : line) box.Merge(place.x(), place.y());
    if (!wholly_off(box, terrain_.heights.grid)) return false;
    names_.push_back(name);
    box_.Merge(box);
    return true;
  }

  /// @param what  the names are of: "features" @param from  see `extents_text`
  void warn(const std::string& where, const std::string& what, const std::string& from,
            std::vector<std::string>& warnings) const {
    if (!names_.empty())
      warnings.push_back(where + ": lines wholly off the DEM, which nothing will cross: " + what + " " +
                         listed(names_) + "; they reach over " + extents_text(box_, from, terrain_));
  }

 private:
  const Terrain& terrain_;
  std::vector<std::string> names_;
  OGREnvelope box_;
};

/// Reads the lines of a layer, feature by feature, for screens and barriers.
class LineReader {
 public:
  /// @param meant  "lines that blocks may cross", for messages
  LineReader(std::string role, const std::string& path, const Terrain& terrain, std::string meant)
      : path_(path),
        meant_(std::move(meant)),
        off_(terrain),
        layer_(std::move(role), path, terrain),
        id_(layer_.field("id") >= 0 ? layer_.field("id") : layer_.field("name")) {
    if (id_ >= 0) use_of(id_, "id", "").is_text = true;
  }

  Layer& layer() { return layer_; }

  /// The field `id`, without it `name`, else the number of the feature.
  std::string id_of(const OGRFeature& feature) {
    const std::string id = id_ < 0 ? "" : layer_.code(feature, id_);
    if (id.empty()) {
      const std::string number = std::to_string(feature.GetFID());
      numbered_.emplace(number, layer_.label(feature));
      return number;
    }
    ++uses_.front().count;
    given_.insert(id);
    return id;
  }

  /// The number in a field of the layer (-1: none), which must be there; nothing and a fault of the layer if it is not.
  /// @param key  "barriers.height"
  std::optional<double> number(const OGRFeature& feature, int index, const std::string& key) {
    const std::string field = key.substr(key.find('.') + 1);
    std::optional<double> value;
    layer_.faults().attempt([&] {
      value = layer_.number(feature, index, field, bounds_of(key), false);
      if (!value) throw InputError(layer_.label(feature) + ": has no " + field + ", must be " + meant_);
    });
    if (value) use_of(index, field, std::string(bounds_of(key).unit)).add(*value);
    return value;
  }

  /// Appends the lines of a feature. Returns false if they lie wholly off the DEM.
  bool read(const OGRFeature& feature, std::vector<std::vector<Eigen::Vector2d>>& lines) {
    ++features_;
    const Parts parts = layer_.parts(feature);
    if (!parts.polygons.empty() || !parts.points.empty() || parts.lines.empty())
      throw InputError(layer_.label(feature) + ": " + (parts.empty() ? "has no geometry" : "is no line") +
                       ", must be " + meant_);
    std::vector<std::vector<Eigen::Vector2d>> own;
    for (const OGRLineString& line : parts.lines) {
      if (line.getNumPoints() < 2 || line.get_Length() == 0.0)
        throw InputError(layer_.label(feature) + ": line has no length, must have two places at least");
      std::vector<Eigen::Vector2d>& places = own.emplace_back();
      for (int i = 0; i < line.getNumPoints(); ++i) places.emplace_back(line.getX(i), line.getY(i));
    }
    const bool off = off_.add(std::to_string(feature.GetFID()), own);
    lines.insert(lines.end(), own.begin(), own.end());
    return !off;
  }

  /// Throws InputError if the layer is empty, or if the number of a feature without an id is the id of another. Fills
  /// the warnings and reprojections of `out`.
  template <class Out>
  void finish(Out& out) {
    if (features_ == 0) throw InputError(path_ + ": has no features, must be " + meant_);
    for (const auto& [number, label] : numbered_)
      if (given_.contains(number))
        throw InputError(label + ": has no id, and its number " + number +
                         " is the id of another line, must have an id of its own");
    off_.warn(path_, "features", brought_from(layer_), out.warnings);
    if (id_ < 0)
      out.notes.push_back(path_ + ": no field id or name: the lines are called by the numbers of their features");
    const std::vector<std::string> there = layer_.field_names();
    if (!there.empty()) out.notes.push_back(fields_note(path_, uses_, features_, there));
    layer_.tell(out);
  }

 private:
  FieldUse& use_of(int index, const std::string& name, const std::string& unit) {
    const auto found = std::ranges::find(uses_, index, &FieldUse::index);
    if (found != uses_.end()) return *found;
    uses_.push_back({name, layer_.field_names()[static_cast<std::size_t>(index)], unit, index});
    uses_.back().from_text = unit.empty() ? false : layer_.holds_text(index);
    return uses_.back();
  }

  std::string path_, meant_;
  LinesOff off_;
  Layer layer_;
  int id_;
  std::vector<FieldUse> uses_;                   // of `id` first
  std::set<std::string> given_;                  // ids of features that have one
  std::map<std::string, std::string> numbered_;  // the others: number and label
  std::size_t features_ = 0;
};

/// A warning of the screens or barriers that lie, wholly or partly, where the terrain has no height.
/// @param kind    "screen"
/// @param effect  what comes of it
/// @param on_map  ids of those that are not wholly off the DEM: of the others the reader has warned
template <class Line>
void warn_of_gaps(std::span<const Line> lines, const std::string& kind, const std::string& effect,
                  const std::string& path, const Terrain& terrain, const std::set<std::string>& on_map,
                  std::vector<std::string>& warnings) {
  std::vector<std::string> lacks;
  for (const Line& line : lines) {
    const double share = share_without_height({line.id, line.lines}, terrain.heights);
    if (share >= kNoticedWithoutHeight && on_map.contains(line.id))
      lacks.push_back(percent(share, 2) + " of " + kind + " " + line.id);
  }
  if (!lacks.empty())
    warnings.push_back(path + ": where the DEM has no height (off it, in its outer half cell or in a gap) lie " +
                       listed(lacks) + ": blocks do not get there, so that " + effect);
}

constexpr double kApart = 0.01;  // lines lie on each other within this [m]: places are rounded to millimetres

/// The part of a straight piece that lies on another one, as distances from its start [m]; empty if less than 0.1 m
/// does, as where lines only cross.
Range overlap(const LinePiece& piece, const LinePiece& other) {
  constexpr double kLeast = 0.1;
  const Eigen::Vector2d way = piece.to - piece.from, line = other.to - other.from;
  const double length = way.norm();
  const auto along = [&](const Eigen::Vector2d& place) {
    return std::clamp(way.dot(place - piece.from) / length, 0.0, length);
  };
  const auto [low, high] = std::minmax({along(other.from), along(other.to)});
  const auto beside = [&](double at) {
    const Eigen::Vector2d place = piece.from + at / length * way - other.from;
    const double share = std::clamp(line.dot(place) / line.squaredNorm(), 0.0, 1.0);
    return (place - share * line).norm();
  };
  return high - low > kLeast && beside(low) < kApart && beside(high) < kApart ? Range{low, high} : Range{0.0, 0.0};
}

/// Length of the union of some parts of a line [m].
double length_of_union(std::vector<Range> parts) {
  std::ranges::sort(parts, {}, &Range::low);
  double length = 0.0, end = 0.0;
  for (const Range& part : parts) {
    length += std::max(0.0, part.high - std::max(part.low, end));
    end = std::max(end, part.high);
  }
  return length;
}

/// Length of the lines of a feature that lies on another part of them [m]. Along their longer side, so that only
/// neighbours are compared.
double doubled_length(const std::vector<std::vector<Eigen::Vector2d>>& lines) {
  std::vector<LinePiece> pieces;
  append_pieces(0, lines, pieces);
  std::erase_if(pieces, [](const LinePiece& piece) { return piece.from == piece.to; });
  Eigen::AlignedBox2d box;
  for (const LinePiece& piece : pieces) box.extend(piece.from).extend(piece.to);
  const int axis = !box.isEmpty() && box.sizes().y() > box.sizes().x() ? 1 : 0;
  const auto first = [&](const LinePiece& piece) { return std::min(piece.from[axis], piece.to[axis]); };
  std::ranges::sort(pieces, {}, first);
  std::vector<std::vector<Range>> parts(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double last = std::max(pieces[i].from[axis], pieces[i].to[axis]) + kApart;
    for (std::size_t k = i + 1; k < pieces.size() && first(pieces[k]) <= last; ++k)
      if (const Range part = overlap(pieces[k], pieces[i]); part.high > part.low) parts[k].push_back(part);
  }
  double length = 0.0;
  for (std::vector<Range>& of_piece : parts) length += length_of_union(std::move(of_piece));
  return length;
}

/// Warns of screens or barriers that lie on themselves, as when a line was pasted twice or drawn there and back.
/// @param kind    "screen"
/// @param effect  what comes of it
template <class Line>
void warn_of_doubled_lines(std::span<const Line> lines, const std::string& kind, const std::string& effect,
                           const std::string& path, std::vector<std::string>& warnings) {
  for (const Line& line : lines)
    if (const double length = doubled_length(line.lines); length > 0.0)
      warnings.push_back(path + ": lines of " + kind + " " + line.id + " lie on each other for " +
                         with_digits(length, 3) + " m: " + effect);
}

}  // namespace

double share_without_height(const Screen& screen, const Raster<float>& heights) {
  WithoutHeight length;
  for (const auto& line : screen.lines) add_line(length, heights, line);
  return length.share();
}

ScreenLayer read_screens(const std::string& path, const Terrain& terrain) {
  LineReader reader("screens", path, terrain, "lines that blocks may cross");
  ScreenLayer out;
  std::set<std::string> on_map;
  for_each_feature(reader.layer(), [&](const Feature& feature) {
    const std::string id = reader.id_of(*feature);
    auto screen = std::find_if(out.screens.begin(), out.screens.end(), [&](const Screen& s) { return s.id == id; });
    if (screen == out.screens.end()) screen = out.screens.insert(screen, Screen{id, {}});
    if (reader.read(*feature, screen->lines)) on_map.insert(id);
  });
  reader.finish(out);
  warn_of_gaps<Screen>(out.screens, "screen", "the crossings are lower bounds (unsafe)", path, terrain, on_map,
                       out.warnings);
  warn_of_doubled_lines<Screen>(out.screens, "screen",
                                "crossings there count more than once in screens.csv (talus barrier takes the first of "
                                "a block). Delete one, or give it another id",
                                path, out.warnings);
  return out;
}

BarrierLayer read_barriers(const std::string& path, const Terrain& terrain) {
  LineReader reader("barriers", path, terrain,
                    "lines with the fields height (m) and capacity (kJ; inf: any energy, as a dam)");
  BarrierLayer out;
  std::set<std::string> on_map;
  const int height = reader.layer().field("height"), capacity = reader.layer().field("capacity");
  for_each_feature(reader.layer(), [&](const Feature& feature) {
    Barrier& barrier = out.barriers.emplace_back();
    barrier.id = reader.id_of(*feature);
    barrier.height = reader.number(*feature, height, "barriers.height").value_or(0.0);
    barrier.capacity = 1e3 * reader.number(*feature, capacity, "barriers.capacity").value_or(0.0);
    if (reader.read(*feature, barrier.lines)) on_map.insert(barrier.id);
  });
  reader.finish(out);
  warn_of_gaps<Barrier>(out.barriers, "barrier", "nothing is caught there", path, terrain, on_map, out.warnings);
  warn_of_doubled_lines<Barrier>(
      out.barriers, "barrier",
      "it takes its capacity from a block there more than once (unsafe). Delete the doubled part", path, out.warnings);
  return out;
}

void warn_of_barriers_off(const std::string& where, std::span<const Barrier> barriers, const Terrain& terrain,
                          std::vector<std::string>& warnings) {
  LinesOff off(terrain);
  std::set<std::string> on_map;
  for (const Barrier& barrier : barriers)
    if (!off.add(barrier.id, barrier.lines)) on_map.insert(barrier.id);
  off.warn(where, "barriers", "", warnings);
  warn_of_gaps<Barrier>(barriers, "barrier", "nothing is caught there", where, terrain, on_map, warnings);
}

}  // namespace talus::io
