#include "tile_pyramid.hpp"

#include <algorithm>
#include <cmath>

#include "io/files/compression.hpp"
#include "talus/base/expect.hpp"

namespace talus::io {
namespace {

/// Overviews go on until the map is no larger than this.
int smallest_overview(const MapTarget& target) {
  const int size = std::max(target.columns, target.rows);
  return size > 256 ? 512 : size > 128 ? 256 : 128;
}

/// The larger of two stored values; nodata is less than any other.
float larger(float a, float b) {
  return std::max(a, b);
}
std::uint32_t larger(std::uint32_t a, std::uint32_t b) {
  return std::max(a + 1U, b + 1U) - 1U;
}  // kCountNodata + 1 is 0

/// The smaller of two stored values; nodata only if both are.
float smaller(float a, float b) {
  return a == kNothing<float> ? b : b == kNothing<float> ? a : std::min(a, b);
}
std::uint32_t smaller(std::uint32_t a, std::uint32_t b) {
  return std::min(a, b);
}

/// The value farther from 0 of two stored ones; nodata only if both are. The larger one of -1 and 1.
float farther(float a, float b) {
  if (a == kNothing<float>) return b;
  if (b == kNothing<float>) return a;
  return std::abs(a) == std::abs(b) ? std::max(a, b) : std::abs(a) > std::abs(b) ? a : b;
}
std::uint32_t farther(std::uint32_t a, std::uint32_t b) {
  return larger(a, b);
}

}  // namespace

template <>
float stored<float>(double value) {
  return std::isnan(value) ? kNothing<float> : static_cast<float>(value);
}
template <>
std::uint32_t stored<std::uint32_t>(double value) {
  return std::isnan(value) ? kCountNodata : static_cast<std::uint32_t>(std::min(value, kCountNodata - 1.0));
}

template <class T>
TilePyramid<T>::TilePyramid(const Map& map, const MapTarget& target, int side)
    : map_(map), target_(target), side_(side), bands_(map.bands.size()) {
  add_levels();
  const CogLevel& top = levels_.back();
  for (int y = 0; y < top.down; ++y)
    for (int x = 0; x < top.across; ++x) add_parts({static_cast<int>(levels_.size()) - 1, x, y});
}

template <class T>
void TilePyramid<T>::add_levels() {
  int columns = target_.columns, rows = target_.rows;
  while (true) {
    const int across = (columns + side_ - 1) / side_, down = (rows + side_ - 1) / side_;
    levels_.push_back({columns, rows, across, down, std::vector<TilePlace>(static_cast<std::size_t>(across) * down)});
    if (std::max(columns, rows) <= smallest_overview(target_)) return;
    columns = (columns + 1) / 2, rows = (rows + 1) / 2;
  }
}

/// Adds the parts under a tile, square after square.
template <class T>
void TilePyramid<T>::add_parts(const Place& place) {
  const auto values = map_.everywhere ? map_.everywhere(cells_of(place)) : std::nullopt;
  if (values) {
    parts_.push_back({place, std::vector<T>(bands_)});
    std::transform(values->begin(), values->end(), parts_.back().everywhere->begin(), stored<T>);
    return;
  }
  if (place.level == 0) {
    parts_.push_back({place, std::nullopt});
    return;
  }
  const CogLevel& under = levels_[static_cast<std::size_t>(place.level) - 1];
  for (int y = 2 * place.y; y < std::min(2 * place.y + 2, under.down); ++y)
    for (int x = 2 * place.x; x < std::min(2 * place.x + 2, under.across); ++x) add_parts({place.level - 1, x, y});
}

template <class T>
std::uint64_t TilePyramid<T>::place_of(std::size_t i) const {
  const Place& place = parts_[i].place;
  const std::uint64_t x = std::uint64_t(place.x) << place.level, y = std::uint64_t(place.y) << place.level;
  std::uint64_t along = 0;
  for (int bit = 0; bit < 31; ++bit)  // the bits of row and column in turn
    along |= (x >> bit & 1U) << 2 * bit | (y >> bit & 1U) << (2 * bit + 1);
  return along;
}

/// The cells of the map under a tile.
template <class T>
CellWindow TilePyramid<T>::cells_of(const Place& place) const {
  const std::int64_t side = std::int64_t{side_} << place.level;
  const auto west = static_cast<int>(place.x * side), north = static_cast<int>(place.y * side);  // from the north
  const auto columns = static_cast<int>(std::min<std::int64_t>(side, target_.columns - west));
  const auto rows = static_cast<int>(std::min<std::int64_t>(side, target_.rows - north));
  return {west, target_.rows - north - rows, columns, rows};
}

template <class T>
int TilePyramid<T>::columns_of(const Place& place) const {
  return std::min(side_, levels_[static_cast<std::size_t>(place.level)].columns - place.x * side_);
}

template <class T>
int TilePyramid<T>::rows_of(const Place& place) const {
  return std::min(side_, levels_[static_cast<std::size_t>(place.level)].rows - place.y * side_);
}

template <class T>
void TilePyramid<T>::make_part(std::size_t i, TileStore& store) {
  const Part& part = parts_[i];
  if (part.everywhere)
    finish_even(part.place, *part.everywhere, store);
  else
    finish(part.place, filled(part.place), store);
}

/// The pixels of a tile of the full resolution.
template <class T>
auto TilePyramid<T>::filled(const Place& place) const -> Pixels {
  constexpr int kStripe = 16;  // rows that the map gives at once
  const CellWindow cells = cells_of(place);
  Pixels pixels(pixel(0, side_), kNothing<T>);
  std::vector<double> values;
  for (int top = 0; top < cells.rows; top += kStripe) {
    const int rows = std::min(kStripe, cells.rows - top);
    const CellWindow stripe{cells.column, cells.row + cells.rows - top - rows, cells.columns, rows};
    values.resize(stripe.cells() * bands_);
    map_.fill(stripe, values);
    const std::size_t row = static_cast<std::size_t>(stripe.columns) * bands_;
    for (int y = 0; y < rows; ++y) {  // from the north, where the map begins in the south
      const double* const from = &values[static_cast<std::size_t>(rows - 1 - y) * row];
      std::transform(from, from + row, &pixels[pixel(0, top + y)], stored<T>);
    }
  }
  return pixels;
}

/// The values of a tile that has the same all over the map.
template <class T>
std::optional<std::vector<T>> TilePyramid<T>::even_values(const Place& place, const Pixels& pixels) const {
  const int columns = columns_of(place), rows = rows_of(place);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      if (!std::equal(pixels.begin(), pixels.begin() + static_cast<std::ptrdiff_t>(bands_),
                      pixels.begin() + static_cast<std::ptrdiff_t>(pixel(x, y))))
        return std::nullopt;
  return std::vector<T>(pixels.begin(), pixels.begin() + static_cast<std::ptrdiff_t>(bands_));
}

template <class T>
void TilePyramid<T>::finish(const Place& place, const Pixels& pixels, TileStore& store) {
  const auto even = even_values(place, pixels);
  levels_[static_cast<std::size_t>(place.level)].tile(place.x, place.y) =
      even ? even_tile(*even, store) : store.add(deflated(std::as_bytes(std::span(pixels))));
  raise(place, store, [&](Pixels& to) { halve(place, pixels, to); });
}

/// Finishes a tile, and all under it, that has the same values all over.
template <class T>
void TilePyramid<T>::finish_even(const Place& place, const std::vector<T>& values, TileStore& store) {
  const TilePlace tile = even_tile(values, store);
  for (int level = place.level, many = 1; level >= 0; --level, many *= 2) {
    CogLevel& of = levels_[static_cast<std::size_t>(level)];
    for (int y = place.y * many; y < std::min((place.y + 1) * many, of.down); ++y)
      for (int x = place.x * many; x < std::min((place.x + 1) * many, of.across); ++x) of.tile(x, y) = tile;
  }
  raise(place, store, [&](Pixels& to) { put_even(place, values, to); });
}

/// Puts a tile into the overview tile above it, and finishes this one if it was the last under it.
template <class T>
template <class Put>
void TilePyramid<T>::raise(const Place& place, TileStore& store, const Put& put) {
  if (place.level + 1 == static_cast<int>(levels_.size())) return;
  const Place above{place.level + 1, place.x / 2, place.y / 2};
  const std::tuple key{above.level, above.y, above.x};
  const CogLevel& under = levels_[static_cast<std::size_t>(place.level)];
  const auto found = [&] {
    const std::scoped_lock lock(mutex_);
    const auto [at, fresh] = growing_.try_emplace(key);
    if (fresh)
      at->second = {Pixels(pixel(0, side_), kNothing<T>),
                    std::min(2, under.across - 2 * above.x) * std::min(2, under.down - 2 * above.y)};
    return at;
  }();
  put(found->second.pixels);  // each tile has its own quarter
  Pixels pixels;
  {
    const std::scoped_lock lock(mutex_);
    if (--found->second.missing > 0) return;
    pixels = std::move(found->second.pixels);
    growing_.erase(found);
  }
  finish(above, pixels, store);
}

/// Puts a tile into its quarter of the one above: each pixel has one of the values under it, as the map chooses.
template <class T>
void TilePyramid<T>::halve(const Place& from, const Pixels& pixels, Pixels& to) const {
  const auto chosen = [smallest = map_.smallest_in_overviews, farthest = map_.farthest_in_overviews](T a, T b) {
    return farthest ? farther(a, b) : smallest ? smaller(a, b) : larger(a, b);
  };
  const int wide = columns_of(from), high = rows_of(from);
  const int first_x = from.x % 2 * side_ / 2, first_y = from.y % 2 * side_ / 2;
  for (int y = 0; y < (high + 1) / 2; ++y)
    for (int x = 0; x < (wide + 1) / 2; ++x) {
      const int right = std::min(2 * x + 1, wide - 1), lower = std::min(2 * y + 1, high - 1);
      const T* const a = &pixels[pixel(2 * x, 2 * y)];
      const T* const b = &pixels[pixel(right, 2 * y)];
      const T* const c = &pixels[pixel(2 * x, lower)];
      const T* const d = &pixels[pixel(right, lower)];
      T* const out = &to[pixel(first_x + x, first_y + y)];
      for (std::size_t band = 0; band < bands_; ++band)
        out[band] = chosen(chosen(a[band], b[band]), chosen(c[band], d[band]));
    }
}

template <class T>
void TilePyramid<T>::put_even(const Place& from, const std::vector<T>& values, Pixels& to) const {
  const int first_x = from.x % 2 * side_ / 2, first_y = from.y % 2 * side_ / 2;
  for (int y = 0; y < (rows_of(from) + 1) / 2; ++y)
    for (int x = 0; x < (columns_of(from) + 1) / 2; ++x)
      std::ranges::copy(values, &to[pixel(first_x + x, first_y + y)]);
}

/// A tile with these values all over; nowhere if all are nodata.
template <class T>
TilePlace TilePyramid<T>::even_tile(const std::vector<T>& values, TileStore& store) {
  if (std::ranges::all_of(values, [](T value) { return value == kNothing<T>; })) return {};
  const std::scoped_lock lock(mutex_);
  const auto [at, fresh] = even_.try_emplace(values);
  if (!fresh) return at->second;
  Pixels pixels(pixel(0, side_));
  for (std::size_t i = 0; i < pixels.size(); i += bands_)
    std::ranges::copy(values, pixels.begin() + static_cast<std::ptrdiff_t>(i));
  at->second = store.add(deflated_well(std::as_bytes(std::span(pixels))));
  return at->second;
}

template class TilePyramid<float>;
template class TilePyramid<std::uint32_t>;

}  // namespace talus::io
