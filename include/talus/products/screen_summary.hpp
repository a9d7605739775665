#pragma once
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "talus/simulate/screens/screens.hpp"

namespace talus {

/// A reported quantity of the crossings of a screen, in the unit of the files.
struct ScreenQuantity {
  std::string_view name, unit;
  double (*of)(const Crossing&);
};
std::span<const ScreenQuantity> screen_quantities();

/// The distributions of all crossings, by screen. Stores 4 bytes per crossing and quantity.
class ScreenSummary {
 public:
  explicit ScreenSummary(std::size_t screens) : screens_(screens) {}

  void add(std::span<const Crossing> crossings);

  struct Row {
    std::size_t crossings, blocks;  ///< blocks: every (source, block) once
    double mean, p50, p95, p99, maximum;
  };
  /// Summary of one quantity, given by its index in `screen_quantities`; NaN if nothing crossed.
  Row row(std::size_t screen, std::size_t quantity) const;

 private:
  static constexpr std::size_t kQuantities = 8;
  struct One {
    std::array<std::vector<float>, kQuantities> values;
    std::size_t blocks = 0;
    std::uint32_t source = 0, block = 0;  // of the last crossing
  };
  std::vector<One> screens_;
};

}  // namespace talus
