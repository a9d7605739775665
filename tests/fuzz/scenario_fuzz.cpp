#include "fuzz.hpp"
#include "talus/io/scenario/loaded_scenario.hpp"

/// The bytes are a scenario, in a folder where `site` put a terrain, zones and sources.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace talus;
  const auto file = fuzz::site() / "scenario.toml";
  fuzz::write(file, {reinterpret_cast<const char*>(data), size});
  fuzz::refused_or_read([&] {
    io::RunFlags flags;
    flags.scenario = file;
    io::load_scenario(flags);
  });
  return 0;
}
