#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "talus/io/scenario/profile_file.hpp"
#include "talus/products/profile_bins.hpp"
#include "talus/simulate/screens/screens.hpp"

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

}  // namespace talus::io
