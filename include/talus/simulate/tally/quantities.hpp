#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

namespace talus {

/// The largest values of the motion on a piece of a path; the quantities follow from them.
struct Maxima {
  float speed_squared = 0.0F;  ///< [m^2/s^2]
  float height = 0.0F;         ///< vertical, above the terrain [m]

  void raise(const Maxima& other) {
    speed_squared = std::max(speed_squared, other.speed_squared);
    height = std::max(height, other.height);
  }
};

/// A quantity of the cells: each trajectory counts with its largest value in the cell.
struct QuantityEntry {
  std::string_view name;   ///< of its map
  std::string_view title;  ///< one line
  std::string_view unit;
  double fixed_point;                                 ///< unit of the sums [unit]
  float (*value)(const Maxima& maxima, double mass);  ///< of a trajectory; mass [kg]
};

/// The quantities, in the order of `kQuantityTable`.
enum class Quantity : std::size_t { Energy, Speed, Height };

/// The table of all quantities. Values, sums, histograms, exceedances, bytes on the disk and maps follow from it.
/// docs/adding-a-raster.md.
inline constexpr std::array kQuantityTable{
    QuantityEntry{"energy", "Translational kinetic energy", "kJ", 0x1p-10,
                  [](const Maxima& m, double mass) { return static_cast<float>(0.5e-3 * mass * m.speed_squared); }},
    QuantityEntry{"velocity", "Speed", "m/s", 0x1p-16,
                  [](const Maxima& m, double) { return std::sqrt(m.speed_squared); }},
    QuantityEntry{"jump_height", "Vertical height above terrain", "m", 0x1p-16,
                  [](const Maxima& m, double) { return m.height; }},
};
inline constexpr std::size_t kQuantities = kQuantityTable.size();
static_assert(kQuantities == static_cast<std::size_t>(Quantity::Height) + 1, "an entry for each quantity");

constexpr std::size_t index_of(Quantity quantity) {
  return static_cast<std::size_t>(quantity);
}

/// One of something for each quantity.
template <class T>
struct PerQuantity : std::array<T, kQuantities> {
  using std::array<T, kQuantities>::operator[];
  T& operator[](Quantity quantity) { return (*this)[index_of(quantity)]; }
  const T& operator[](Quantity quantity) const { return (*this)[index_of(quantity)]; }
};

/// Thresholds whose exceedances are counted, by quantity, ascending. A quantity may have none.
using Thresholds = PerQuantity<std::vector<double>>;

inline Thresholds thresholds_of(std::vector<double> energies, std::vector<double> heights) {
  Thresholds thresholds;
  thresholds[Quantity::Energy] = std::move(energies);
  thresholds[Quantity::Height] = std::move(heights);
  return thresholds;
}

/// Calls `action` with the index of each quantity as a compile-time constant: the loop is unrolled and the table
/// is inlined.
template <class Action>
constexpr void for_each_quantity(Action&& action) {
  [&]<std::size_t... q>(std::index_sequence<q...>) {
    (action(std::integral_constant<std::size_t, q>{}), ...);
  }
  (std::make_index_sequence<kQuantities>{});
}

}  // namespace talus
