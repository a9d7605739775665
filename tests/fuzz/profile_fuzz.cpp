#include "fuzz.hpp"
#include "talus/io/scenario/profile_file.hpp"

/// The first byte says which file the rest is: the profile's TOML or its line.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace talus;
  fuzz::Bytes bytes(data, size);
  const bool line = bytes.yes();
  const auto toml = fuzz::site() / "profile.toml", csv = fuzz::site() / "line.csv";
  fuzz::write(toml, "profile = \"line.csv\"\n[sources]\nx = [1, 5]\n[blocks]\ndiameter = 1\n");
  fuzz::write(csv, "x,z\n0,100\n50,60\n100,60\n");
  fuzz::write(line ? csv : toml, bytes.rest());
  fuzz::refused_or_read([&] {
    io::ProfileFlags flags;
    flags.run.scenario = toml;
    io::load_profile(flags);
  });
  return 0;
}
