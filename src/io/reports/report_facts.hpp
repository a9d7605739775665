#pragma once
#include <array>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/files/json.hpp"
#include "report_frequency.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/scenario.hpp"

/// What a page shows of a run: plain values, read from the records of its folder. docs/report.md.
namespace talus::io {

/// A setting as the record holds it; the value as text.
struct RecordedSetting {
  std::string key, value, unit, source;

  bool is_default() const { return source == "default"; }
  bool is_of_preset() const { return source.starts_with("preset "); }
};

/// Place and size of the cells.
struct RecordedGrid {
  int columns = 0, rows = 0;
  double cell_x = 0.0, cell_y = 0.0, west = 0.0, north = 0.0;  ///< [m]
  std::string crs;                                             ///< "EPSG:2056 (CH1903+ / LV95)"
};

/// Blocks that stay in gullies too steep to rest in, and the cell in which most of them stay.
struct GullyFacts {
  double blocks = 0.0;
  double x = 0.0, y = 0.0;                    ///< of the cell [m]
  double worst_blocks = 0.0, passages = 0.0;  ///< that stay in it, that cross it
};

/// A barrier that stood in the run, and what became of the blocks at it.
struct StandingBarrier {
  Screen line;           ///< its id and lines, in map coordinates [m]; without lines in an earlier record
  double height = 0.0;   ///< [m]
  std::string capacity;  ///< [kJ]
  double caught = 0.0, over = 0.0, broken = 0.0;
};

/// run.json.
struct RunFacts {
  std::string version, command, status, plan;
  std::string plan_of_hazard;  ///< that its hazard.json names: of several rounds that of all together
  bool of_profile = false;     ///< of `talus profile`
  std::string written;         ///< day of the file run.json, "2026-11-23": a copy may have a later one
  double released = 0.0, source_cells = 0.0, per_source = 0.0, rounds = 0.0, impacts = 0.0, kilometres = 0.0;
  double touched_cells = 0.0, deformation_coefficient = 0.0;
  std::optional<std::pair<double, double>> diameters;  ///< of the smallest and the largest block [m]; earlier: nothing
  std::vector<std::pair<std::string, double>> ends;    ///< in the order of the record
  std::optional<std::array<double, 3>> energy_line;    ///< least, P5, P50 [deg]
  double energy_line_stops = 0.0;                      ///< how many blocks that is of
  double energy_line_farther = 0.0;                    ///< those that stopped farther away than this [m]
  std::optional<GullyFacts> gullies;                   ///< nothing in an earlier record
  double left_into_gaps = 0.0;                         ///< 0 in an earlier record
  double left_with_pieces = 0.0;                       ///< blocks of which a piece left; 0 where none may break
  double limit_with_pieces = 0.0;                      ///< blocks of which a piece ended at a limit, likewise
  RecordedGrid grid;
  std::vector<Screen> screens;  ///< in map coordinates [m]
  std::vector<StandingBarrier> barriers;
  bool fitted_ground = false;        ///< a number of the ground is of a model that was fitted
  bool count_rotation = false;       ///< thresholds and hazard count the energy with rotation
  double pieces = 0.0;               ///< of broken blocks
  std::vector<std::string> effects;  ///< that acted
  std::vector<RecordedSetting> settings;
  std::vector<InputFile> inputs;
  std::vector<Reprojection> reprojections;
  std::vector<std::string> warnings, notes;
  std::vector<std::string> files;  ///< that the run has written

  double end(const std::string& name) const;  ///< 0 if there is none
  const InputFile* input(const std::string& role) const;
  std::vector<const RecordedSetting*> settings_of(const std::string& beginning) const;
};

/// hazard.json.
struct HazardFacts {
  std::string command, object;
  double events_per_year = 0.0, left_per_year = 0.0;
  std::vector<double> energies, years;   ///< between the classes of intensity [kJ] and of return period [years]
  std::vector<std::string> class_names;  ///< by number
  std::vector<std::vector<std::string>> classes;  ///< names: a row for each class of intensity, the shortest time first
  std::vector<std::string> warnings;
  FrequencyFacts frequency;
  std::vector<std::string> files;  ///< that talus hazard has written
  bool same_run = true;            ///< of the plan of run.json
};

/// Reads OUT/run.json. Throws InputError if it cannot be read or `talus run` has not written it.
RunFacts read_facts(const std::filesystem::path& folder);

/// Reads OUT/hazard.json; nothing if it is not there. Throws InputError if it cannot be understood.
std::optional<HazardFacts> read_hazard_facts(const std::filesystem::path& folder, const RunFacts& run);

/// The warnings of the run and of its hazard maps, each once.
std::vector<std::string> all_warnings(const RunFacts& run, const std::optional<HazardFacts>& hazard);

/// A day (UTC): "2026-11-23"; empty if there is none.
std::string day_text(std::time_t time);
/// Day on which a file was written last (UTC): "2026-11-23"; empty if it is not known.
std::string day_of(const std::filesystem::path& file);

/// Largest table that is read for a page [byte].
inline constexpr std::uintmax_t kMostPageTable = std::uintmax_t{128} << 20U;

/// "NAME has more than 128 MB" for a table above `kMostPageTable`; empty else.
std::string too_large_for_page(const std::filesystem::path& table);

/// Reads a record beside the run by `read`. Throws InputError "FILE: cannot be understood (...)".
template <class Read>
auto understood(const std::filesystem::path& file, Read read) {
  return understood(file, "must be as talus has written it; run that command again",
                    [&] { return read(read_record(file)); });
}

/// The texts of a list in a record, at most some hundred of them.
std::vector<std::string> texts_of(const Json& json, const char* key);

/// A number of a record that is finite; `otherwise` if it is not there or null.
double number_of(const Json& json, const char* key, double otherwise = 0.0);

}  // namespace talus::io
