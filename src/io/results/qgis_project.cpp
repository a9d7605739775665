#include "talus/io/results/qgis_project.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>

#include "io/files/json.hpp"
#include "io/files/own_files.hpp"
#include "io/gdal/dataset.hpp"
#include "io/gdal/regular_file.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/results/vector_style.hpp"
#include "talus/products/raster_table.hpp"
#include "xml.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostStyle = std::size_t{1} << 20U;  // bytes

/// A layer of the project.
struct Shown {
  std::string id, title, source;
  bool vector = false, checked = false;
  XmlTree style{nullptr, CPLDestroyXMLNode};
};

/// The file that belongs to an entry of `project_layers`; its number is what follows the name.
std::optional<std::string> number_in(const std::string& stem, const ProjectLayer& layer) {
  const bool numbered = layer.title.find("<n>") != std::string::npos;
  if (!numbered) return stem == layer.name ? std::optional<std::string>("") : std::nullopt;
  if (!stem.starts_with(layer.name) || stem.size() == layer.name.size()) return std::nullopt;
  const std::string number = stem.substr(layer.name.size());
  const bool is_number = number.find_first_not_of("0123456789.e+-") == std::string::npos;
  return is_number ? std::optional(number) : std::nullopt;
}

/// The style that a GeoPackage holds for a layer; empty if there is none.
std::string style_in(const fs::path& file, const std::string& layer) {
  try {
    const Dataset dataset = open_dataset(file.string(), GDAL_OF_VECTOR);
    OGRLayer* styles = dataset->GetLayerByName("layer_styles");
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
std::string id_of(const std::string& name, bool vector) {
  return name + (vector ? "_talus_layer" : "_talus_map");
}

/// Takes the lines out of a layer of objects of both kinds: QGIS draws one kind of geometry per layer.
Shown lines_of(Shown& objects) {
  Shown lines;
  lines.id = id_of("objects_lines", true);
  lines.title = objects.title + " (lines)";
  lines.source = objects.source + "|geometrytype=LineString";
  lines.vector = true;
  lines.style = parsed_xml(style_of(StyledLayer::LineObjects));
  objects.source += "|geometrytype=Polygon";
  return lines;
}

std::string style_beside(const fs::path& layer) {
  const fs::path file = fs::path(layer).replace_extension(".qml");
  try {
    return read_file(file.string(), file.string(), "a style of QGIS", kMostStyle);
  } catch (const InputError&) {
    return {};
  }
}

/// The layers that are there, from the top to the bottom.
std::vector<Shown> shown_layers(const std::vector<std::string>& files, const fs::path& folder) {
  std::vector<std::string> names = files;
  std::ranges::sort(names, [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;  // return_period_30 before return_period_300
  });
  std::vector<Shown> shown;
  for (const ProjectLayer& layer : project_layers())
    for (const std::string& name : names) {
      const fs::path file(name);
      const bool beside = file.extension() == (layer.vector ? ".fgb" : ".tif");  // its style, not in the file
      if (!beside && !(layer.vector && file.extension() == ".gpkg")) continue;
      const std::string stem = file.stem().string();
      const auto number = number_in(stem, layer);
      if (!number) continue;
      Shown one;
      one.id = id_of(stem, layer.vector);
      one.title = layer.title;
      if (const std::size_t at = one.title.find("<n>"); at != std::string::npos) one.title.replace(at, 3, *number);
      one.source = "./" + name + (beside ? "" : "|layername=" + stem);
      one.vector = layer.vector;
      one.style = parsed_xml(beside ? style_beside(folder / name) : style_in(folder / name, stem));
      if (stem == "objects" && has_lines_beside_areas(folder / name, stem)) shown.push_back(lines_of(one));
      shown.push_back(std::move(one));
    }
  return shown;
}

/// What is switched on: objects and screens, the hazard class, and without one the impact probability.
void check_layers(std::vector<Shown>& shown) {
  const auto check = [&](const std::string& id) {
    const auto found = std::ranges::find(shown, id, &Shown::id);
    if (found != shown.end()) found->checked = true;
    return found != shown.end();
  };
  for (const char* name : {"objects", "objects_lines", "screens"}) check(id_of(name, true));
  if (!check(id_of("hazard_class", false))) check(id_of("impact_probability", false));
}

/// A layer that QGIS shades: the DEM itself, with light from the north-west and from the sides.
std::optional<Shown> hillshade_of(const fs::path& dem, const fs::path& project) {
  std::error_code none;
  if (!dem.is_absolute() || !fs::is_regular_file(dem, none)) return std::nullopt;
  Shown shown;
  shown.id = "talus_hillshade";
  shown.title = "Hillshade of the DEM";
  shown.checked = true;
  // Without links on the way, as `project`: then it is the same from every path that leads to the project.
  const fs::path folder = fs::weakly_canonical(dem.parent_path(), none);
  const std::string way = (folder / dem.filename()).lexically_relative(project).string();
  shown.source = way.starts_with("..") ? way : "./" + way;
  shown.style = parsed_xml(
      "<qgis><pipe><rasterrenderer type=\"hillshade\" band=\"1\" azimuth=\"315\" angle=\"45\" zfactor=\"1\" "
      "multidirection=\"1\" opacity=\"1\" alphaBand=\"-1\" nodataColor=\"\"/><rasterresampler maxOversampling=\"2\" "
      "zoomedInResampler=\"bilinear\"/></pipe><blendMode>0</blendMode></qgis>");
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
  layer.set("type", shown.vector ? "vector" : "raster").set("autoRefreshEnabled", "0");
  layer.add("id", shown.id);
  layer.add("datasource", shown.source);
  layer.add("layername", shown.title);
  add_system(layer, "srs", wkt);
  layer.add("provider", shown.vector ? "ogr" : "gdal");
  if (const CPLXMLNode* root = style_root(shown)) layer.add_children_of(*root);
}

void add_tree(const Element& root, const std::vector<Shown>& shown, const std::string& title) {
  const Element group = root.add("layer-tree-group").add("layer-tree-group");
  group.set("name", title).set("checked", "Qt::Checked").set("expanded", "1");
  for (const Shown& one : shown) {
    const Element layer = group.add("layer-tree-layer");
    layer.set("id", one.id).set("name", one.title).set("source", one.source);
    layer.set("providerKey", one.vector ? "ogr" : "gdal");
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

/// Adds the rasters of a run that have no title here: their names are their titles.
std::vector<ProjectLayer> with_further_rasters(std::vector<ProjectLayer> layers) {
  for (const RunRaster& raster : run_rasters()) {
    const std::string& name = raster.map.name;
    const auto known = [&](const ProjectLayer& layer) { return !layer.vector && layer.name == name; };
    if (std::ranges::none_of(layers, known)) layers.push_back({name, name});
  }
  return layers;
}

/// The ground of a finished run, from its record.
ProjectGround ground_of(const Json& run) {
  const Json& grid = run.at("grid");
  ProjectGround ground;
  ground.geo = {grid.at("crs_wkt"), grid.at("west"), grid.at("north"), grid.at("cell_x_m"), grid.at("cell_y_m")};
  ground.columns = static_cast<int>(whole_number(grid.at("columns"), 1, 1 << 30));
  ground.rows = static_cast<int>(whole_number(grid.at("rows"), 1, 1 << 30));
  for (const Json& input : run.at("inputs"))
    if (input.at("role") == "dem") ground.dem = input.at("path").get<std::string>();
  return ground;
}

}  // namespace

const std::vector<ProjectLayer>& project_layers() {
  static const std::vector<ProjectLayer> layers = with_further_rasters({
      {"objects", "Objects: return period of a hit", true},
      {"screens", "Screens: energy, P95", true},
      {"exits", "Ends off the map: energy", true},
      {"stops", "Stops: largest energy of the path", true},
      {"trajectories", "Paths: largest speed", true},
      {"hazard_class", "Hazard class"},
      {"annual_frequency", "Blocks per year"},
      {"return_period_", "Return period of more than <n> kJ"},
      {"intensity_T", "Energy once in <n> years"},
      {"hazard_curves", "Hazard curves: annual frequency"},
      {"impact_probability", "Impact probability"},
      {"reach_probability", "Reach probability"},
      {"passage_density", "Passage density"},
      {"energy", "Energy, P95"},
      {"energy_total", "Energy with rotation, P95"},
      {"jump_height", "Jump height, P95"},
      {"velocity", "Speed, P95"},
      {"energy_exceedance", "Share above the first energy threshold"},
      {"height_exceedance", "Share above the first height threshold"},
      {"energy_bounds", "Energy, upper bound of P95"},
      {"jump_height_bounds", "Jump height, upper bound of P95"},
      {"velocity_bounds", "Speed, upper bound of P95"},
      {"passages", "Passages"},
      {"impacts", "Impacts"},
      {"deposits", "Deposits"},
      {"trapped", "Trapped blocks"},
      {"exits", "Exits"},
      {"release", "Release cells"},
      {"sources", "Source cells that reach the cell"},
  });
  return layers;
}

ProjectGround ground_of(const LoadedScenario& loaded) {
  const Grid& grid = loaded.scenario.surface.grid();
  ProjectGround ground{loaded.geo, grid.columns, grid.rows, {}};
  for (const InputFile& input : loaded.inputs)
    if (input.role == "dem") ground.dem = input.path;
  return ground;
}

std::string project_of(const std::vector<std::string>& files, const fs::path& folder, const fs::path& shown_as,
                       const ProjectGround& ground) {
  std::vector<Shown> shown = shown_layers(files, folder);
  check_layers(shown);
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
  const fs::path full = full_name(folder);
  replace_text(folder / kProjectFile, project_of({names.begin(), names.end()}, folder, full, ground_of(run)));
  return true;
}

}  // namespace talus::io
