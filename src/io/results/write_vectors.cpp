#include "talus/io/results/write_vectors.hpp"

#include <array>
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

namespace {

/// A row of a layer of points that is being written.
struct PointRow {
  Fields& fields;
  const StopRow& stop;
  const MapPlace& place;
  const std::string& feature;  // name of the source's feature
};

struct PointColumn {
  const char* name;
  OGRFieldType type;
  void (*add)(const PointRow& row);
};

constexpr PointColumn kSource{"source", OFTInteger64, [](const PointRow& r) { r.fields.add(r.stop.source); }};
constexpr PointColumn kBlock{"block", OFTInteger64, [](const PointRow& r) { r.fields.add(r.stop.block); }};
constexpr PointColumn kEnd{"end", OFTString, [](const PointRow& r) { r.fields.add(name_of(r.stop.end)); }};
constexpr PointColumn kFeature{"feature", OFTString, [](const PointRow& r) { r.fields.add(r.feature.c_str()); }};
constexpr PointColumn kDiameter{"diameter_m", OFTReal,
                                [](const PointRow& r) { r.fields.add(decimals(r.stop.diameter, 1e4)); }};
constexpr PointColumn kMass{"mass_kg", OFTReal, [](const PointRow& r) { r.fields.add(decimals(r.stop.mass, 1e3)); }};
constexpr PointColumn kXRelease{"x_release", OFTReal,
                                [](const PointRow& r) { r.fields.add(decimals(r.place.x(r.stop.x_release), 1e3)); }};
constexpr PointColumn kYRelease{"y_release", OFTReal,
                                [](const PointRow& r) { r.fields.add(decimals(r.place.y(r.stop.y_release), 1e3)); }};
constexpr PointColumn kZ{"z", OFTReal, [](const PointRow& r) { r.fields.add(r.stop.z); }};
constexpr PointColumn kSeconds{"seconds", OFTReal,
                               [](const PointRow& r) { r.fields.add(decimals(r.stop.seconds, 1e3)); }};
constexpr PointColumn kMaxSpeed{"max_speed_ms", OFTReal,
                                [](const PointRow& r) { r.fields.add(decimals(r.stop.max_speed, 1e3)); }};
constexpr PointColumn kLength{"length_m", OFTReal,
                              [](const PointRow& r) { r.fields.add(decimals(r.stop.length, 1e3)); }};
constexpr PointColumn kImpacts{"impacts", OFTInteger64, [](const PointRow& r) { r.fields.add(r.stop.impacts); }};
constexpr PointColumn kEnergyLine{"energy_line_deg", OFTReal, [](const PointRow& r) {
                                    r.fields.add_or_null(decimals(r.stop.energy_line * 180.0 / kPi, 1e3));
                                  }};
constexpr PointColumn kSpeed{"speed_ms", OFTReal,
                             [](const PointRow& r) { r.fields.add(decimals(r.stop.end_speed, 1e3)); }};
constexpr PointColumn kEndEnergy{"energy_kj", OFTReal, [](const PointRow& r) {
                                   r.fields.add(decimals(kinetic_energy_kj(r.stop.mass, r.stop.end_speed), 1e3));
                                 }};

constexpr std::array kStopColumns{kSource,   kBlock, kEnd,     kFeature,  kDiameter, kMass,    kXRelease,
                                  kYRelease, kZ,     kSeconds, kMaxSpeed, kLength,   kImpacts, kEnergyLine};
constexpr std::array kExitColumns{kSource, kBlock, kFeature, kDiameter, kMass, kZ, kSeconds, kSpeed, kEndEnergy};

}  // namespace

struct PointsWriter::State {
  State(const std::filesystem::path& name, const LoadedScenario& loaded, std::span<const PointColumn> all,
        const char* layer_name)
      : file(new_layer_file(name, loaded.geo)),
        scenario(loaded.scenario),
        place(loaded.geo, loaded.scenario.surface.grid()),
        names(feature_names(loaded.scenario)),
        columns(all) {
    std::vector<LayerFile::Column> described;
    for (const PointColumn& column : columns) described.push_back({column.name, column.type});
    layer = file->add_bulk_layer(layer_name, wkbPoint, described);
    feature.reset(OGRFeature::CreateFeature(layer->GetLayerDefn()));
    point = new OGRPoint(0.0, 0.0);
    feature->SetGeometryDirectly(point);
  }

  void append(const StopRow& row) {
    Fields fields(*feature);
    const PointRow written{fields, row, place, names[scenario.sources[row.source].feature]};
    for (const PointColumn& column : columns) column.add(written);
    point->setX(place.x(row.x));
    point->setY(place.y(row.y));
    file->append(layer, *feature);
  }

  std::unique_ptr<LayerFile> file;
  const Scenario& scenario;
  MapPlace place;
  std::vector<std::string> names;  // of the features
  std::span<const PointColumn> columns;
  OGRLayer* layer = nullptr;
  Feature feature;
  OGRPoint* point = nullptr;  // of `feature`
};

PointsWriter::PointsWriter(const std::filesystem::path& file, const LoadedScenario& loaded, Layer layer)
    : layer_(layer),
      state_(layer == Layer::Stops ? std::make_unique<State>(file, loaded, kStopColumns, "stops")
                                   : std::make_unique<State>(file, loaded, kExitColumns, "exits")) {}
PointsWriter::~PointsWriter() = default;

void PointsWriter::write(std::span<const StopRow> rows) {
  const GdalMessages messages;
  for (const StopRow& row : rows)
    if (layer_ == Layer::Stops || row.end == End::Left) state_->append(row);
}

void PointsWriter::finish() {
  const bool stops = layer_ == Layer::Stops;
  state_->file->set_style(stops ? "stops" : "exits", style_of(stops ? StyledLayer::Stops : StyledLayer::Exits));
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
  MapPlace place;
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
