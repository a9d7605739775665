#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "files.hpp"
#include "io/reports/map_style.hpp"
#include "io/reports/packed_map.hpp"
#include "io/reports/page_frame.hpp"
#include "io/reports/report_barriers.hpp"
#include "io/reports/report_checks.hpp"
#include "io/reports/report_facts.hpp"
#include "io/reports/report_fit.hpp"
#include "io/reports/report_map_page.hpp"
#include "io/reports/report_objects.hpp"
#include "io/reports/report_screens.hpp"
#include "io/results/frequency_record.hpp"

namespace talus::io {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kHostile = "<script>alert(1)</script>&amp;'\"\x1b[31m\u202e</svg>";

TEST(CodeOf, DigitsAndPowerOfTen) {  // 2 + 900 (e + 30) + (d - 100), docs/report.md
  EXPECT_EQ(code_of(0.0), 1);
  EXPECT_EQ(code_of(1.0), 2 + 900 * 30);
  EXPECT_EQ(code_of(123456.0), 2 + 900 * 35 + 23);
  EXPECT_EQ(code_of(9.994), 2 + 900 * 30 + 899);
  EXPECT_EQ(code_of(9.996), 2 + 900 * 31);  // rounds to 10.0
  EXPECT_EQ(code_of(0.0125), 2 + 900 * 28 + 25);
  EXPECT_EQ(code_of(9.99e41), 2 + 900 * 71 + 899);
}

TEST(CodeOf, ValuesThatHaveNone) {
  for (const double value : {std::nan(""), -1.0, std::numeric_limits<double>::infinity(), 1e42})
    EXPECT_EQ(code_of(value), 0) << value;
  EXPECT_EQ(code_of(1e-40), 1);
}

TEST(LightOn, CosineBetweenTheSlopeAndTheLight) {
  const double half = std::sqrt(0.5);
  EXPECT_NEAR(light_on(0.0, 0.0), half, 1e-12);    // level: 45 degrees
  EXPECT_NEAR(light_on(half, -half), 1.0, 1e-12);  // 45 degrees steep, faces the north-west: at a right angle
  EXPECT_NEAR(light_on(-half, half), 0.0, 1e-12);  // faces away: along the slope
  EXPECT_NEAR(light_on(1.0, 1.0), std::sqrt(1.0 / 6.0), 1e-12);  // faces the south-west: (0, 0, half) . n
}

TEST(Relief, LevelGroundAtAnyHeight) {
  EXPECT_EQ(relief_of(std::vector<double>(25, 0.0), 5, 2.0, 3.0),
            relief_of(std::vector<double>(25, 700.0), 5, 2.0, 3.0));
}

using MapStyleFile = test::Files;

std::string qml(const std::string& shader) {
  return "<!DOCTYPE qgis><qgis><pipe><rasterrenderer band=\"3\"><rastershader>" + shader +
         "</rastershader></rasterrenderer></pipe></qgis>";
}

TEST_F(MapStyleFile, ClassesOfDiscreteValues) {
  write_text(
      "a.qml",
      qml("<colorrampshader colorRampType=\"DISCRETE\"><item value=\"0\" label=\"0\" color=\"#ffffff\" alpha=\"0\"/>"
          "<item value=\"30\" label=\"up to 30\" color=\"#f0a921\" alpha=\"255\"/><item value=\"inf\" label=\"above\" "
          "color=\"1,2,3,255\"/></colorrampshader>"));
  const auto style = read_map_style(path("a.qml"));
  ASSERT_TRUE(style);
  EXPECT_EQ(style->band, 3);
  ASSERT_EQ(style->classes.size(), 3U);
  EXPECT_EQ(style->class_of(0.0), 0U);
  EXPECT_EQ(style->class_of(30.0), 1U);  // a limit belongs to its class
  EXPECT_EQ(style->class_of(30.1), 2U);
  EXPECT_EQ(style->class_of(std::nan("")), std::nullopt);
  EXPECT_EQ(style->classes[1].colour.green, 0xa9);
  EXPECT_EQ(style->classes[2].colour.blue, 3);
}

TEST_F(MapStyleFile, OpacityFromNothingToFull) {
  std::string items;
  for (const char* alpha : {"-7", "128", "1e300", "inf", "much"})
    items += std::string("<item value=\"1\" color=\"#000000\" alpha=\"") + alpha + "\"/>";
  write_text("c.qml", qml("<colorrampshader colorRampType=\"EXACT\">" + items + "</colorrampshader>"));
  const auto style = read_map_style(path("c.qml"));
  ASSERT_TRUE(style);
  std::vector<int> opacities;
  for (const MapClass& one : style->classes) opacities.push_back(one.colour.opacity);
  EXPECT_EQ(opacities, (std::vector{0, 128, 255, 255, 255}));
}

using Tables = test::Files;

TEST_F(Tables, TheObjectsHitMostOftenOfMany) {  // object i of 12345 is hit (7919 i mod 12345) / 12345 times a year
  std::string table = "object,frequency,frequency_lower,frequency_upper,sources\n";
  for (int i = 0; i < 12345; ++i)
    table += std::to_string(i) + "," + std::to_string(i * 7919L % 12345) + "e-5,0,1,cliff\n";
  write_text("objects.csv", table);
  const ObjectsPart part = read_objects_part(path(""));
  ASSERT_EQ(part.objects.size(), 100U);
  EXPECT_EQ(part.left_out, 12245U);
  for (int i = 0; i < 100; ++i)
    EXPECT_DOUBLE_EQ(part.objects[static_cast<std::size_t>(i)].frequency, 0.12344 - 1e-5 * i);
}

TEST_F(Tables, ObjectsThatWereNotAssessedAreNotCalledSafe) {  // they were hit 0 times a year
  std::string table =
      "object,frequency,frequency_lower,frequency_upper,frequency_30,return_period_30,frequency_30_lower,"
      "frequency_30_upper,sources\n";
  for (int i = 0; i < 102; ++i) table += "gap " + std::to_string(i) + ",,,,,,,,\n";
  write_text("objects.csv", table + "mill,0.5,0.4,0.625,0.25,4,0.2,0.5,cliff\nbarn,0,0,0.1,0,,0,0.05,\n");
  const ObjectsPart part = read_objects_part(path(""));
  EXPECT_EQ(part.not_assessed.size(), 100U);
  EXPECT_EQ(part.thresholds, std::vector<std::string>{"30"});
  ASSERT_EQ(part.objects.size(), 2U);
  const std::string html = objects_html(part, false).text(),
                    why = "</td><td colspan='4'>not assessed: the DEM has no height there</td></tr>\n";
  EXPECT_THAT(html, HasSubstr("<tr><td>gap 99" + why + "<tr><td>2 more objects" + why + "<tr><td>mill</td>"));
  EXPECT_THAT(html, HasSubstr("<td class='n'>2 [1.6 to 2.5]</td><td class='n'>4 [2 to 5]</td>"));
  EXPECT_THAT(html, HasSubstr("<tr><td>barn</td><td class='n'>0 [0, 0.1]</td><td class='n'>no event [10 or more]</td>"
                              "<td class='n'>no event [20 or more]</td>"));
  EXPECT_THAT(html, Not(HasSubstr("Never seen")));
}

TEST_F(Tables, ObjectsHaveTheirClassByName) {
  write_text("objects.csv",
             "object,frequency,frequency_lower,frequency_upper,hazard_class,sources\nmill,0.5,0.4,0.6,2,a\n"
             "barn,0,0,0.1,0,\nodd,0,0,0.1,7,\ngap,,,,,\n");
  const ObjectsPart part = read_objects_part(path(""));
  const std::string html = objects_html(part, false, {"none", "low", "high & steep"}).text();
  EXPECT_THAT(html, HasSubstr("<th>class</th><th>from</th>"));
  EXPECT_THAT(html, HasSubstr("<td>high &amp; steep</td><td>a</td>"));
  EXPECT_THAT(html, HasSubstr("<td>none in this run</td><td></td>"));
  EXPECT_THAT(html, HasSubstr("<td></td><td></td>"));  // a number without a name
  EXPECT_THAT(html, HasSubstr("<td>gap</td><td colspan='4'>"));
  EXPECT_THAT(objects_html(part, false).text(), Not(HasSubstr("<th>class</th>")));
}

TEST_F(Tables, ObjectsThatAreHitOnceInManyYears) {  // refused above 1e15 years
  write_text("objects.csv",
             "object,frequency,frequency_lower,frequency_upper,frequency_30,return_period_30,frequency_30_lower,"
             "frequency_30_upper,sources\nmill,1e-100,0,1e-99,1e-200,1e200,0,1e-199,x\n");
  EXPECT_THAT(objects_html(read_objects_part(path("")), false).text(),
              HasSubstr("<td class='n'>1e+100 [1e+99 or more]</td><td class='n'>1e+200 [1e+199 or more]</td>"));
}

TEST_F(Tables, LargerThanAPageReadsAreLeftOutAndSaid) {
  write_text("objects.csv", "object,frequency,frequency_lower,frequency_upper,sources\nmill,1,0,2,cliff\n");
  write_text("objects_curves.csv", "object,energy_kj,frequency\nmill,10,1\n");
  EXPECT_EQ(read_objects_part(path("")).objects.at(0).curve.size(), 1U);
  std::filesystem::resize_file(path("objects_curves.csv"), kMostPageTable + 1);  // a hole: takes no room
  EXPECT_EQ(read_objects_part(path("")).note, "objects_curves.csv has more than 128 MB: the curves are not drawn.");
  std::filesystem::resize_file(path("objects.csv"), kMostPageTable + 1);
  EXPECT_THAT(objects_html(read_objects_part(path("")), false).text(), HasSubstr("objects are not shown"));
}

TEST_F(MapStyleFile, NoneOfRampsAndOfTextsThatAreNoStyle) {
  EXPECT_EQ(read_map_style(path("missing.qml")), std::nullopt);
  for (const std::string& text : {std::string(), std::string("<qgis>"), std::string("no style"),
                                  qml("<colorrampshader colorRampType=\"INTERPOLATED\"><item value=\"1\" "
                                      "color=\"#000000\"/></colorrampshader>"),
                                  qml("<colorrampshader colorRampType=\"DISCRETE\"><item value=\"nan\" "
                                      "color=\"#00000g\"/></colorrampshader>")}) {
    write_text("b.qml", text);
    EXPECT_FALSE(read_map_style(path("b.qml"))) << text;
  }
}

TEST(Facts, NumbersForReaders) {
  EXPECT_EQ(grouped(47850.0), "47\u00a0850");
  EXPECT_EQ(grouped(999.0), "999");
  EXPECT_EQ(grouped(-1234567.0), "-1\u00a0234\u00a0567");
  EXPECT_EQ(readable(2361.0), "2\u00a0360");
  EXPECT_EQ(readable(0.00123456), "0.00123");
}

/// No markup of the name, in any of the ways in which it could be one.
void expect_tame(const std::string& page) {
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(1)"));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("\x1b")));
  EXPECT_THAT(page, Not(HasSubstr("\u202e")));
}

TEST(Frequency, OfARecord) {
  const FrequencyFacts run = frequency_of(Json::object());
  const FrequencyFacts earlier = frequency_of({{"frequency", {{"file", "w.toml"}, {"replayed", true}}}});
  GivenFrequencies given{"w.toml", "12ab", {}, true, {{"north cliff", 0.25}}, {}};
  given.rules.scale = 0.01, given.rules.exponent = 0.6;
  const FrequencyFacts file = frequency_of({{"frequency", json_of(given, 5.2)}});
  EXPECT_EQ(frequency_text(run), "those of the run (settings, under Record)");
  EXPECT_THAT(frequency_text(earlier), HasSubstr("those in w.toml (what it said is not recorded), which take"));
  EXPECT_THAT(frequency_text(file), HasSubstr("those in w.toml ([frequency] by_true_area = true, power_law = "
                                              "{\"A\":0.01,\"b\":0.6}; [features] north cliff = 0.25; SHA-256 12ab)"));
  given.class_shares = {0.9, 0.1};
  const FrequencyFacts kept = frequency_of({{"frequency", json_of(given, 5.2)}});
  EXPECT_THAT(frequency_text(kept),
              HasSubstr("north cliff = 0.25; the classes of blocks keep their shares of the events; SHA-256 12ab)"));
  const std::string by = "by the annual frequency of its source";
  EXPECT_EQ(other_frequency_note(by, run, run), "");
  EXPECT_EQ(other_frequency_note(by, file, file), "");
  EXPECT_EQ(other_frequency_note(by, earlier, file), "");  // the name is all that is known
  EXPECT_THAT(other_frequency_note(by, run, file),
              HasSubstr("other frequencies than the hazard maps: those of the run"));
  EXPECT_THAT(other_frequency_note(by, kept, file), HasSubstr("other frequencies"));  // the same file, other classes
  EXPECT_EQ(other_frequency_note("alike, as --unweighted asks", run, file), "");
}

TEST(Escaping, EveryFieldOfEverySection) {
  const std::string& h = kHostile;
  ScreensPart screens{{{h, h, h, 1, 1, 1, 1, 1, 1, 2.0, std::vector<double>(30, 1.0)}}, h};
  BarrierPart barrier{h,           h,  5.0,         3.0, {{h, h, h, 1.0}, {"h_i", "m", h, 2.0}, {"V", "m3", h, 1.0}},
                      {{h, h, h}}, {}, {{0, 9, 1}}, {h}};
  ObjectsPart objects{{h}, {{h, h, 0.1, 0.1, 0.2, 0.0, {h}, {{1.0, 0.1}, {2.0, 0.05}}}}, 0, h, {h}};
  const std::optional<FitPart> fit =
      FitPart{h, h, "", {{h, h, 1.0, 0.5, 2.0, false}}, {{h, 1.0, 0.5, 0.6}}, h, {h}, {}};
  for (const Markup& html : {screens_html(screens), barriers_html({barrier}), objects_html(objects, false),
                             fit_html(fit), checks_html({{Check::Mark::Act, h, h, h}})})
    expect_tame(html.text());
  EXPECT_THAT(barriers_html({barrier}).text(),
              HasSubstr("5 crossings (blocks and pieces) of 3 blocks; every block and"));
  barrier.blocks = 5.0;
  EXPECT_THAT(barriers_html({barrier}).text(), Not(HasSubstr("once in [95 %]")));
  barrier.once_in = {{300.0,
                      {29.0, 28.0, 31.0},
                      {0.0, 0.0, 0.25},
                      {0.5, 0.4, 0.6},
                      {7.3, 7.2, std::numeric_limits<double>::infinity()}}};
  EXPECT_THAT(
      barriers_html({barrier}).text(),
      HasSubstr(
          "<td>300 years</td><td>29 [28, 31]</td><td>0 [0, 0.25]</td><td>0.5 [0.4, 0.6]</td><td>7.3 [7.2, ?]</td>"));
  EXPECT_THAT(barriers_html({barrier}).text(), HasSubstr("5 blocks cross the line; every block counts"));
  EXPECT_THAT(page_of({h, h, h}, Markup() + h), HasSubstr("<title>Talus: &lt;script&gt;"));
}

TEST(BarrierNotes, OfAllBarriersAreToldOnce) {
  const auto count = [](const std::string& text, const std::string& word) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  BarrierPart north, south;
  north.screen = "north", south.screen = "south";
  north.notes = {"of the run", "of the north"};
  south.notes = {"of the south", "of the run"};
  const std::string page = barriers_html({north, south}).text();
  for (const char* note : {"Note: of the run<", "Note: of the north<", "Note: of the south<"})
    EXPECT_EQ(count(page, note), 1U) << note;
  EXPECT_LT(page.find("of the run"), page.find("Barrier at north"));
  EXPECT_EQ(count(barriers_html({north}).text(), "Note: of the run<"), 1U);
}

/// An object whose larger part is not assessed looks safe in no cell of its row.
TEST(ObjectsTable, SaysWhatIsNotAssessed) {
  ObjectsPart::Object object{"km 1.6", "cliff", 0.0, 0.0, std::nullopt, 0.67, {"not known"}, {}};
  object.hazard_class = {0, 0, std::nullopt};
  const auto text = [&] {
    ObjectsPart part;
    part.thresholds = {"30"};
    part.objects = {object};
    return objects_html(part, false, {"none", "low", "high"}).text();
  };
  EXPECT_THAT(text(), HasSubstr("<tr><td>km 1.6 (67 % of it not assessed: the DEM has no height there)</td>"
                                "<td class='n'>0 [0 or more]</td><td class='n'>not known</td>"));
  EXPECT_THAT(text(), HasSubstr("<td>none or higher in this run</td>"));
  object.frequency = 0.1, object.low = 0.05;
  EXPECT_THAT(text(), HasSubstr("0.1 [0.05 or more]</td><td class='n'>10 [20 or less]</td>"));
  object.high = 0.2, object.hazard_class.high = 1;
  EXPECT_THAT(text(),
              HasSubstr("<tr><td>km 1.6</td><td class='n'>0.1 [0.05, 0.2]</td><td class='n'>10 [5 to 20]</td>"));
}

TEST(Escaping, ValuesOfAttributesOfMaps) {
  MapSheet sheet;
  sheet.window = {0, 0, 10, 10, 1};
  sheet.pixel_x = sheet.pixel_y = 1.0;
  sheet.north = 10.0;
  ReportMap map{kHostile, kHostile, kHostile, {1, false, {{1.0, kHostile, {}}}}, kHostile, kHostile};
  map.classes_only = map.in_print = true;
  sheet.maps.push_back(map);
  sheet.objects.list.push_back({kHostile, {{2.0, 2.0}, {3.0, 3.0}}, true});
  RunFacts run;
  run.screens.push_back({kHostile, {{{1.0, 1.0}, {9.0, 9.0}}}});
  const MapImprint imprint{kHostile, kHostile, kHostile};
  const std::string page = (map_store(sheet, run, imprint) + map_viewer(sheet) + map_figures(sheet, imprint)).text();
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("data-title=\"&lt;script&gt;alert(1)&lt;/script&gt;&amp;amp;&#39;&quot;"));
  EXPECT_THAT(page, HasSubstr("data-classes=\"[[1.0,&quot;&lt;script"));
  EXPECT_THAT(page, HasSubstr("href=\"&lt;script"));
}

TEST(PageFrame, PolicyAllowsNothingButItsOwnScript) {
  const std::string plain = page_of({"diagnose", "a", "b"}, {});
  EXPECT_THAT(plain, HasSubstr("default-src 'none'"));
  EXPECT_THAT(plain, Not(HasSubstr("script-src")));
  // echo -n 'let a = 1;' | openssl dgst -sha256 -binary | base64
  EXPECT_THAT(page_of({"report", "a", "b", "let a = 1;"_html}, {}),
              HasSubstr("script-src 'sha256-xY6QKfH9PRsQnLz56nj6MBwiK5oHg+im1Jkpdp1x/Ck='"));
}

}  // namespace
}  // namespace talus::io
