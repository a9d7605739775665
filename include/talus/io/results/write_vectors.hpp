#pragma once
#include <filesystem>
#include <memory>
#include <span>

#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/simulate/stop_row.hpp"

namespace talus::io {

/// Writers of what `simulate` hands out while it runs: rows go to the file as they come, memory does not grow with
/// them (of a FlatGeobuf file by some 160 bytes a row). The format is that of the file's ending, .gpkg or .fgb. Called
/// from any thread, one at a time. `finish` completes the file; without it the file is worthless. All throw
/// std::runtime_error, one line with the file and the cause (a full disk).

/// Where every block ended: the layer `stops`, points in the system of the DEM.
///
/// Fields: source, block, end (stopped, trapped, left, caught, limit), feature (name of the source's feature, else its
/// number from 0), diameter_m, mass_kg, x_release, y_release (map coordinates), z, seconds, max_speed_ms, length_m,
/// impacts. The point and z in full precision, other numbers to three decimals (the diameter to four).
class StopsWriter {
 public:
  StopsWriter(const std::filesystem::path& file, const LoadedScenario& loaded);
  ~StopsWriter();
  void write(std::span<const StopRow> rows);
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Where paths left the terrain: the layer `exits`, points in the system of the DEM, one per row that
/// ended so; without any the layer is empty.
///
/// Fields: source, block, feature, diameter_m, mass_kg, z, seconds as in the layer `stops`; speed_ms and energy_kj
/// (translational) of the block there.
class ExitsWriter {
 public:
  ExitsWriter(const std::filesystem::path& file, const LoadedScenario& loaded);
  ~ExitsWriter();
  void write(std::span<const StopRow> rows);
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Paths of recorded blocks: the layer `trajectories`, LineString ZM with M = time since the release
/// [s].
class TrajectoriesWriter {
 public:
  TrajectoriesWriter(const std::filesystem::path& file, const GeoReference& geo, const Grid& grid);
  ~TrajectoriesWriter();
  void write(const RecordedPath& path);

  /// Adds the layer `vertices`, points ZM with the motion just after each vertex: time, speed_ms, vx, vy, vz, wx, wy,
  /// wz, event. For `talus trace`.
  void write_vertices(const Path& path);
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Name of what begins at a vertex: release, impact, slide, takeoff, end.
const char* name_of(Event event);
/// Name of the end of a trajectory: stopped, trapped, left, caught or limit.
const char* name_of(End end);

}  // namespace talus::io
