#pragma once
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/products/accuracy.hpp"
#include "talus/simulate/simulation.hpp"

namespace talus::run {

using io::LoadedScenario;
using io::Setting;

/// The file that names all others of a checkpoint; docs/regions.md, "Files of a part".
inline constexpr const char* kCheckpointManifest = "part.json";

/// The work of a run, or of a part of it, on the disk: the tally, the rows of stops, crossings and paths, and how far
/// it has come. From it an interrupted run goes on, and `talus merge` joins parts.
///
/// `part.json` names the files that belong to it, with their checksums, and is replaced last: whenever a program is
/// killed, what it names is whole. What it doesn't name is removed.
class Checkpoint {
 public:
  /// A new one in an empty folder, for this part of the plan. Throws std::runtime_error.
  /// @param asked  how many rounds there will be: who goes on must ask for the same
  /// The processes of a process group share the folder: all must make it, and call all that writes.
  Checkpoint(const std::filesystem::path& folder, const LoadedScenario& loaded, const Part& part, const Rounds& asked,
             ProcessGroup& processes = alone());

  /// The checkpoint of an earlier program. Throws InputError where it is damaged or belongs to another plan than
  /// `loaded`.
  ///
  /// @param to_go_on  what a killed program has left beside is removed
  static Checkpoint opened(const std::filesystem::path& folder, const LoadedScenario& loaded, bool to_go_on,
                           ProcessGroup& processes = alone());

  Checkpoint(Checkpoint&&) noexcept;
  Checkpoint& operator=(Checkpoint&&) noexcept;
  ~Checkpoint();

  const Part& part() const { return part_; }
  const Rounds& asked() const { return asked_; }
  std::uint32_t rounds() const { return rounds_; }  ///< that are done
  /// Those of the plan, as the program that began it had them; `trajectories` those of so many rounds.
  std::vector<Setting> settings(std::uint32_t rounds) const;
  bool between_rounds() const { return units_done_ == 0; }
  bool empty() const { return generation_ == 0; }  ///< nothing was saved yet
  const std::filesystem::path& folder() const { return folder_; }

  /// Receivers of rows: they write them where `save` finds them. Only the functions for rows are set: stops, and paths
  /// and crossings where the scenario has them.
  Sinks sinks();

  /// The sum of the totals of all processes; at the leader.
  Totals totals_of_all(const Totals& mine) const;

  /// A round is done: its rows can be replayed. It is not saved yet.
  void end_round(std::uint32_t round);

  /// Saves all that was done so far, in place of what was saved before. Throws std::runtime_error: what was saved
  /// before then still counts.
  void save(const Simulation& simulation, const Tally& tally);

  /// The saved totals; adds the saved tally to `tally`. Throws InputError where a file is damaged.
  Totals add_to(Tally& tally) const;
  /// Puts a simulation and its tally where the saved ones were. Each process of a group takes a share, however many
  /// there were.
  void restore(Simulation& simulation, Tally& tally) const;
  /// Hands the saved rows of one round to sinks, in the order in which they came.
  void replay(std::uint32_t round, const Sinks& sinks) const;

 private:
  struct Rows;
  struct SavedFile {
    std::string name, sha256;
  };
  struct RowsFile {
    std::uint32_t round, generation;
    std::string name, sha256;
  };
  Checkpoint(std::filesystem::path folder, const LoadedScenario& loaded, ProcessGroup& processes);
  std::vector<SavedFile> gathered(const SavedFile& mine) const;
  std::string checked(const std::string& name, const std::string& sha256) const;
  void close_rows(std::uint32_t round);
  void write_manifest() const;
  void read_manifest();
  void remove_unnamed() const;

  std::filesystem::path folder_;
  std::string plan_;  // its checksum
  const LoadedScenario* loaded_;
  ProcessGroup* processes_;
  std::vector<Setting> settings_;
  Part part_;
  Rounds asked_;
  std::uint32_t rounds_ = 0;
  std::uint64_t units_done_ = 0;
  std::uint32_t generation_ = 0;  // of the files; 0: none yet
  std::uint32_t round_ = 0;       // in work
  std::string rest_sha256_;
  std::vector<SavedFile> tallies_, reaches_;  // one of each process
  std::vector<RowsFile> rows_files_;
  std::unique_ptr<Rows> rows_;  // that are being written
};

}  // namespace talus::run
