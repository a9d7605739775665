#include <array>

#include "fuzz.hpp"
#include "talus/io/campaign/model_file.hpp"

namespace {

struct NamedText {
  const char* name;
  const char* text;
};

/// Two small campaigns that are read without complaint, with releases and with mapped blocks, and a model.
constexpr std::array kFiles{
    NamedText{
        "campaign.toml",
        "name = \"c\"\ncrs = \"EPSG:2056\"\ndem = \"dem.tif\"\nzones = \"zones.tif\"\nblocks = \"blocks.csv\"\n"
        "stops = \"stops.csv\"\npassages = \"passages.csv\"\nscreens = \"screens.csv\"\nsamples = \"samples.csv\"\n"
        "[zone_names]\n1 = \"talus\"\n2 = \"meadow\"\n[measurement_error]\nposition_m = 0.3\n"},
    NamedText{"blocks.csv",
              "id,x,y,release_height_m,mass_kg,L1_m,L2_m,L3_m,day,group,holdout\n"
              "b1,2600030,1200085,1,500,1,0.8,0.6,1,g,0\nb2,2600040,1200085,1,900,,,,2,g,1\n"},
    NamedText{"stops.csv", "id,x,y,mass_kg\nb1,2600030,1200030,400\nb2,2600042,1200020,900\n"},
    NamedText{"passages.csv", "id,screen,speed_ms,jump_height_m,angular_velocity_rads\nb1,S1,9,1,12\nb2,S1,,,\n"},
    NamedText{"screens.csv", "id,wkt\nS1,\"LINESTRING (2600010 1200050, 2600090 1200050)\"\n"},
    NamedText{"samples.csv", "id,x,y,z,speed_ms,angular_velocity_rads\nb1,2600030,1200060,160,8,10\n"},
    NamedText{"fitted.toml", "[ground]\ndefault = \"upper-talus-3d\"\n[ground.zones.talus]\nEn50 = 12\n"},
    NamedText{"mapped.toml",
              "name = \"m\"\ncrs = \"EPSG:2056\"\ndem = \"dem.tif\"\nzones = \"zones.tif\"\n"
              "[zone_names]\n1 = \"talus\"\n2 = \"meadow\"\n"
              "[deposits]\nfile = \"deposits.csv\"\nsources = \"cliffs.geojson\"\n"},
    NamedText{"deposits.csv",
              "id,x,y,mass_kg\nd1,2600030,1200030,400\nd2,2600042,1200020,900\nd3,2600050,1200025,80\n"}};

}  // namespace

/// The first byte says which file of the campaigns, or of the model, the rest is.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace talus;
  fuzz::Bytes bytes(data, size);
  const std::size_t changed = bytes.index(kFiles.size());
  for (std::size_t i = 0; i < kFiles.size(); ++i)
    fuzz::write(fuzz::site() / kFiles[i].name, i == changed ? bytes.rest() : kFiles[i].text);
  const std::string_view name = kFiles[changed].name;
  const bool mapped = name == "mapped.toml" || name == "deposits.csv";
  fuzz::refused_or_read([&] {
    const io::LoadedCampaign loaded = io::read_campaign(fuzz::site() / (mapped ? "mapped.toml" : "campaign.toml"));
    io::read_model(fuzz::site() / "fitted.toml", loaded.campaign);
  });
  return 0;
}
