#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/products/accuracy.hpp"
#include "talus/simulate/simulation.hpp"

namespace talus::run {

using io::LoadedScenario;
using io::Setting;

/// Manifest: names all other files of a checkpoint. docs/regions.md, "Files of a part".
inline constexpr const char* kCheckpointManifest = "part.json";

/// "1/2".
std::string name_of(const Part& part);

/// Saved work of a run or of a part: the tally, the rows of stops, crossings and paths, and the position in the plan.
/// An interrupted run resumes from it; `talus merge` joins the checkpoints of the parts.
///
/// `part.json` names its files with their checksums. It is replaced last, so that the files it names are complete
/// whenever the program is killed. Files that it does not name are removed.
class Checkpoint {
 public:
  /// Begins a checkpoint of `part` of the plan in an empty folder. Throws std::runtime_error.
  /// @param asked  rounds that the run was asked for; a resumed run must ask for the same
  /// The processes of a group share the folder: each of them constructs a Checkpoint and calls every function that
  /// writes.
  Checkpoint(const std::filesystem::path& folder, const LoadedScenario& loaded, const Part& part, const Rounds& asked,
             ProcessGroup& processes = alone());

  /// Opens the checkpoint of an earlier program. Throws InputError if it is damaged or belongs to another plan than
  /// `loaded`.
  ///
  /// @param to_go_on  the run will be resumed: removes the files that a killed program left and the manifest does not
  /// name
  static Checkpoint opened(const std::filesystem::path& folder, const LoadedScenario& loaded, bool to_go_on,
                           ProcessGroup& processes = alone());

  Checkpoint(Checkpoint&&) noexcept;
  Checkpoint& operator=(Checkpoint&&) noexcept;
  ~Checkpoint();

  const Part& part() const { return part_; }
  /// Throws InputError if it is another part than the one that is asked for.
  ///
  /// @param out  the folder as the user named it
  void require_part(const Part& asked, const std::string& out) const;
  const Rounds& asked() const { return asked_; }
  std::uint32_t rounds() const { return rounds_; }  ///< rounds done
  /// Gives a plan, for its record, the settings (with `trajectories` multiplied by `rounds`), the notes and warnings
  /// and the scenario and included file of the program that began the run. Other inputs stay where they were read now.
  void recall(LoadedScenario& loaded, std::uint32_t rounds) const;
  bool between_rounds() const { return units_done_ == 0; }
  bool empty() const { return generation_ == 0; }  ///< nothing was saved yet
  const std::filesystem::path& folder() const { return folder_; }

  /// Sinks that write rows to the files of the checkpoint. Those for units and stops are set; those for paths and
  /// crossings only if the scenario has them.
  Sinks sinks();

  /// Sum of the totals of all processes. Only the leader gets it.
  Totals totals_of_all(const Totals& mine) const;

  /// Ends a round: closes its files of rows, so that they can be replayed. Does not save.
  void end_round(std::uint32_t round);

  /// Saves all work done so far and replaces the earlier save. Throws std::runtime_error; the earlier save then stays
  /// valid.
  void save(const Simulation& simulation, const Tally& tally);

  /// Adds the saved tally to `tally`. Throws InputError if a file is damaged.
  /// @return the saved totals
  Totals add_to(Tally& tally) const;
  /// Sets a simulation and its tally to the saved state. Each process of a group takes a share; the run that saved may
  /// have had more processes or fewer.
  void restore(Simulation& simulation, Tally& tally) const;
  /// Hands the saved rows of one round to sinks, in the order in which they were traced.
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
  std::vector<Setting> settings(std::uint32_t rounds) const;
  Totals saved_totals() const;
  void close_rows(std::uint32_t round);
  void write_manifest() const;
  void read_manifest();
  void remove_unnamed() const;

  std::filesystem::path folder_;
  std::string plan_;  // checksum of the plan
  const LoadedScenario* loaded_;
  ProcessGroup* processes_;
  std::vector<Setting> settings_;  // this and the next three members: as the program that began the run read the plan
  std::vector<std::string> notes_, warnings_;
  std::vector<io::InputFile> inputs_;
  Part part_;
  Rounds asked_;
  std::uint32_t rounds_ = 0;
  std::uint64_t units_done_ = 0;
  std::uint32_t generation_ = 0;  // number in the names of the saved files; 0: nothing is saved yet
  std::uint32_t round_ = 0;       // round being traced
  std::string rest_sha256_;
  std::vector<SavedFile> tallies_, reaches_;  // one per process
  std::vector<RowsFile> rows_files_;
  std::unique_ptr<Rows> rows_;  // file being written
};

}  // namespace talus::run
