#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "talus/base/open_file.hpp"
#include "talus/io/origin/origin.hpp"
#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/simulate/screens/screens.hpp"

namespace talus::io {

/// Writes `screens.csv`: one row for every time a block or a piece of it crossed a screen, in the order (source, block,
/// piece, time).
///
///   source,block,screen,speed_ms,energy_kj,total_energy_kj,jump_height_m,angular_velocity_rads,mass_kg,x,y[,piece]
///
/// speed_ms is the speed in space; energy_kj = 1/2 m v^2, total_energy_kj adds the rotation 1/2 (2/5 m R^2) w^2. Six
/// digits; x and y in map coordinates, to the millimetre. piece, only where blocks may break: 0 is the block or its
/// largest piece. Throws std::runtime_error on a full disk.
class CrossingsWriter {
 public:
  CrossingsWriter(const std::filesystem::path& file, const Scenario& scenario, const GeoReference& geo);
  void write(std::span<const Crossing> crossings);
  void finish();

 private:
  [[noreturn]] void fail() const;
  void put(const std::string& text);

  std::string name_;  // name of the file
  bool pieces_;       // blocks may break
  BufferedFile file_;
  std::vector<std::string> screens_;  // ids of the screens as written in the file
  MapPlace place_;
};

}  // namespace talus::io
