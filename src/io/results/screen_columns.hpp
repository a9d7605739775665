#pragma once
#include <array>

namespace talus::io {

/// A quantity of the summary of the screens, and its column in screens.csv. The names of the fields of the layer of
/// screens begin like the column.
struct ScreenColumn {
  const char *quantity, *column;
};

inline constexpr std::array<ScreenColumn, 3> kScreenColumns{
    {{"speed", "speed_ms"}, {"energy", "energy_kj"}, {"jump height", "jump_height_m"}}};

}  // namespace talus::io
