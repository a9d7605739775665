// Styles of all rasters of the table, read with GDAL's reader of XML.
#include "talus/io/results/style.hpp"

#include <cpl_minixml.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>

#include "files.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/results/class_names.hpp"
#include "talus/io/results/qgis_project.hpp"
#include "talus/io/results/vector_style.hpp"
#include "talus/products/comparison.hpp"
#include "talus/products/hazard_table.hpp"
#include "talus/products/raster_table.hpp"

namespace talus::io {
namespace {

/// Every map of a run and of a hazard, without values.
std::vector<Map> all_maps() {
  std::vector<Map> maps;
  const RunCounts run{100, 10.0, thresholds_of({30.0, 300.0}, {1.0}), 1.0, 1.0, 0.0, true, true};
  for (const RunRaster& raster : run_rasters()) {
    maps.push_back(raster.map);
    maps.back().bands = bands_of(raster, run);
  }
  for (HazardMap& of : hazard_maps_of({EnergyBins({30.0, 300.0}), {}}, {})) maps.push_back(std::move(of.map));
  return maps;
}

using Tree = std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)>;

Tree tree_of(const Map& map) {
  return {CPLParseXMLString(style_of(map).c_str()), CPLDestroyXMLNode};
}

Map map_of(const std::string& name) {
  for (const Map& map : all_maps())
    if (map.name == name) return map;
  ADD_FAILURE() << "no map " << name;
  return {};
}

TEST(Style, XmlWithRisingClasses) {
  for (const Map& map : all_maps()) {
    const Tree tree = tree_of(map);
    ASSERT_NE(tree, nullptr) << map.name;
    const CPLXMLNode* shader = CPLGetXMLNode(tree.get(), "=qgis.pipe.rasterrenderer.rastershader.colorrampshader");
    ASSERT_NE(shader, nullptr) << map.name;
    double last = -1.0;
    for (const CPLXMLNode* item = shader->psChild; item != nullptr; item = item->psNext) {
      if (item->eType != CXT_Element) continue;
      const double value = std::atof(CPLGetXMLValue(item, "value", ""));
      EXPECT_GT(value, last) << map.name;
      EXPECT_STREQ(CPLGetXMLValue(item, "alpha", ""), value == 0.0 ? "0" : "255") << map.name;
      last = value;
    }
    EXPECT_TRUE(std::isinf(last) || !map.classes.empty()) << "every value has a class: " << map.name;
  }
}

TEST(Style, ShownBands) {  // docs/products.md: the P95 of each quantity
  for (const auto& [name, band] : {std::pair{"energy", "3"},
                                   {"velocity", "3"},
                                   {"jump_height", "3"},
                                   {"impact_probability", "1"},
                                   {"height_exceedance", "1"},
                                   {"intensity_T30", "1"}})
    EXPECT_STREQ(CPLGetXMLValue(tree_of(map_of(name)).get(), "=qgis.pipe.rasterrenderer.band", ""), band) << name;
}

TEST(Style, LabelsWithUnits) {
  const std::string energy = style_of(map_of("energy")), probability = style_of(map_of("impact_probability"));
  EXPECT_NE(energy.find("value=\"100\" label=\"30 to 100 kJ\" color=\"#fca636\""), std::string::npos) << energy;
  EXPECT_NE(energy.find("value=\"inf\" label=\"above 3000 kJ\" color=\"#08054f\""), std::string::npos) << energy;
  EXPECT_NE(probability.find("value=\"inf\" label=\"10 to 100 %\""), std::string::npos) << probability;
}

TEST(Style, NamesOfClassesAreEscaped) {
  Map map = map_of("hazard_class");
  map.classes = {"none", "\"low\" < 30 & rare"};
  EXPECT_NE(style_of(map).find("label=\"&quot;low&quot; &lt; 30 &amp; rare\""), std::string::npos) << style_of(map);
}

TEST(Style, WithoutALegendItIsAFault) {
  Map map = map_of("energy");
  map.legend.band = "P97";
  EXPECT_THROW(style_of(map), std::logic_error);
  map.legend = {};
  EXPECT_THROW(style_of(map), std::logic_error);
}

TEST(Style, ReturnPeriodsHaveNoZero) {  // nothing comes back every 0 years
  for (const Map& map : all_maps()) {
    const bool zero = style_of(map).find("value=\"0\"") != std::string::npos;
    EXPECT_EQ(zero, !map.name.starts_with("return_period")) << map.name;
  }
}

TEST(Style, ReachProbabilityHasClassesOfItsOwn) {
  // The least value is 1 / trajectories of a source cell, 2 % with 50: its classes must not all lie below.
  const std::vector<LegendClass> classes = classes_of(map_of("reach_probability"));
  ASSERT_EQ(classes.size(), 6U);
  EXPECT_EQ(classes[0].label, "up to 2 %");
  EXPECT_EQ(classes[5].label, "50 to 100 %");
}

// Colours as they are seen.

using Rgb = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

Rgb linear(const std::string& text) {  // sRGB (IEC 61966-2-1)
  Rgb rgb;
  for (int i = 0; i < 3; ++i) {
    const double c = std::stoi(text.substr(1 + 2 * static_cast<std::size_t>(i), 2), nullptr, 16) / 255.0;
    rgb[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return rgb;
}

Rgb lab_of(const Rgb& rgb) {  // CIE 1976 L*a*b* for the white of D65
  const Matrix xyz{
      {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
  const Rgb t = (xyz * rgb.cwiseMax(0.0).cwiseMin(1.0)).cwiseQuotient(Rgb(0.95047, 1.0, 1.08883));
  const auto f = [](double x) { return x > 216.0 / 24389.0 ? std::cbrt(x) : (24389.0 / 27.0 * x + 16.0) / 116.0; };
  return {116.0 * f(t[1]) - 16.0, 500.0 * (f(t[0]) - f(t[1])), 200.0 * (f(t[1]) - f(t[2]))};
}

/// Eyes: normal ones, and those without one kind of cones by Machado, Oliveira and Fernandes (2009, IEEE Transactions
/// on Visualization and Computer Graphics 15, 1291-1298), their matrices of severity 1, for linear RGB.
const std::map<std::string, Matrix>& eyes() {
  static const std::map<std::string, Matrix> all{
      {"normal", Matrix::Identity()},
      {"protanopia",
       Matrix{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
      {"deuteranopia",
       Matrix{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}}};
  return all;
}

TEST(Colours, AsSeenByMachado) {  // greys stay grey, and pure red is dark without the cones for it
  for (const auto& [eye, matrix] : eyes()) {
    const Rgb grey = lab_of(matrix * linear("#808080"));
    EXPECT_NEAR(grey[0], 53.6, 0.1) << eye;
    EXPECT_NEAR(grey.tail<2>().norm(), 0.0, 0.1) << eye;
  }
  EXPECT_NEAR(lab_of(linear("#ff0000"))[0], 53.2, 0.1);
  EXPECT_LT(lab_of(eyes().at("protanopia") * linear("#ff0000"))[0], 45.0);
}

constexpr Palette kPalettes[]{Palette::Plasma, Palette::PuBuGnFromDark, Palette::Viridis, Palette::YlGnBu,
                              Palette::HazardClasses};

/// All six colours of a palette, in the order of the classes.
std::vector<std::string> colours_of(Palette palette) {
  std::vector<std::string> colours;
  for (const LegendClass& item : classes_of(Legend{{1.0, 2.0, 3.0, 4.0, 5.0}, 1.0, "", palette}, false))
    colours.push_back(item.colour);
  return colours;
}

TEST(Colours, NeighboursDifferForAllEyes) {
  constexpr double kLeast = 15.0;  // of CIELAB; 2.3 is just noticeable side by side (Mahy and others, 1994)
  for (const Palette palette : kPalettes)
    for (const auto& [eye, matrix] : eyes()) {
      const std::vector<std::string> colours = colours_of(palette);
      for (std::size_t i = 1; i < colours.size(); ++i)
        EXPECT_GE((lab_of(matrix * linear(colours[i])) - lab_of(matrix * linear(colours[i - 1]))).norm(), kLeast)
            << static_cast<int>(palette) << ": " << colours[i - 1] << " " << colours[i] << " " << eye;
    }
}

TEST(Colours, LightnessIsMonotone) {  // in every eye: the order of the classes is seen, also in a grey copy
  for (const Palette palette : kPalettes)
    for (const auto& [eye, matrix] : eyes()) {
      const std::vector<std::string> colours = colours_of(palette);
      const double sign = palette == Palette::PuBuGnFromDark ? 1.0 : -1.0;
      for (std::size_t i = 1; i < colours.size(); ++i)
        EXPECT_GT(sign * (lab_of(matrix * linear(colours[i]))[0] - lab_of(matrix * linear(colours[i - 1]))[0]), 1.0)
            << static_cast<int>(palette) << ": " << colours[i - 1] << " " << colours[i] << " " << eye;
    }
}

TEST(Colours, ChangesDifferForAllEyes) {  // each from each: a rise is not taken for a fall
  constexpr double kLeast = 15.0;         // as of neighbours
  const Map map = change_map(compared_raster("energy").value());
  const std::vector<LegendClass> classes = classes_of(map);
  ASSERT_EQ(classes.size(), 7U);
  for (const auto& [eye, matrix] : eyes())
    for (std::size_t i = 0; i < 7; ++i)
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GE((lab_of(matrix * linear(classes[i].colour)) - lab_of(matrix * linear(classes[j].colour))).norm(),
                  kLeast)
            << classes[i].colour << " " << classes[j].colour << " " << eye;
}

TEST(Style, ChangesHaveBothSigns) {
  const std::string energy = style_of(change_map(compared_raster("energy").value()));
  EXPECT_NE(energy.find("value=\"-300\" label=\"up to -300 kJ\" color=\"#08519c\" alpha=\"255\""), std::string::npos)
      << energy;
  EXPECT_NE(energy.find("value=\"30\" label=\"-30 to 30 kJ\" color=\"#ffffff\" alpha=\"0\""), std::string::npos)
      << energy;
  EXPECT_NE(energy.find("value=\"inf\" label=\"above 300 kJ\" color=\"#a63603\""), std::string::npos) << energy;
  EXPECT_NE(energy.find("band=\"3\""), std::string::npos) << energy;  // P95
  const std::string years = style_of(change_map(compared_raster("return_period_30").value()));
  EXPECT_NE(years.find("label=\"up to -100 years\" color=\"#a63603\""), std::string::npos) << "fewer years are worse";
}

TEST(Colours, ReturnPeriodsHaveNoneOfWhatTheyAreDrawnOver) {
  // Objects at a road are drawn by return period, over the classes of hazard and beside screens by energy.
  constexpr double kLeast = 15.0;  // as of neighbours
  for (const char* other : {"energy", "hazard_class"})
    for (const auto& [eye, matrix] : eyes())
      for (const LegendClass& one : classes_of(map_of("return_period_30")))
        for (const LegendClass& two : classes_of(map_of(other)))
          EXPECT_GE((lab_of(matrix * linear(one.colour)) - lab_of(matrix * linear(two.colour))).norm(), kLeast)
              << one.colour << " " << two.colour << " " << eye;
  EXPECT_EQ(classes_of(map_of("hazard_class")).size(), 4U);
}

TEST(Marks, StyleDrawsOneValueOfTheirBand) {
  const Map map = map_of("hazard_class");
  ASSERT_EQ(map.marks.size(), 2U);
  for (const Map::Mark& mark : map.marks) {
    const Tree tree(CPLParseXMLString(style_of(map, mark).c_str()), CPLDestroyXMLNode);
    const CPLXMLNode* renderer = CPLGetXMLNode(tree.get(), "=qgis.pipe.rasterrenderer");
    ASSERT_NE(renderer, nullptr);
    EXPECT_STREQ(CPLGetXMLValue(renderer, "band", ""), mark.band == "cut short" ? "5" : "4");  // docs/hazard.md
    EXPECT_STREQ(CPLGetXMLValue(renderer, "type", ""), "paletted") << "what has no entry is transparent";
    EXPECT_STREQ(CPLGetXMLValue(renderer, "colorPalette.paletteEntry.value", ""), "1");
    EXPECT_EQ(CPLGetXMLValue(renderer, "colorPalette.paletteEntry.color", ""), mark.colour);
  }
  EXPECT_EQ(mark_style_name("hazard_class", "cut short"), "hazard_class_cut_short.qml");
}

TEST(Marks, AreSeenOverClassesAndOverAHillshade) {
  constexpr double kLeast = 15.0;  // as of neighbours
  for (const Map::Mark& mark : map_of("hazard_class").marks)
    for (const auto& [eye, matrix] : eyes()) {
      std::vector<std::string> below{"#404040", "#808080", "#c0c0c0", "#ffffff"};
      for (const LegendClass& one : classes_of(map_of("hazard_class"))) below.push_back(one.colour);
      for (const Map::Mark& other : map_of("hazard_class").marks)
        if (other.band != mark.band) below.push_back(other.colour);
      for (const std::string& colour : below)
        EXPECT_GE((lab_of(matrix * linear(mark.colour)) - lab_of(matrix * linear(colour))).norm(), kLeast)
            << mark.band << " " << colour << " " << eye;
    }
}

TEST(ClassNames, OfClassesAndOfIntensities) {
  Map classes = map_of("hazard_class");
  classes.classes = {"none", "\"low\" < 30 & rare", "high"};
  const Tree tree(CPLParseXMLString(class_names_of(classes).c_str()), CPLDestroyXMLNode);
  const CPLXMLNode* names = CPLGetXMLNode(tree.get(), "=PAMDataset.PAMRasterBand.CategoryNames");
  ASSERT_NE(names, nullptr);
  EXPECT_STREQ(CPLGetXMLValue(names->psChild->psNext, "", ""), "\"low\" < 30 & rare");
  const std::string intensity = class_names_of(map_of("intensity_T30"));
  EXPECT_NE(intensity.find("tableType=\"athematic\""), std::string::npos) << intensity;
  const Tree ranges(CPLParseXMLString(intensity.c_str()), CPLDestroyXMLNode);
  const CPLXMLNode* row = CPLGetXMLNode(ranges.get(), "=PAMDataset.PAMRasterBand.GDALRasterAttributeTable.Row");
  std::vector<std::string> cells;
  for (const CPLXMLNode* cell = row->psNext->psChild; cell != nullptr; cell = cell->psNext)
    if (cell->eType == CXT_Element) cells.emplace_back(CPLGetXMLValue(cell, "", ""));
  EXPECT_EQ(cells, (std::vector<std::string>{"30", "100", "30 to 100 kJ", "252", "166", "54"}));  // #fca636
  EXPECT_EQ(class_names_of(map_of("energy")), "");
}

TEST(VectorStyle, ClassesOfTheRaster) {
  for (const auto& [layer, raster] : {std::pair{StyledLayer::Stops, "energy"},
                                      {StyledLayer::Exits, "energy"},
                                      {StyledLayer::Trajectories, "velocity"},
                                      {StyledLayer::Screens, "energy"},
                                      {StyledLayer::Stretches, "energy"},
                                      {StyledLayer::Crossings, "energy"},
                                      {StyledLayer::Bins, "energy"},
                                      {StyledLayer::AreaObjects, "return_period_30"},
                                      {StyledLayer::LineObjects, "return_period_30"}}) {
    const Tree tree(CPLParseXMLString(style_of(layer).c_str()), CPLDestroyXMLNode);
    ASSERT_NE(tree, nullptr);
    const CPLXMLNode* ranges = CPLGetXMLNode(tree.get(), "=qgis.renderer-v2.ranges");
    ASSERT_NE(ranges, nullptr);
    std::vector<LegendClass> classes = classes_of(map_of(raster));
    const bool objects = layer == StyledLayer::AreaObjects || layer == StyledLayer::LineObjects;
    if (objects) classes.push_back({1e100, "no hit counted in this run", "#ffffff"});  // which has no return period
    if (layer == StyledLayer::Screens || layer == StyledLayer::Bins)
      classes.push_back({1e100, "no crossing", "#ffffff"});
    if (layer == StyledLayer::Stretches) classes.push_back({1e100, "too few crossings for a design", "#ffffff"});
    std::size_t i = 0;
    double upper = 0.0;
    for (const CPLXMLNode* range = ranges->psChild; range != nullptr; range = range->psNext, ++i) {
      ASSERT_LT(i, classes.size());
      EXPECT_TRUE(std::string(CPLGetXMLValue(range, "label", "")).starts_with(classes[i].label)) << classes[i].label;
      EXPECT_EQ(std::atof(CPLGetXMLValue(range, "lower", "")), upper);
      upper = std::atof(CPLGetXMLValue(range, "upper", ""));
      EXPECT_LT(std::atof(CPLGetXMLValue(range, "lower", "")), upper);
    }
    EXPECT_EQ(i, classes.size());
  }
}

TEST(ProjectLayers, HaveATitleForEveryRaster) {
  std::set<std::string> known;
  for (const ProjectLayer& layer : project_layers()) known.insert(layer.file.substr(0, layer.file.find('<')));
  for (const RunRaster& raster : run_rasters()) EXPECT_EQ(known.count(raster.map.name + ".tif"), 1U) << raster.map.name;
  for (const RunRaster& raster : run_rasters())
    EXPECT_EQ(std::ranges::find(project_layers(), raster.map.name, &ProjectLayer::title), project_layers().end())
        << "every raster of today has a title of its own";
  for (const char* file : {"highest_energy.tif", "change_energy.tif", "lowest_return_period_<n>.tif"})
    EXPECT_NE(std::ranges::find(project_layers(), file, &ProjectLayer::file), project_layers().end()) << file;
  for (const HazardRaster& raster : hazard_rasters()) {
    const std::string file = raster.map.name + ".tif";
    EXPECT_EQ(known.count(file.substr(0, file.find('<'))), 1U) << file;
  }
}

class Project : public test::Files {};

TEST_F(Project, NamesOfFilesAreEscaped) {
  const std::string dem = write_text("a \"b\" <c> & 'd'.tif", "");
  const ProjectGround ground{{"", 0.0, 100.0, 1.0, 1.0}, 10, 10, dem};
  const std::string text = project_of({"hazard_class.tif", "return_period_30.tif", "return_period_300.tif",
                                       "stops.gpkg", "mine.tif", "return_period_<b>.tif"},
                                      path(""), path("out"), ground);
  const Tree tree(CPLParseXMLString(text.c_str()), CPLDestroyXMLNode);
  ASSERT_NE(tree, nullptr) << text;
  EXPECT_NE(text.find(">../a \"b\" &lt;c&gt; &amp; 'd'.tif</datasource>"), std::string::npos) << text;
  EXPECT_EQ(text.find("mine"), std::string::npos) << "only results are shown";
  EXPECT_EQ(text.find("&lt;b&gt;.tif"), std::string::npos);
  EXPECT_LT(text.find("stops_talus_layer"), text.find("hazard_class_talus_map"));
  EXPECT_LT(text.find("hazard_class_talus_map"), text.find("return_period_30_talus_map"));
  EXPECT_LT(text.find("\"return_period_30_talus_map\""), text.find("\"return_period_300_talus_map\""));
  EXPECT_NE(text.find("<datasource>./stops.gpkg|layername=stops<"), std::string::npos) << text;
}

TEST_F(Project, AnIdIsWhatIsBetweenTheEndsOfAName) {
  const std::string text = project_of({"barrier_a_b.csv", "barrier_a_b.json", "barrier_a_b_stretches.csv",
                                       "barrier_x.csv", "barrier_.csv", "return_period_.tif", "intensity_T1e+06.tif"},
                                      path(""), path("out"), {{"", 0.0, 100.0, 1.0, 1.0}, 10, 10, ""});
  EXPECT_NE(text.find("<layername>Barrier at a_b: design values<"), std::string::npos) << text;
  EXPECT_NE(text.find("<layername>Energy once in 1e+06 years<"), std::string::npos) << text;
  std::size_t layers = 0;
  for (std::size_t at = 0; (at = text.find("<maplayer", at)) != std::string::npos; ++at) ++layers;
  EXPECT_EQ(layers, 2U) << "a table without a record of a design is the user's own";
}

TEST_F(Project, TitlesNameTheLowestThreshold) {
  ProjectGround ground{{"", 0.0, 100.0, 1.0, 1.0}, 10, 10, ""};
  ground.settings = {{"output.energy_thresholds", "[2.5, 300]", "kJ", "default"},
                     {"output.count_rotation", "true", "", "default"}};
  const std::string text =
      project_of({"energy_exceedance.tif", "height_exceedance.tif"}, path(""), path("out"), ground);
  EXPECT_NE(text.find("<layername>Share above 2.5 kJ, energy with rotation<"), std::string::npos) << text;
  EXPECT_NE(text.find("<layername>Share with jump height above the lowest threshold<"), std::string::npos) << text;
}

TEST_F(Project, NoIdOfALayerBeginsAnother) {
  std::vector<std::string> files;
  for (const ProjectLayer& layer : project_layers())
    for (const char* word : {"30", "300"}) {
      if (!layer.style.empty()) {
        files.push_back(layer.style);
        break;
      }
      const std::size_t at = layer.file.find('<'), end = layer.file.find('>');
      files.push_back(at == std::string::npos ? layer.file
                                              : layer.file.substr(0, at) + word + layer.file.substr(end + 1));
      if (at == std::string::npos) break;
    }
  files.insert(files.end(), {"barrier_30.json", "barrier_300.json"});  // which say that the others are designs
  std::string text = project_of(files, path(""), path("out"), {{"", 0.0, 100.0, 1.0, 1.0}, 10, 10, ""});
  std::vector<std::string> ids;
  for (std::size_t at = 0; (at = text.find("<id>", at)) != std::string::npos; ++at)
    ids.push_back(text.substr(at + 4, text.find('<', at + 4) - at - 4));
  ASSERT_GT(ids.size(), 29U);
  for (const std::string& one : ids)
    EXPECT_EQ(std::ranges::count_if(ids, [&](const std::string& id) { return id.starts_with(one); }), 1) << one;
}

TEST_F(Project, MarksLieOverTheClassesWhereThereAreSome) {
  const auto text = [this](std::vector<std::string> files) {
    files.insert(files.end(), {"hazard_class.tif", "annual_frequency.tif", "stops.gpkg"});
    return project_of(files, path(""), path("out"), {{"", 0.0, 100.0, 1.0, 1.0}, 10, 10, ""});
  };
  EXPECT_EQ(text({"hazard_class.qml"}).find("beyond"), std::string::npos);
  const std::string both = text({"hazard_class_cut_short.qml", "hazard_class_undecided.qml"});
  const auto in_tree = [&both](const std::string& name) {
    const std::size_t at = both.find("name=\"" + name + "\"");
    EXPECT_NE(at, std::string::npos) << name;
    return std::pair(at, both.substr(at, both.find('>', at) - at));
  };
  const auto cut = in_tree("Hazard goes on beyond the map (cut short)"), undecided = in_tree("Class undecided"),
             classes = in_tree("Hazard class");
  EXPECT_LT(in_tree("Stops: largest energy of the path").first, cut.first);
  EXPECT_LT(cut.first, undecided.first);
  EXPECT_LT(undecided.first, classes.first);
  for (const auto& [layer, checked] : {std::pair{cut, true}, {undecided, false}, {classes, true}}) {
    EXPECT_EQ(layer.second.find("Qt::Checked") != std::string::npos, checked) << layer.second;
    EXPECT_NE(layer.second.find("source=\"./hazard_class.tif\""), std::string::npos) << layer.second;
  }
}

TEST_F(Project, TheHillshadeIsFoundByEveryPathToTheProject) {
  namespace fs = std::filesystem;
  fs::create_directories(path("real/out"));
  fs::create_directory_symlink(path("real"), path("link"));
  std::ofstream(path("real/dem.tif")) << "heights";
  for (const char* given : {"real/dem.tif", "link/dem.tif", "link/../real/out/../dem.tif"}) {
    const std::string text = project_of({}, path("real/out"), full_name(path("link/out")),
                                        {{"", 0.0, 100.0, 1.0, 1.0}, 10, 10, path(given)});
    const std::size_t from = text.find("<datasource>") + 12;
    const std::string way = text.substr(from, text.find('<', from) - from);
    for (const char* opened : {"real/out", "link/out"})  // QGIS takes a way from the path that it was given
      EXPECT_TRUE(fs::exists((fs::path(path(opened)) / way).lexically_normal())) << opened << ' ' << way;
  }
}

TEST_F(Project, AFileThatIsNotThereHasNoHillshade) {
  for (const std::string& dem :
       {path("none.tif"), std::string("/vsicurl/http://example.org/dem.tif"), std::string("x.tif")})
    EXPECT_EQ(project_of({}, path(""), path("out"), {{"", 0.0, 100.0, 1.0, 1.0}, 10, 10, dem}).find("hillshade"),
              std::string::npos)
        << dem;
}

}  // namespace
}  // namespace talus::io
