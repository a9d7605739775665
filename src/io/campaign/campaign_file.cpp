#include "talus/io/campaign/campaign_file.hpp"

#include <algorithm>
#include <filesystem>

#include "campaign_checks.hpp"
#include "campaign_tables.hpp"
#include "deposit_tables.hpp"
#include "io/files/checksum.hpp"
#include "io/gdal/dataset.hpp"
#include "io/scenario/file_kind.hpp"
#include "io/scenario/ground_keys.hpp"
#include "io/scenario/named_file.hpp"
#include "io/scenario/surface_key.hpp"
#include "io/scenario/table_reader.hpp"
#include "talus/base/error.hpp"
#include "talus/base/input_faults.hpp"
#include "talus/base/text.hpp"
#include "talus/io/gdal/input_access.hpp"
#include "talus/io/gdal/lines.hpp"
#include "talus/io/gdal/zones.hpp"

namespace talus::io {
namespace {

using Kind = TomlValue::Kind;

/// Content of campaign.toml, before any other file is opened.
struct CampaignSpec {
  std::string name, crs, surface_from = "default";
  SurfaceKind surface = kDefaultSurface;
  NamedFile dem, zones, blocks, stops, passages, screens, samples;
  std::vector<std::string> zone_codes, zone_names;
  MeasurementError error;
  bool error_given = false;
  DepositSpec deposits;
};

class CampaignReader {
 public:
  explicit CampaignReader(const std::string& path) : path_(path), base_(std::filesystem::absolute(path).parent_path()) {
    allow_folder(base_.string());
  }

  CampaignSpec read(const std::optional<std::string>& surface) {
    const TomlValue root = read_toml(path_, path_);
    refuse_other_kind(root, path_, FileKind::Campaign);
    TableReader top(&root, "", path_, faults_);
    spec_.name = top.text("name").value_or(base_.filename().string());
    spec_.crs = top.text("crs").value_or("");
    use(read_surface(top), "campaign");
    if (surface) use(surface_of_flag(*surface, faults_), "flag --surface");
    for (const auto& [key, file] : {std::pair{"dem", &spec_.dem},
                                    {"zones", &spec_.zones},
                                    {"blocks", &spec_.blocks},
                                    {"stops", &spec_.stops},
                                    {"passages", &spec_.passages},
                                    {"screens", &spec_.screens},
                                    {"samples", &spec_.samples}})
      *file = file_there(top, key, base_);
    read_zone_names(top.table("zone_names"));
    read_error(top.table("measurement_error"));
    if (const TomlValue* value = top.find("deposits"); value != nullptr && value->kind != Kind::Table)
      top.fault("deposits", *value, "must be a table: [deposits] with file = \"deposits.csv\" in it");
    else
      spec_.deposits = read_deposit_spec(top.table("deposits"), base_);
    top.finish();
    check_deposits();
    for (const auto& [key, file] : {std::pair{"dem", &spec_.dem}, {"blocks", &spec_.blocks}})
      if (file->path.empty() && root.find(key) == nullptr && !(file == &spec_.blocks && spec_.deposits.given))
        faults_.push_back(
            path_ + ": has no " + key + ", must name the file: " + key + " = \"" +
            (file == &spec_.dem ? "dem.tif\"" : "blocks.csv\", or [deposits] where releases are not known"));
    if (!spec_.zones.path.empty() && spec_.zone_codes.empty())
      faults_.push_back(spec_.zones.where + ": must come with [zone_names], such as 1 = \"talus\"");
    if (root.find("zones") == nullptr && !spec_.zone_codes.empty())
      faults_.push_back(path_ + ": [zone_names] must come with the raster of the zones: zones = \"zones.tif\"");
    if (!faults_.empty()) throw InputFaults(faults_, faults_.size());
    return std::move(spec_);
  }

 private:
  /// Refuses what belongs to released blocks in a campaign of mapped ones.
  void check_deposits() {
    if (!spec_.deposits.given) return;
    for (const NamedFile* file : {&spec_.blocks, &spec_.stops, &spec_.passages, &spec_.screens, &spec_.samples})
      if (!file->path.empty())
        faults_.push_back(file->where +
                          ": must not stand beside [deposits]: blocks of known release and blocks mapped "
                          "where they lie are two campaigns, each with its campaign.toml");
  }

  void use(const std::optional<SurfaceKind>& kind, const char* from) {
    if (!kind) return;
    spec_.surface = *kind;
    spec_.surface_from = from;
  }

  void read_zone_names(TableReader table) {
    if (table.value() == nullptr) return;
    for (const auto& [code, value] : table.value()->members) {
      const auto name = table.text(code);
      if (!name) continue;
      if (const auto fault = fault_of_code(code))
        table.fault(code, value,
                    "the code '" + code + "' " + *fault + ": give the zone such a number, in the raster, too");
      else if (*name == "default")
        table.fault(code, value, "must be another name: default is what no zone covers");
      else if (std::count(spec_.zone_names.begin(), spec_.zone_names.end(), *name) > 0)
        table.fault(code, value, "is the name of two zones, must be of one");
      spec_.zone_codes.push_back(code);
      spec_.zone_names.push_back(*name);
    }
    constexpr std::size_t kMostZones = 255;  // as of [ground.zones]
    if (spec_.zone_names.size() > kMostZones)
      faults_.push_back(path_ + ": [zone_names] has " + std::to_string(spec_.zone_names.size()) +
                        " zones, must be at most " + std::to_string(kMostZones));
  }

  void read_error(TableReader table) {
    constexpr Bounds kMetres{"", "m", "standard deviation of the measurement", 0.0, 1000.0};
    constexpr Bounds kFraction{"", "1", "standard deviation relative to the value, such as 0.03", 0.0, 1.0};
    spec_.error_given = table.value() != nullptr;
    MeasurementError& e = spec_.error;
    e.position_m = table.number("position_m", kMetres).value_or(0.0);
    e.speed_fraction = table.number("speed_fraction", kFraction).value_or(0.0);
    e.jump_height_m = table.number("jump_height_m", kMetres).value_or(0.0);
    e.angular_velocity_fraction = table.number("angular_velocity_fraction", kFraction).value_or(0.0);
    table.finish();
  }

  std::string path_;
  std::filesystem::path base_;
  std::vector<std::string> faults_;
  CampaignSpec spec_;
};

/// Throws InputError if the coordinates of the tables are not in the system of the DEM.
void check_crs(const std::string& path, const std::string& given, const Terrain& terrain) {
  if (given.empty()) return;
  GdalMessages messages;
  OGRSpatialReference system;
  const char* const no_file[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
  if (system.SetFromUserInput(given.c_str(), no_file) != OGRERR_NONE)
    throw InputError(path + ": crs = '" + given + "': is no coordinate system, must be one like \"EPSG:2056\"");
  if (!same_plane_system(wkt_of(&system), terrain.geo.crs_wkt))
    throw InputError(path + ": crs = '" + given + "': must be the system of the DEM, " + crs_name(terrain.geo.crs_wkt) +
                     ": transform the coordinates of the tables into it");
}

template <class Part>
void take_warnings(LoadedCampaign& out, const Part& part) {
  out.warnings.insert(out.warnings.end(), part.warnings.begin(), part.warnings.end());
}

}  // namespace

LoadedCampaign read_campaign(const std::string& path, const std::optional<std::string>& surface) {
  const CampaignSpec spec = CampaignReader(path).read(surface);
  LoadedCampaign out;
  Campaign& campaign = out.campaign;
  campaign.name = spec.name;
  campaign.error = spec.error;
  Terrain terrain = read_terrain(spec.dem.path);
  check_crs(path, spec.crs, terrain);
  take_warnings(out, terrain);
  out.geo = terrain.geo;
  campaign.zone_names = {"default"};
  out.zone_codes = {""};
  if (!spec.zones.path.empty()) {
    ZoneLayer zones = read_zones({.path = spec.zones.path,
                                  .field = "",
                                  .names = spec.zone_names,
                                  .codes = spec.zone_codes,
                                  .table = "zone_names"},
                                 terrain);
    campaign.zones = std::move(zones.zones);
    campaign.zone_names.insert(campaign.zone_names.end(), spec.zone_names.begin(), spec.zone_names.end());
    out.zone_codes.insert(out.zone_codes.end(), spec.zone_codes.begin(), spec.zone_codes.end());
    take_warnings(out, zones);
  }
  if (!spec.screens.path.empty()) {
    ScreenLayer screens = read_screens(spec.screens.path, terrain);
    campaign.screens = std::move(screens.screens);
    std::ranges::sort(campaign.screens, {}, &Screen::id);  // the order in the file changes nothing
    take_warnings(out, screens);
  }
  campaign.surface = Surface(spec.deposits.given ? terrain.heights : std::move(terrain.heights), spec.surface);
  out.surface_from = spec.surface_from;
  if (spec.deposits.given)
    read_deposits(spec.deposits, terrain, campaign, out.warnings);
  else
    read_tables({spec.blocks.path, spec.stops.path, spec.passages.path, spec.samples.path}, campaign, out.warnings);
  warn_of_errors(path, campaign, out.warnings);
  if (!spec.error_given)
    out.warnings.push_back(path +
                           ": has no [measurement_error]: all that was measured counts as exact; give the standard "
                           "deviations of it, such as position_m = 0.3");
  const std::pair<const char*, std::string> files[] = {
      {"campaign", std::filesystem::absolute(path).lexically_normal().string()},
      {"dem", spec.dem.path},
      {"zones", spec.zones.path},
      {"blocks", spec.blocks.path},
      {"stops", spec.stops.path},
      {"passages", spec.passages.path},
      {"screens", spec.screens.path},
      {"samples", spec.samples.path},
      {"deposits", spec.deposits.table.path},
      {"sources", spec.deposits.sources.path},
      {"mapped", spec.deposits.mapped.path}};
  for (const auto& [role, file] : files)
    if (!file.empty()) out.inputs.push_back(recorded_input(role, file));
  return out;
}

}  // namespace talus::io
