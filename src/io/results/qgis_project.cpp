#include "talus/io/results/qgis_project.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>

#include "io/files/json.hpp"
#include "io/files/own_files.hpp"
#include "io/gdal/dataset.hpp"
#include "io/gdal/geopackage.hpp"
#include "io/gdal/regular_file.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/gdal/layer_name.hpp"
#include "talus/io/results/style.hpp"
#include "talus/io/results/vector_style.hpp"
#include "talus/products/comparison.hpp"
#include "talus/products/energy_words.hpp"
#include "talus/products/raster_table.hpp"
#include "xml.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostStyle = std::size_t{1} << 20U;  // bytes

enum class Source { Map, Layer, Table };

/// A layer of the project.
struct Shown {
  std::string id, title, source;
  Source kind = Source::Map;
  bool checked = false;
  bool mark = false;  // drawn over a map
  std::string wkt{};  // of a layer in a system of its own
  XmlTree style{nullptr, CPLDestroyXMLNode};
};

Source kind_of(const std::string& file) {
  return file.ends_with(".tif") ? Source::Map : file.ends_with(".csv") ? Source::Table : Source::Layer;
}

/// A text with what stands for "<n>" or "<id>".
std::string filled(std::string text, const std::string& blank, const std::string& word) {
  if (const std::size_t at = text.find(blank); !blank.empty() && at != std::string::npos)
    text.replace(at, blank.size(), word);
  return text;
}

/// The title of a file, if it is that of an entry of `project_layers`.
std::optional<std::string> title_of(std::string name, const ProjectLayer& layer) {
  if (name.ends_with(".fgb")) name = name.substr(0, name.size() - 4) + ".gpkg";
  const std::size_t at = layer.file.find('<');
  if (at == std::string::npos) return name == layer.file ? std::optional(layer.title) : std::nullopt;
  const std::size_t close = layer.file.find('>') + 1, fixed = layer.file.size() - (close - at);
  if (name.size() <= fixed || !name.starts_with(layer.file.substr(0, at)) || !name.ends_with(layer.file.substr(close)))
    return std::nullopt;
  const std::string blank = layer.file.substr(at, close - at), word = name.substr(at, name.size() - fixed);
  if (blank == "<n>" && word.find_first_not_of("0123456789.e+-") != std::string::npos) return std::nullopt;
  return filled(layer.title, blank, word);
}

/// The style that a GeoPackage holds for a layer; empty if there is none.
std::string style_in(const fs::path& file, const std::string& layer) {
  try {
    const Dataset dataset = open_dataset(file.string(), GDAL_OF_VECTOR);
    OGRLayer* styles = dataset->GetLayerByName(kStylesTable);
    if (styles == nullptr) return {};
    while (const Feature row{styles->GetNextFeature()})
      if (row->GetFieldIndex("styleQML") >= 0 && row->GetFieldIndex("f_table_name") >= 0 &&
          layer == row->GetFieldAsString("f_table_name"))
        return row->GetFieldAsString("styleQML");
  } catch (const InputError&) {  // a file that someone has replaced: its layer is shown without a style
  }
  return {};
}

/// Whether a layer holds lines beside areas.
bool has_lines_beside_areas(const fs::path& file, const std::string& layer) {
  bool lines = false, areas = false;
  try {
    const Dataset dataset = open_dataset(file.string(), GDAL_OF_VECTOR);
    OGRLayer* features = dataset->GetLayerByName(layer.c_str());
    while (features != nullptr) {
      const Feature feature(features->GetNextFeature());
      if (!feature) break;
      const OGRGeometry* geometry = feature->GetGeometryRef();
      lines = lines || (geometry != nullptr && geometry->getDimension() == 1);
      areas = areas || (geometry != nullptr && geometry->getDimension() == 2);
    }
  } catch (const InputError&) {  // as in style_in
  }
  return lines && areas;
}

/// The id of a layer. None is the beginning of another one: QGIS 3.22 looks layers up by the beginning of their id when
/// it takes them out of its lists, and falls over the one that stays there.
std::string id_of(const std::string& name, Source kind) {
  return name + (kind == Source::Map ? "_talus_map" : kind == Source::Table ? "_talus_table" : "_talus_layer");
}

/// Takes the lines out of a layer of objects of both kinds: QGIS draws one kind of geometry per layer.
Shown lines_of(Shown& objects) {
  Shown lines;
  lines.id = id_of("objects_lines", Source::Layer);
  lines.title = objects.title + " (lines)";
  lines.source = objects.source + "|geometrytype=LineString";
  lines.kind = Source::Layer;
  lines.checked = objects.checked;
  lines.style = parsed_xml(style_of(StyledLayer::LineObjects));
  objects.source += "|geometrytype=Polygon";
  return lines;
}

std::string style_of_file(const fs::path& file) {
  try {
    return read_file(file.string(), file.string(), "a style of QGIS", kMostStyle);
  } catch (const InputError&) {
    return {};
  }
}

/// Whether a result is one of `talus barrier`, whose record beside it tells it from a file of the user.
bool is_of_design(const ProjectLayer& layer) {
  return layer.file.starts_with("barrier_");
}

/// The title of the files of a design: with the id of its line, which the record has as the user has given it, not with
/// what stands for it in the name of the files.
std::string title_of_design(const fs::path& record, const ProjectLayer& layer, std::string by_name) {
  try {
    return filled(layer.title, "<id>", read_record(record).at("screen").get<std::string>());
  } catch (const std::exception&) {  // as in style_in
    return by_name;
  }
}

/// The files of an entry that are there, by their titles, and these.
std::vector<std::pair<std::string, std::string>> titles_of(const std::vector<std::string>& files,
                                                           const fs::path& folder, const ProjectLayer& layer) {
  std::vector<std::pair<std::string, std::string>> found;
  if (!layer.style.empty() && std::ranges::find(files, layer.style) == files.end()) return found;
  for (const std::string& name : files) {
    auto title = title_of(name, layer);
    if (!title) continue;
    if (is_of_design(layer)) {
      const std::string record = fs::path(name).stem().string() + ".json";
      if (std::ranges::find(files, record) == files.end()) continue;
      title = title_of_design(folder / record, layer, *title);
    }
    found.emplace_back(*title, name);
  }
  std::ranges::sort(found, [](const auto& a, const auto& b) {  // more than 30 kJ before more than 300 kJ
    return a.first.size() != b.first.size() ? a.first.size() < b.first.size() : a < b;
  });
  return found;
}

/// A title with what the settings of the run say: the lowest threshold, and which energy counts.
std::string title_in_run(std::string title, const ProjectLayer& layer, const std::vector<Setting>& settings) {
  std::string threshold = "the lowest threshold";  // of a run whose record lacks it
  for (const Setting& setting : settings) {
    if (setting.key == layer.thresholds) {
      const Json values = Json::parse(setting.value, nullptr, false);  // "[30, 300]", in ascending order
      if (values.is_array() && !values.empty()) threshold = text_of(values.front().get<double>()) + " " + setting.unit;
    }
    if (setting.key == "output.count_rotation" && layer.counts_energy)
      title += ", " + energy_words(setting.value == "true").name;
  }
  return filled(std::move(title), "<threshold>", threshold);
}

/// The layers that are there, from the top to the bottom.
std::vector<Shown> shown_layers(const std::vector<std::string>& files, const fs::path& folder,
                                const std::vector<Setting>& settings) {
  std::vector<Shown> shown;
  for (const ProjectLayer& layer : project_layers())
    for (const auto& [title, name] : titles_of(files, folder, layer)) {
      const bool mark = !layer.style.empty();
      const fs::path style = mark ? fs::path(layer.style) : fs::path(name).replace_extension(".qml");
      const std::string stem = (mark ? style : fs::path(name)).stem().string();
      Shown one{id_of(stem, kind_of(layer.file)),
                title_in_run(title, layer, settings),
                "./" + name,
                kind_of(layer.file),
                layer.shown,
                mark};
      if (name.ends_with(".gpkg")) {
        one.source += "|layername=" + stem;
        one.style = parsed_xml(style_in(folder / name, stem));
      } else if (one.kind == Source::Table) {
        one.source += "|option:AUTODETECT_TYPE=YES";
      } else {
        one.style = parsed_xml(style_of_file(folder / style));
      }
      if (stem == "objects" && has_lines_beside_areas(folder / name, stem)) shown.push_back(lines_of(one));
      shown.push_back(std::move(one));
    }
  return shown;
}

/// Leaves one map on, with the marks over it: the hazard class, which is the first.
void check_one_map(std::vector<Shown>& shown) {
  bool found = false;
  for (Shown& one : shown) {
    if (one.kind != Source::Map || one.mark) continue;
    one.checked = one.checked && !found;
    found = found || one.checked;
  }
}

/// The kind of geometry that all features have: 0 points, 1 lines, 2 areas; -1 if there are several, or none.
int dimension_of(OGRLayer& layer) {
  int found = -1;
  for (const auto& feature : layer) {
    const OGRGeometry* geometry = feature->GetGeometryRef();
    if (geometry == nullptr) continue;
    if (found >= 0 && geometry->getDimension() != found) return -1;
    found = geometry->getDimension();
  }
  return found;
}

/// The way from a project to a file, as a source of a layer. Without links on the way, as `project`: then it is the
/// same from every path that leads to the project.
std::string way_from(const fs::path& project, const fs::path& file) {
  std::error_code none;
  const fs::path folder = fs::weakly_canonical(file.parent_path(), none);
  const std::string way = (folder / file.filename()).lexically_relative(project).string();
  return way.starts_with("..") ? way : "./" + way;
}

/// The only layer of a file with geometry, or that of a name; null if there is none.
OGRLayer* layer_in(GDALDataset& file, const std::string& name) {
  if (!name.empty()) return file.GetLayerByName(name.c_str());
  OGRLayer* found = nullptr;
  for (OGRLayer* layer : file.GetLayers()) {
    if (layer->GetGeomType() == wkbNone) continue;
    if (found != nullptr) return nullptr;
    found = layer;
  }
  return found;
}

/// An input of the run as an outline; nothing of what is no layer of a plain file with one kind of geometry.
std::optional<Shown> outline_of(const InputFile& input, const std::string& title, const fs::path& project) {
  const NamedLayer named = named_layer(input.path);
  std::error_code none;
  if (named.number >= 0 || !named.unread.empty() || !fs::is_regular_file(named.file, none)) return std::nullopt;
  try {
    const Dataset file = open_dataset(named.file, GDAL_OF_VECTOR);
    OGRLayer* layer = layer_in(*file, named.layer);
    if (layer == nullptr) return std::nullopt;
    const int dimension = dimension_of(*layer);
    if (dimension < 0) return std::nullopt;
    Shown shown{id_of("run_" + input.role, Source::Layer), title, way_from(project, named.file), Source::Layer, true};
    if (!named.layer.empty()) shown.source += "|layername=" + named.layer;
    shown.wkt = wkt_of(layer->GetSpatialRef());
    shown.style = parsed_xml(outline_style(dimension));
    return shown;
  } catch (const InputError&) {  // as in style_in
    return std::nullopt;
  }
}

/// Puts the barriers and the sources of the run above the maps.
void add_inputs(std::vector<Shown>& shown, const ProjectGround& ground, const fs::path& project) {
  auto place = std::ranges::find(shown, Source::Map, &Shown::kind);
  for (const auto& [role, title] : {std::pair{"barriers", "Barriers of the run"}, {"sources", "Sources of the run"}})
    for (const InputFile& input : ground.inputs)
      if (auto outline = input.role == role ? outline_of(input, title, project) : std::nullopt)
        place = shown.insert(place, std::move(*outline)) + 1;
}

/// A layer that QGIS shades: the DEM itself, with light from the north-west and from the sides. The provider resamples:
/// of what the renderer resamples QGIS draws a bright line where it joins two parts.
std::optional<Shown> hillshade_of(const fs::path& dem, const fs::path& project) {
  std::error_code none;
  if (!dem.is_absolute() || !fs::is_regular_file(dem, none)) return std::nullopt;
  Shown shown;
  shown.id = "talus_hillshade";
  shown.title = "Hillshade of the DEM";
  shown.checked = true;
  shown.source = way_from(project, dem);
  shown.style = parsed_xml(
      "<qgis><pipe><rasterrenderer type=\"hillshade\" band=\"1\" azimuth=\"315\" angle=\"45\" zfactor=\"1\" "
      "multidirection=\"1\" opacity=\"1\" alphaBand=\"-1\" nodataColor=\"\"/><provider><resampling enabled=\"true\" "
      "maxOversampling=\"2\" zoomedInResamplingMethod=\"bilinear\"/></provider><resamplingStage>provider"
      "</resamplingStage></pipe><blendMode>0</blendMode></qgis>");
  return shown;
}

void add_system(const Element& parent, const char* name, const std::string& wkt) {
  if (wkt.empty()) return;
  parent.add(name).add("spatialrefsys").add("wkt", wkt);
}

/// The root element of a style.
const CPLXMLNode* style_root(const Shown& shown) {
  return shown.style ? CPLGetXMLNode(shown.style.get(), "=qgis") : nullptr;
}

void add_map_layer(const Element& parent, const Shown& shown, const std::string& wkt) {
  const Element layer = parent.add("maplayer");
  layer.set("type", shown.kind == Source::Map ? "raster" : "vector").set("autoRefreshEnabled", "0");
  layer.add("id", shown.id);
  layer.add("datasource", shown.source);
  layer.add("layername", shown.title);
  if (shown.kind != Source::Table) add_system(layer, "srs", shown.wkt.empty() ? wkt : shown.wkt);
  layer.add("provider", shown.kind == Source::Map ? "gdal" : "ogr");
  if (const CPLXMLNode* root = style_root(shown)) layer.add_children_of(*root);
}

void add_tree(const Element& root, const std::vector<Shown>& shown, const std::string& title) {
  const Element group = root.add("layer-tree-group").add("layer-tree-group");
  group.set("name", title).set("checked", "Qt::Checked").set("expanded", "1");
  for (const Shown& one : shown) {
    const Element layer = group.add("layer-tree-layer");
    layer.set("id", one.id).set("name", one.title).set("source", one.source);
    layer.set("providerKey", one.kind == Source::Map ? "gdal" : "ogr");
    layer.set("checked", one.checked ? "Qt::Checked" : "Qt::Unchecked");
    layer.set("expanded", one.checked && one.id != "talus_hillshade" ? "1" : "0");
  }
}

void add_property(const Element& group, const char* name, const char* type, const char* value) {
  const Element property = group.add(name);
  property.set("type", type);
  property.text(value);
}

/// The view that the project opens with: the whole map.
void add_view(const Element& root, const ProjectGround& ground) {
  const Element canvas = root.add("mapcanvas");
  canvas.set("name", "theMapCanvas").set("annotationsVisible", "1");
  const GeoReference& geo = ground.geo;
  canvas.add("units", "meters");
  const Element extent = canvas.add("extent");
  extent.add("xmin", text_of(geo.west));
  extent.add("ymin", text_of(geo.north - ground.rows * geo.cell_y));
  extent.add("xmax", text_of(geo.west + ground.columns * geo.cell_x));
  extent.add("ymax", text_of(geo.north));
  canvas.add("rotation", "0");
  add_system(canvas, "destinationsrs", geo.crs_wkt);
}

/// The entries of the rasters of a comparison, of an entry of a raster of runs. A change has no marks.
void add_compared(const ProjectLayer& layer, std::vector<ProjectLayer>& to) {
  if (!layer.file.ends_with(".tif")) return;
  const auto raster = compared_raster(filled(fs::path(layer.file).stem().string(), "<n>", "1"));
  if (!raster) return;
  const auto add = [&](const char* begin, const char* title, bool shown) {
    ProjectLayer& made = to.emplace_back(layer);
    made.file.insert(0, begin);
    made.title.insert(0, title);
    made.shown = shown;
    if (!made.style.empty()) made.style.insert(0, begin);
  };
  raster->lower_is_worse ? add("lowest_", "Lowest: ", layer.shown) : add("highest_", "Highest: ", layer.shown);
  if (layer.style.empty()) add("change_", "Change: ", false);
}

/// Adds the rasters of a run that have no title here: their names are their titles; after them those of comparisons.
std::vector<ProjectLayer> with_further_rasters(std::vector<ProjectLayer> layers) {
  for (const RunRaster& raster : run_rasters()) {
    const std::string file = raster.map.name + ".tif";
    if (std::ranges::find(layers, file, &ProjectLayer::file) == layers.end()) layers.push_back({file, raster.map.name});
  }
  std::vector<ProjectLayer> compared;
  for (const ProjectLayer& layer : layers) add_compared(layer, compared);
  layers.insert(layers.end(), compared.begin(), compared.end());
  return layers;
}

fs::path dem_of(const std::vector<InputFile>& inputs) {
  const auto dem = std::ranges::find(inputs, "dem", &InputFile::role);
  return dem == inputs.end() ? "" : dem->path;
}

/// The ground of a finished run, from its record.
ProjectGround ground_of(const Json& run) {
  const Json& grid = run.at("grid");
  ProjectGround ground;
  ground.geo = {grid.at("crs_wkt"), grid.at("west"), grid.at("north"), grid.at("cell_x_m"), grid.at("cell_y_m")};
  ground.columns = static_cast<int>(whole_number(grid.at("columns"), 1, 1 << 30));
  ground.rows = static_cast<int>(whole_number(grid.at("rows"), 1, 1 << 30));
  for (const Json& input : run.at("inputs"))
    ground.inputs.push_back({input.at("role"), input.at("path"), input.value("sha256", "")});
  ground.dem = dem_of(ground.inputs);
  for (const Json& setting : run.value("settings", Json::array()))
    if (setting.at("value").is_string())
      ground.settings.push_back({setting.at("key"), setting.at("value"), setting.value("unit", ""), ""});
  return ground;
}

}  // namespace

const std::vector<ProjectLayer>& project_layers() {
  static const std::vector<ProjectLayer> layers = with_further_rasters({
      {"barrier_<id>.gpkg", "Barrier at <id>: MEL by stretch", true},
      {"barrier_<id>.csv", "Barrier at <id>: design values"},
      {"objects.gpkg", "Objects: return period of a hit", true},
      {"objects_sources.csv", "Objects: sources of the hits"},
      {"objects_curves.csv", "Objects: hazard curves", false, true},
      {"screens.gpkg", "Screens: energy, P95", true},
      {"screens_summary.csv", "Screens: all quantities"},
      {"exits.gpkg", "Ends off the map: energy"},
      {"stops.gpkg", "Stops: largest energy of the path"},
      {"trajectories.gpkg", "Paths: largest speed"},
      {"barriers.csv", "Barriers of the run: counts by stretch"},
      {"hazard_class.tif", "Hazard goes on beyond the map (cut short)", true, false, "",
       mark_style_name("hazard_class", "cut short")},
      {"hazard_class.tif", "Class undecided", false, false, "", mark_style_name("hazard_class", "undecided")},
      {"hazard_class.tif", "Hazard class", true, true},
      {"annual_frequency.tif", "Blocks per year"},
      {"return_period_<n>.tif", "Return period of more than <n> kJ", false, true},
      {"intensity_T<n>.tif", "Energy once in <n> years", false, true},
      {"hazard_curves.tif", "Hazard curves: annual frequency", false, true},
      {"impact_probability.tif", "Impact probability", true},
      {"reach_probability.tif", "Reach probability"},
      {"passage_density.tif", "Passage density"},
      {"energy.tif", "Energy, P95"},
      {"energy_total.tif", "Energy with rotation, P95"},
      {"jump_height.tif", "Jump height, P95"},
      {"velocity.tif", "Speed, P95"},
      {"energy_exceedance.tif", "Share above <threshold>", false, true, "output.energy_thresholds"},
      {"height_exceedance.tif", "Share with jump height above <threshold>", false, false, "output.height_thresholds"},
      {"energy_bounds.tif", "Energy, upper bound of P95"},
      {"jump_height_bounds.tif", "Jump height, upper bound of P95"},
      {"velocity_bounds.tif", "Speed, upper bound of P95"},
      {"passages.tif", "Passages"},
      {"impacts.tif", "Impacts"},
      {"deposits.tif", "Deposits"},
      {"trapped.tif", "Trapped blocks"},
      {"exits.tif", "Exits"},
      {"release.tif", "Release cells"},
      {"sources.tif", "Source cells that reach the cell"},
  });
  return layers;
}

ProjectGround ground_of(const LoadedScenario& loaded) {
  const Grid& grid = loaded.scenario.surface.grid();
  return {loaded.geo, grid.columns, grid.rows, dem_of(loaded.inputs), loaded.inputs, loaded.settings};
}

ProjectGround ground_of_run(const fs::path& folder) {
  return ground_of(read_record(folder / "run.json"));
}

std::string project_of(const std::vector<std::string>& files, const fs::path& folder, const fs::path& shown_as,
                       const ProjectGround& ground) {
  std::vector<Shown> shown = shown_layers(files, folder, ground.settings);
  check_one_map(shown);
  add_inputs(shown, ground, shown_as);
  if (auto hillshade = hillshade_of(ground.dem, shown_as)) shown.push_back(std::move(*hillshade));
  const std::string title = "Talus";  // without the name of the folder: the same results are the same bytes
  const QgisDocument document;
  const Element root = document.root();
  root.set("projectname", title);
  root.add("title", title);
  add_system(root, "projectCrs", ground.geo.crs_wkt);
  add_tree(root, shown, title);
  add_view(root, ground);
  const Element layers = root.add("projectlayers");
  for (const Shown& one : shown) add_map_layer(layers, one, ground.geo.crs_wkt);
  const Element properties = root.add("properties");
  add_property(properties.add("Paths"), "Absolute", "bool", "false");
  add_property(properties.add("SpatialRefSys"), "ProjectionsEnabled", "int", "1");
  return document.text();
}

/// Whether QGIS has saved a project: it writes who and when into the first element.
bool saved_by_qgis(const fs::path& project) {
  constexpr std::streamsize kHead = 4096;  // bytes
  std::string head(kHead, '\0');
  std::ifstream file(project, std::ios::binary);
  file.read(head.data(), kHead);
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return head.find("saveDateTime=") != std::string::npos;
}

bool refresh_project(const fs::path& folder) {
  if (saved_by_qgis(folder / kProjectFile)) return false;
  const Json run = read_record(folder / "run.json");
  std::set<std::string> names;
  for (const char* record : {"run.json", "hazard.json"})
    for (std::string& name : files_of_record(folder / record))
      if (fs::is_regular_file(folder / name)) names.insert(std::move(name));
  for (std::string& name : files_of_designs(folder)) names.insert(std::move(name));
  const fs::path full = full_name(folder);
  replace_text(folder / kProjectFile, project_of({names.begin(), names.end()}, folder, full, ground_of(run)));
  return true;
}

}  // namespace talus::io
