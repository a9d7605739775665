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

/// Where blocks ended: a layer of points in the system of the DEM.
///
/// `stops`: every block. Fields: source, block, end (stopped, trapped, left, caught, limit), feature (name of the
/// source's feature, else its number from 0), diameter_m, mass_kg, x_release, y_release (map coordinates), z, seconds,
/// max_speed_ms, length_m, impacts, energy_line_deg (NULL where a block ended at its release). The point and z in full
/// precision, other numbers to three decimals (the diameter to four).
///
/// `exits`: one per row that left the terrain; without any the layer is empty. Fields: source, block, feature,
/// diameter_m, mass_kg, z, seconds as in `stops`; speed_ms and energy_kj (translational) of the block there.
class PointsWriter {
 public:
  enum class Layer { Stops, Exits };
  PointsWriter(const std::filesystem::path& file, const LoadedScenario& loaded, Layer layer);
  ~PointsWriter();
  void write(std::span<const StopRow> rows);
  void finish();

 private:
  struct State;
  Layer layer_;
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

/// Name of what begins at a vertex: release, impact, slide, takeoff, air, stem, barrier, end.
const char* name_of(Event event);
/// Name of the end of a trajectory: stopped, trapped, left, caught or limit.
const char* name_of(End end);

}  // namespace talus::io
