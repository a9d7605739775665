#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "talus/io/scenario/profile_file.hpp"
#include "talus/simulate/screens/screens.hpp"
#include "talus/simulate/tally/profile_bins.hpp"

namespace talus::io {

/// Results of all blocks of a run on a profile.
struct ProfileResults {
  std::vector<ProfileBin> bins;
  Runout runout;
};

/// Writes stops.csv and profile.gpkg while a run on a profile goes on, and envelope.csv and runout.csv at its end:
/// docs/profile.md, "Results". Rows come in the order (source, block), from one thread at a time.
/// All throw std::runtime_error, one line with the file and the cause (a full disk).
class ProfileWriter {
 public:
  ProfileWriter(const std::filesystem::path& folder, const LoadedProfile& profile);
  ~ProfileWriter();
  void write(std::span<const StopRow> rows);
  void write(std::span<const Crossing> rows);
  void write(const RecordedPath& path);
  void finish(const ProfileResults& results);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A drawing of the results, SVG that needs no other file: the profile with some paths, the envelopes of speed, energy
/// and jump height along it, and the share of the blocks that goes farther than a distance.
std::string profile_svg(const LoadedProfile& profile, const ProfileResults& results,
                        std::span<const RecordedPath> paths);

}  // namespace talus::io
