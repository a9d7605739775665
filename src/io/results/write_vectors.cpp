#include "talus/io/results/write_vectors.hpp"

#include <cmath>

#include "io/gdal/layer_file.hpp"
#include "talus/io/results/vector_style.hpp"

namespace talus::io {
namespace {

double decimals(double value, double scale) {
  return std::round(value * scale) / scale;
}

/// Sets the attributes of a row one after the other, in the order of the columns.
class Fields {
 public:
  explicit Fields(OGRFeature& feature) : feature_(feature) {}
  void add(std::uint32_t value) { feature_.SetField(next_++, static_cast<GIntBig>(value)); }
  void add(double value) { feature_.SetField(next_++, value); }
  void add_or_null(double value) {
    std::isnan(value) ? feature_.SetFieldNull(next_) : feature_.SetField(next_, value);
    ++next_;
  }
  void add(const char* value) { feature_.SetField(next_++, value); }

 private:
  OGRFeature& feature_;
  int next_ = 0;
};

/// From metres in the grid to coordinates of the map.
struct Place {
  double west = 0.0, south = 0.0;
  Place(const GeoReference& geo, const Grid& grid) : west(geo.west), south(geo.north - grid.rows * geo.cell_y) {}
  double x(double local) const { return west + local; }
  double y(double local) const { return south + local; }
};

/// Name of each feature of the sources: its own, or its number (FID); of a scene made by code its index.
std::vector<std::string> feature_names(const Scenario& scenario) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scenario.features.size(); ++i)
    names.push_back(scenario.features[i].name.empty() ? std::to_string(i) : scenario.features[i].name);
  return names;
}

}  // namespace

const char* name_of(End end) {
  switch (end) {
    case End::Stopped:
      return "stopped";
    case End::Trapped:
      return "trapped";
    case End::Left:
      return "left";
    case End::Caught:
      return "caught";
    case End::Limit:
      return "limit";
  }
  return "";
}

const char* name_of(Event event) {
  switch (event) {
    case Event::Release:
      return "release";
    case Event::Impact:
      return "impact";
    case Event::Slide:
      return "slide";
    case Event::Takeoff:
      return "takeoff";
    case Event::Air:
      return "air";
    case Event::Barrier:
      return "barrier";
    case Event::Stem:
      return "stem";
    case Event::End:
      return "end";
  }
  return "";
}

struct StopsWriter::State {
  State(const std::filesystem::path& name, const LoadedScenario& loaded)
      : file(new_layer_file(name, loaded.geo)),
        scenario(loaded.scenario),
        place(loaded.geo, loaded.scenario.surface.grid()),
        names(feature_names(loaded.scenario)) {
    layer = file->add_bulk_layer("stops", wkbPoint,
                                 {{"source", OFTInteger64},
                                  {"block", OFTInteger64},
                                  {"end", OFTString},
                                  {"feature", OFTString},
                                  {"diameter_m", OFTReal},
                                  {"mass_kg", OFTReal},
                                  {"x_release", OFTReal},
                                  {"y_release", OFTReal},
                                  {"z", OFTReal},
                                  {"seconds", OFTReal},
                                  {"max_speed_ms", OFTReal},
                                  {"length_m", OFTReal},
                                  {"impacts", OFTInteger64},
                                  {"energy_line_deg", OFTReal}});
    feature.reset(OGRFeature::CreateFeature(layer->GetLayerDefn()));
    point = new OGRPoint(0.0, 0.0);
    feature->SetGeometryDirectly(point);
  }

  void append(const StopRow& row) {
    Fields fields(*feature);
    fields.add(row.source);
    fields.add(row.block);
    fields.add(name_of(row.end));
    fields.add(names[scenario.sources[row.source].feature].c_str());
    fields.add(decimals(row.diameter, 1e4));
    fields.add(decimals(row.mass, 1e3));
    fields.add(decimals(place.x(row.x_release), 1e3));
    fields.add(decimals(place.y(row.y_release), 1e3));
    fields.add(row.z);
    fields.add(decimals(row.seconds, 1e3));
    fields.add(decimals(row.max_speed, 1e3));
    fields.add(decimals(row.length, 1e3));
    fields.add(row.impacts);
    fields.add_or_null(decimals(row.energy_line * 180.0 / kPi, 1e3));
    point->setX(place.x(row.x));
    point->setY(place.y(row.y));
    file->append(layer, *feature);
  }

  std::unique_ptr<LayerFile> file;
  const Scenario& scenario;
  Place place;
  std::vector<std::string> names;  // of the features
  OGRLayer* layer = nullptr;
  Feature feature;
  OGRPoint* point = nullptr;  // of `feature`
};

StopsWriter::StopsWriter(const std::filesystem::path& file, const LoadedScenario& loaded)
    : state_(std::make_unique<State>(file, loaded)) {}
StopsWriter::~StopsWriter() = default;

void StopsWriter::write(std::span<const StopRow> rows) {
  const GdalMessages messages;
  for (const StopRow& row : rows) state_->append(row);
}

void StopsWriter::finish() {
  state_->file->set_style("stops", style_of(StyledLayer::Stops));
  state_->file->finish();
}

struct ExitsWriter::State {
  State(const std::filesystem::path& name, const LoadedScenario& loaded)
      : file(new_layer_file(name, loaded.geo)),
        scenario(loaded.scenario),
        place(loaded.geo, loaded.scenario.surface.grid()),
        names(feature_names(loaded.scenario)) {
    layer = file->add_bulk_layer("exits", wkbPoint,
                                 {{"source", OFTInteger64},
                                  {"block", OFTInteger64},
                                  {"feature", OFTString},
                                  {"diameter_m", OFTReal},
                                  {"mass_kg", OFTReal},
                                  {"z", OFTReal},
                                  {"seconds", OFTReal},
                                  {"speed_ms", OFTReal},
                                  {"energy_kj", OFTReal}});
    feature.reset(OGRFeature::CreateFeature(layer->GetLayerDefn()));
  }

  void append(const StopRow& row) {
    const double speed = row.end_speed;
    Fields fields(*feature);
    fields.add(row.source);
    fields.add(row.block);
    fields.add(names[scenario.sources[row.source].feature].c_str());
    fields.add(decimals(row.diameter, 1e4));
    fields.add(decimals(row.mass, 1e3));
    fields.add(row.z);
    fields.add(decimals(row.seconds, 1e3));
    fields.add(decimals(speed, 1e3));
    fields.add(decimals(kinetic_energy(row.mass, speed), 1e3));
    const OGRPoint point(place.x(row.x), place.y(row.y));
    feature->SetGeometry(&point);
    file->append(layer, *feature);
  }

  std::unique_ptr<LayerFile> file;
  const Scenario& scenario;
  Place place;
  std::vector<std::string> names;  // of the features
  OGRLayer* layer = nullptr;
  Feature feature;
};

ExitsWriter::ExitsWriter(const std::filesystem::path& file, const LoadedScenario& loaded)
    : state_(std::make_unique<State>(file, loaded)) {}
ExitsWriter::~ExitsWriter() = default;

void ExitsWriter::write(std::span<const StopRow> rows) {
  const GdalMessages messages;
  for (const StopRow& row : rows)
    if (row.end == End::Left) state_->append(row);
}

void ExitsWriter::finish() {
  state_->file->set_style("exits", style_of(StyledLayer::Exits));
  state_->file->finish();
}

struct TrajectoriesWriter::State {
  State(const std::filesystem::path& name, const GeoReference& geo, const Grid& grid)
      : file(new_layer_file(name, geo)), place(geo, grid) {
    layer = file->add_bulk_layer("trajectories", wkbLineStringZM,
                                 {{"source", OFTInteger64},
                                  {"block", OFTInteger64},
                                  {"end", OFTString},
                                  {"diameter_m", OFTReal},
                                  {"max_speed_ms", OFTReal},
                                  {"length_m", OFTReal},
                                  {"impacts", OFTInteger64}});
  }

  std::unique_ptr<LayerFile> file;
  Place place;
  OGRLayer* layer = nullptr;
  std::vector<double> x, y, z, m;
};

TrajectoriesWriter::TrajectoriesWriter(const std::filesystem::path& file, const GeoReference& geo, const Grid& grid)
    : state_(std::make_unique<State>(file, geo, grid)) {}
TrajectoriesWriter::~TrajectoriesWriter() = default;

void TrajectoriesWriter::write(const RecordedPath& path) {
  const GdalMessages messages;
  State& s = *state_;
  const Feature feature(OGRFeature::CreateFeature(s.layer->GetLayerDefn()));
  Fields fields(*feature);
  fields.add(path.stop.source);
  fields.add(path.stop.block);
  fields.add(name_of(path.stop.end));
  fields.add(decimals(path.stop.diameter, 1e4));
  fields.add(decimals(path.stop.max_speed, 1e3));
  fields.add(decimals(path.stop.length, 1e3));
  fields.add(path.stop.impacts);
  for (auto* list : {&s.x, &s.y, &s.z, &s.m}) list->clear();
  for (const PathPoint& point : path.points) {
    s.x.push_back(s.place.x(point.x));
    s.y.push_back(s.place.y(point.y));
    s.z.push_back(point.z);
    s.m.push_back(point.time);
  }
  auto line = std::make_unique<OGRLineString>();
  line->setPoints(static_cast<int>(s.x.size()), s.x.data(), s.y.data(), s.z.data(), s.m.data());
  feature->SetGeometryDirectly(line.release());
  s.file->append(s.layer, *feature);
}

void TrajectoriesWriter::write_vertices(const Path& path) {
  const GdalMessages messages;
  State& s = *state_;
  OGRLayer* layer = s.file->add_bulk_layer("vertices", wkbPointZM,
                                           {{"time_s", OFTReal},
                                            {"speed_ms", OFTReal},
                                            {"vx", OFTReal},
                                            {"vy", OFTReal},
                                            {"vz", OFTReal},
                                            {"wx", OFTReal},
                                            {"wy", OFTReal},
                                            {"wz", OFTReal},
                                            {"event", OFTString}});
  const Feature feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
  for (const Vertex& vertex : path.vertices) {
    const Motion& motion = vertex.motion;
    Fields fields(*feature);
    fields.add(motion.time);
    fields.add(motion.velocity.norm());
    for (const double value : motion.velocity) fields.add(value);
    for (const double value : motion.spin) fields.add(value);
    fields.add(vertex.event == Event::End ? name_of(path.end) : name_of(vertex.event));
    const OGRPoint point(s.place.x(motion.position.x()), s.place.y(motion.position.y()), motion.position.z(),
                         motion.time);
    feature->SetGeometry(&point);
    s.file->append(layer, *feature);
  }
}

void TrajectoriesWriter::finish() {
  state_->file->set_style("trajectories", style_of(StyledLayer::Trajectories));
  state_->file->finish();
}

}  // namespace talus::io
