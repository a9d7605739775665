#include "talus/io/results/write_profile.hpp"

#include <array>
#include <cmath>

#include "io/gdal/geopackage.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/results/vector_style.hpp"
#include "talus/io/results/write_vectors.hpp"

namespace talus::io {
namespace {

double rounded(double value, double scale) {
  return std::round(value * scale) / scale;
}

/// A number of a stop: its name in files, and how many decimals it has.
struct StopColumn {
  const char* name;
  double scale;
  double (*get)(const StopRow&, const LoadedProfile&);
};

constexpr std::array<StopColumn, 9> kStops{{
    {"x", 1e3, [](const StopRow& r, const LoadedProfile& p) { return p.loaded.geo.west + r.x; }},
    {"z", 1e3, [](const StopRow& r, const LoadedProfile& p) { return p.datum + r.z; }},
    {"runout_m", 1e3, [](const StopRow& r, const LoadedProfile&) { return std::abs(r.x - r.x_release); }},
    {"diameter_m", 1e4, [](const StopRow& r, const LoadedProfile&) { return double{r.diameter}; }},
    {"mass_kg", 1e3, [](const StopRow& r, const LoadedProfile&) { return double{r.mass}; }},
    {"seconds", 1e3, [](const StopRow& r, const LoadedProfile&) { return double{r.seconds}; }},
    {"max_speed_ms", 1e3, [](const StopRow& r, const LoadedProfile&) { return double{r.max_speed}; }},
    {"length_m", 1e3, [](const StopRow& r, const LoadedProfile&) { return double{r.length}; }},
    {"impacts", 1.0, [](const StopRow& r, const LoadedProfile&) { return static_cast<double>(r.impacts); }},
}};

/// A number of a bin, with its name in envelope.csv and in the layer `bins`.
struct Named {
  std::string name;
  double value;
};

std::vector<Named> numbers_of(const ProfileBin& bin, double start, std::uint64_t released) {
  std::vector<Named> out{{"x_from", start + bin.from},
                         {"x_to", start + bin.to},
                         {"passages", static_cast<double>(bin.speed.count)},
                         {"share", static_cast<double>(bin.speed.count) / static_cast<double>(released)}};
  const auto add = [&out](const std::string& name, const BinDistribution& d) {
    for (const auto& [statistic, value] :
         {std::pair{"mean", d.mean}, {"p50", d.p50}, {"p95", d.p95}, {"p99", d.p99}, {"max", d.max}})
      out.push_back({name + "_" + statistic, value});
  };
  add("speed_ms", bin.speed);
  add("energy_kj", bin.energy);
  add("jump_height_m", bin.height);
  for (Named& number : out) number.value = rounded(number.value, 1e6);
  return out;
}

std::string envelope_csv(const std::vector<ProfileBin>& bins, double start, std::uint64_t released) {
  std::string text;
  for (const ProfileBin& bin : bins) {
    const std::vector<Named> numbers = numbers_of(bin, start, released);
    if (text.empty())
      for (const Named& number : numbers) text += number.name + (&number == &numbers.back() ? "\n" : ",");
    for (const Named& number : numbers)  // empty for a bin that nothing crosses
      text += (std::isfinite(number.value) ? text_of(number.value) : "") + (&number == &numbers.back() ? "\n" : ",");
  }
  return text;
}

std::string runout_csv(const Runout& runout, double width) {
  std::string text = "distance_from,distance_to,stopped,share,share_beyond\n";
  std::uint64_t so_far = 0;
  const auto released = static_cast<double>(runout.released);
  for (std::size_t i = 0; i < runout.stops.size(); ++i) {
    so_far += runout.stops[i];
    const double from = width * static_cast<double>(i);
    text += text_of(rounded(from, 1e6)) + "," + text_of(rounded(from + width, 1e6)) + "," +
            std::to_string(runout.stops[i]) + "," + text_of(static_cast<double>(runout.stops[i]) / released) + "," +
            text_of(static_cast<double>(runout.released - so_far) / released) + "\n";
  }
  return text;
}

}  // namespace

struct ProfileWriter::State {
  State(std::filesystem::path where, const LoadedProfile& p)
      : folder(std::move(where)), profile(p), file(folder / "profile.gpkg", p.map) {
    stops_csv = "source,block,end";
    std::vector<GeoPackage::Column> columns{{"source", OFTInteger64}, {"block", OFTInteger64}, {"end", OFTString}};
    for (const StopColumn& column : kStops) {
      stops_csv += std::string(",") + column.name;
      columns.push_back({column.name, OFTReal});
    }
    stops_csv += "\n";
    ground = file.add_layer("profile", wkbLineString25D, {});
    stops = file.add_layer("stops", wkbPoint25D, columns);
    if (!p.loaded.scenario.screens.empty())
      crossings = file.add_layer("crossings", wkbPoint25D,
                                 {{"source", OFTInteger64},
                                  {"block", OFTInteger64},
                                  {"screen", OFTString},
                                  {"speed_ms", OFTReal},
                                  {"energy_kj", OFTReal},
                                  {"jump_height_m", OFTReal},
                                  {"angular_velocity_rads", OFTReal}});
    if (p.loaded.scenario.output.paths > 0)
      paths = file.add_layer("trajectories", wkbLineStringZM,
                             {{"source", OFTInteger64}, {"block", OFTInteger64}, {"end", OFTString}});
    write_line(ground, p.profile.from(), p.profile.to(), [](OGRFeature&) {});
  }

  double x_of(double local) const { return profile.loaded.geo.west + local; }

  OGRPoint point(double x, double z) const {
    const Eigen::Vector2d place = profile.place(x - (profile.plan.empty() ? 0.0 : profile.profile.from()), z);
    return {place.x(), place.y(), z};
  }

  /// A piece of the ground between two places.
  template <class Describe>
  void write_line(OGRLayer* layer, double from, double to, Describe describe) {
    OGRLineString line;
    const auto add = [&](double x, double z) {
      const OGRPoint at = point(x, z);
      line.addPoint(&at);
    };
    add(from, profile.profile.height(from));
    for (const Eigen::Vector2d& node : profile.profile.nodes)
      if (node.x() > from && node.x() < to) add(node.x(), node.y());
    add(to, profile.profile.height(to));
    const Feature feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
    feature->SetGeometry(&line);
    describe(*feature);
    file.append(layer, *feature);
  }

  std::filesystem::path folder;
  const LoadedProfile& profile;
  GeoPackage file;
  OGRLayer *ground = nullptr, *stops = nullptr, *crossings = nullptr, *paths = nullptr;
  std::string stops_csv;
};

ProfileWriter::ProfileWriter(const std::filesystem::path& folder, const LoadedProfile& profile)
    : state_(std::make_unique<State>(folder, profile)) {}
ProfileWriter::~ProfileWriter() = default;

void ProfileWriter::write(std::span<const StopRow> rows) {
  const GdalMessages messages;
  State& s = *state_;
  const Feature feature(OGRFeature::CreateFeature(s.stops->GetLayerDefn()));
  for (const StopRow& row : rows) {
    s.stops_csv += std::to_string(row.source) + "," + std::to_string(row.block) + "," + name_of(row.end);
    feature->SetField(0, static_cast<GIntBig>(row.source));
    feature->SetField(1, static_cast<GIntBig>(row.block));
    feature->SetField(2, name_of(row.end));
    int next = 3;
    for (const StopColumn& column : kStops) {
      const double value = rounded(column.get(row, s.profile), column.scale);
      s.stops_csv += "," + text_of(value);
      feature->SetField(next++, value);
    }
    s.stops_csv += "\n";
    const OGRPoint point = s.point(s.x_of(row.x), s.profile.datum + row.z);
    feature->SetGeometry(&point);
    s.file.append(s.stops, *feature);
  }
}

void ProfileWriter::write(std::span<const Crossing> rows) {
  const GdalMessages messages;
  State& s = *state_;
  const Feature feature(OGRFeature::CreateFeature(s.crossings->GetLayerDefn()));
  for (const Crossing& c : rows) {
    feature->SetField(0, static_cast<GIntBig>(c.source));
    feature->SetField(1, static_cast<GIntBig>(c.block));
    feature->SetField(2, s.profile.loaded.scenario.screens[c.screen].id.c_str());
    feature->SetField(3, rounded(c.speed, 1e3));
    feature->SetField(4, rounded(kinetic_energy_kj(c.mass, c.speed), 1e3));
    feature->SetField(5, rounded(c.height, 1e3));
    feature->SetField(6, rounded(c.spin, 1e3));
    const double x = s.x_of(c.x);
    const OGRPoint point = s.point(x, s.profile.profile.height(x) + c.height);
    feature->SetGeometry(&point);
    s.file.append(s.crossings, *feature);
  }
}

void ProfileWriter::write(const RecordedPath& path) {
  const GdalMessages messages;
  State& s = *state_;
  const Feature feature(OGRFeature::CreateFeature(s.paths->GetLayerDefn()));
  feature->SetField(0, static_cast<GIntBig>(path.stop.source));
  feature->SetField(1, static_cast<GIntBig>(path.stop.block));
  feature->SetField(2, name_of(path.stop.end));
  OGRLineString line;
  for (const PathPoint& p : path.points) {
    OGRPoint point = s.point(s.x_of(p.x), s.profile.datum + p.z);
    point.setM(p.time);
    line.addPoint(&point);
  }
  feature->SetGeometry(&line);
  s.file.append(s.paths, *feature);
}

void ProfileWriter::finish(const ProfileResults& results) {
  const GdalMessages messages;
  State& s = *state_;
  const Profile& profile = s.profile.profile;
  const std::uint64_t released = results.runout.released;
  std::vector<Named> numbers = numbers_of({}, 0.0, 1);
  std::vector<GeoPackage::Column> columns;
  for (const Named& number : numbers) columns.push_back({number.name.c_str(), OFTReal});
  OGRLayer* layer = s.file.add_layer("bins", wkbLineString25D, columns);
  for (const ProfileBin& bin : results.bins)
    s.write_line(layer, profile.from() + bin.from, std::min(profile.from() + bin.to, profile.to()),
                 [&](OGRFeature& feature) {
                   int next = 0;
                   for (const Named& number : numbers_of(bin, profile.from(), released)) {
                     if (std::isfinite(number.value)) feature.SetField(next, number.value);
                     ++next;
                   }
                 });
  s.file.set_style("bins", style_of(StyledLayer::Bins));
  s.file.set_style("stops", style_of(StyledLayer::Stops));
  if (s.crossings != nullptr) s.file.set_style("crossings", style_of(StyledLayer::Crossings));
  s.file.set_style("profile", outline_style(1));
  if (s.paths != nullptr) s.file.set_style("trajectories", outline_style(1));
  s.file.finish();
  write_text(s.folder / "stops.csv", s.stops_csv);
  write_text(s.folder / "envelope.csv", envelope_csv(results.bins, profile.from(), released));
  write_text(s.folder / "runout.csv", runout_csv(results.runout, s.profile.bin));
}

}  // namespace talus::io
