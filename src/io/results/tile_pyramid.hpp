#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>
#include <vector>

#include "io/files/cog_file.hpp"
#include "talus/io/results/write_rasters.hpp"

namespace talus::io {

/// Value of a cell as it is stored in the file.
template <class T>
T stored(double value);
template <>
float stored<float>(double value);
template <>
std::uint32_t stored<std::uint32_t>(double value);

/// Stored value of a cell without one.
template <class T>
inline constexpr T kNothing = T{};
template <>
inline constexpr float kNothing<float> = static_cast<float>(kNodata);
template <>
inline constexpr std::uint32_t kNothing<std::uint32_t> = kCountNodata;

/// The tiles of a map and of its overviews, made part by part, by any number of threads and in any order.
///
/// A part is a tile of the full resolution, or a larger square in which all cells have the same values: its tiles are
/// made once. An overview tile grows from the tiles under it, and is finished when it has them all. So only the
/// overview tiles above the parts at work are in memory: parts follow each other along a curve that fills square after
/// square.
template <class T>
class TilePyramid {
 public:
  TilePyramid(const Map& map, const MapTarget& target, int side);

  std::size_t parts() const { return parts_.size(); }
  /// Where a part begins on the curve, in tiles.
  std::uint64_t place_of(std::size_t i) const;
  void make_part(std::size_t i, TileStore& store);

  /// The full resolution and its overviews. After all parts are made.
  const std::vector<CogLevel>& levels() const { return levels_; }

 private:
  /// A tile of a level, counted from the north-west.
  struct Place {
    int level, x, y;
  };
  struct Part {
    Place place;
    std::optional<std::vector<T>> everywhere;  // the value of each band, if it is known
  };
  /// The pixels of a tile, [row][column][band]; those outside the map have no value.
  using Pixels = std::vector<T>;
  struct Growing {
    Pixels pixels;
    int missing;  // tiles under it
  };

  void add_levels();
  void add_parts(const Place& place);
  CellWindow cells_of(const Place& place) const;
  int columns_of(const Place& place) const;  // in the map
  int rows_of(const Place& place) const;

  Pixels filled(const Place& place) const;
  void finish(const Place& place, const Pixels& pixels, TileStore& store);
  void finish_even(const Place& place, const std::vector<T>& values, TileStore& store);
  template <class Put>
  void raise(const Place& place, TileStore& store, const Put& put);
  void halve(const Place& from, const Pixels& pixels, Pixels& to) const;
  void put_even(const Place& from, const std::vector<T>& values, Pixels& to) const;
  std::optional<std::vector<T>> even_values(const Place& place, const Pixels& pixels) const;
  TilePlace even_tile(const std::vector<T>& values, TileStore& store);
  std::size_t pixel(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(x)) * bands_;
  }

  const Map& map_;
  const MapTarget& target_;
  int side_;
  std::size_t bands_;
  std::vector<CogLevel> levels_;
  std::vector<Part> parts_;
  std::mutex mutex_;                                      // of what follows
  std::map<std::tuple<int, int, int>, Growing> growing_;  // by level, row and column
  std::map<std::vector<T>, TilePlace> even_;              // tiles with the same values all over
};

extern template class TilePyramid<float>;
extern template class TilePyramid<std::uint32_t>;

}  // namespace talus::io
