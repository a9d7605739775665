#include "talus/io/results/hazard_file.hpp"

#include <gdal.h>

#include <fstream>
#include <limits>

#include "io/files/own_files.hpp"
#include "io/reports/report_facts.hpp"
#include "scenario_files.hpp"
#include "talus/io/files/staged_files.hpp"
#include "talus/io/results/hazard_record.hpp"
#include "talus/io/results/weighting_file.hpp"
#include "talus/io/scenario/plan_checksum.hpp"
#include "talus/products/object_width.hpp"
#include "talus/simulate/simulate.hpp"

namespace talus::io {
namespace {

using test::expect_input_error;

class HazardFile : public test::ScenarioFile {
 protected:
  HazardFile() : loaded_(of_law("[frequency]\npower_law = { A = 0.1, b = 0.5 }\n")) {
    tally_.keep_hazard(*AnnualWeights::of(loaded_.scenario));
    totals_ = simulate(loaded_.scenario, tally_, {}, 1);
    write_hazard(path(kHazardFile), loaded_, tally_, totals_.left_weight);
  }
  LoadedScenario of_law(const std::string& rest) {
    return load(std::string(kFiles) + "[blocks]\ndiameter = { volume_min = 0.1, volume_max = 10, exponent = 0.5 }\n" +
                rest);
  }
  std::string bytes() {
    std::ifstream file(path(kHazardFile), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void refused(const std::string& bytes, const std::string& words) {
    std::ofstream(path("other.gz"), std::ios::binary) << bytes;
    expect_input_error(
        [&] {
          read_hazard(
              path("other.gz"), [](const auto&) {}, [](const auto&) {});
        },
        {"other.gz: ", words});
  }
  /// A text as gzip, packed by the library that reads it.
  std::string packed(const std::string& text) {
    VSILFILE* file = VSIFOpenL(("/vsigzip/" + path("packed.gz")).c_str(), "wb");
    VSIFWriteL(text.data(), 1, text.size(), file);
    VSIFCloseL(file);
    std::ifstream back(path("packed.gz"), std::ios::binary);
    return {std::istreambuf_iterator<char>(back), {}};
  }

  /// The content of the file of the run.
  std::string unpacked() {
    std::string plain(1U << 20U, ' ');
    VSILFILE* file = VSIFOpenL(("/vsigzip/" + path(kHazardFile)).c_str(), "rb");
    plain.resize(VSIFReadL(plain.data(), 1, plain.size(), file));
    VSIFCloseL(file);
    return plain;
  }

  LoadedScenario loaded_;
  Totals totals_;
  Tally tally_{loaded_.scenario.surface.grid(), loaded_.scenario.output.energy_thresholds,
               loaded_.scenario.output.height_thresholds};
};

TEST_F(HazardFile, ReadsBackWhatWasKept) {
  std::uint64_t cells = 0, exits = 0;
  int rows = 0;
  const Raster<float>& heights = loaded_.scenario.surface.heights();
  const HazardHeader header = read_hazard(
      path(kHazardFile), [](const auto&) {},
      [&](const HazardRow& row) {
        ++rows;
        for (int column = 0; column < heights.grid.columns; ++column)
          EXPECT_EQ(row.terrain[static_cast<std::size_t>(column)], !std::isnan(heights.at(column, row.row)));
        for (const auto& [column, cell, exit] : row.touched) {
          ++cells;
          exits += exit ? 1U : 0U;
          EXPECT_EQ(exit, tally_.find(column, row.row)->exits > 0);
          ASSERT_NE(tally_.hazard(column, row.row), nullptr);
          EXPECT_EQ(cell, *tally_.hazard(column, row.row));
        }
      });
  EXPECT_GT(cells, 0U);
  EXPECT_EQ(cells, tally_.touched_cells());
  EXPECT_EQ(rows, heights.grid.rows);
  EXPECT_EQ(header.plan, plan_checksum(loaded_));
  EXPECT_EQ(header.rules.scale, tally_.hazard_rules().scale);
  EXPECT_EQ(header.rules.bins.thresholds(), loaded_.scenario.output.energy_thresholds);
  EXPECT_EQ(header.geo.crs_wkt, loaded_.geo.crs_wkt);
  EXPECT_EQ(header.geo.west, loaded_.geo.west);
  EXPECT_EQ(header.geo.north, loaded_.geo.north);
  EXPECT_EQ(header.left_weight, totals_.left_weight);
  EXPECT_EQ(exits > 0, totals_.left_weight > 0);
  HazardHeader heavy = header;  // classes that were drawn more often than expected: no more can leave than fall
  heavy.left_weight = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(left_per_year(heavy), header.rules.scale.total);
}

/// Another format, so that earlier versions of Talus do not read energies with rotation as translational ones.
TEST_F(HazardFile, SaysWhetherEnergiesCountTheRotation) {
  EXPECT_FALSE(read_hazard_header(path(kHazardFile)).rules.with_rotation);
  EXPECT_EQ(unpacked()[12], '\x03');
  tally_.count_rotation();
  write_hazard(path(kHazardFile), loaded_, tally_, totals_.left_weight);
  EXPECT_TRUE(read_hazard_header(path(kHazardFile)).rules.with_rotation);
  EXPECT_EQ(unpacked()[12], '\x04');
}

TEST_F(HazardFile, TheSameBytesAgain) {
  const std::string first = bytes();
  write_hazard(path(kHazardFile), loaded_, tally_, totals_.left_weight);
  EXPECT_EQ(bytes(), first);
}

TEST_F(HazardFile, DamagedForeignOrLaterFilesAreRefused) {
  const std::string whole = bytes();
  refused(whole.substr(0, whole.size() / 2), "is damaged");
  std::string changed = whole;
  changed[changed.size() / 2] = static_cast<char>(changed[changed.size() / 2] ^ 4);
  refused(changed, "is damaged");
  std::string plain = unpacked();
  ASSERT_LT(plain.size(), 1U << 20U);
  plain[plain.size() - 80] = static_cast<char>(plain[plain.size() - 80] ^ 1);  // packed well, but another number
  refused(packed(plain), "is damaged");
  refused(packed("something else altogether"), "is no file that talus run wrote");
  refused(packed(std::string("talus-hazard") + std::string("\x05\0\0\0", 4)), "later version of Talus (format 5, this");
  refused(packed(std::string("talus-hazard") + std::string("\x01\0\0\0", 4)), "earlier version of Talus (format 1,");
  refused("", "is");
}

/// A header with a number that no run writes is refused before anything is made of it.
TEST_F(HazardFile, ImpossibleHeadersAreRefused) {
  const std::string whole = unpacked();
  for (const auto& [key, value] : std::initializer_list<std::pair<std::string, std::string>>{
           {"total", "0"}, {"largest", "0"}, {"trajectories", "0"}, {"largest_diameter", "-1"}}) {
    std::string plain = whole;
    const std::size_t from = plain.find('"' + key + "\":") + key.size() + 3, size = plain.find(',', from) - from;
    ASSERT_GT(size, value.size()) << key;
    plain.replace(from, size, std::string(size - value.size(), ' ') + value);  // the header keeps its length
    std::ofstream(path("other.gz"), std::ios::binary) << packed(plain);
    bool begun = false;
    expect_input_error(
        [&] {
          read_hazard(
              path("other.gz"), [&](const auto&) { begun = true; }, [](const auto&) {});
        },
        {"is damaged"});
    EXPECT_FALSE(begun) << key;
  }
}

TEST_F(HazardFile, ThePlanChangesWithEverySetting) {
  const LoadedScenario other = of_law("[frequency]\npower_law = { A = 0.2, b = 0.5 }\n");
  EXPECT_NE(plan_checksum(other), plan_checksum(loaded_));
  const std::string again = write_text("again.toml", loaded_.complete_toml);
  RunFlags flags;
  flags.scenario = again;
  EXPECT_EQ(plan_checksum(load_scenario(flags)), plan_checksum(loaded_)) << "OUT/scenario.toml is the same plan";
}

TEST_F(HazardFile, FrequencyKeys) {
  EXPECT_EQ(loaded_.scenario.frequency.scale, 0.1);
  EXPECT_EQ(origin(loaded_, "frequency.power_law"), "scenario");
  const std::string blocks = std::string(kFiles) + "[blocks]\ndiameter = 1.2\n[frequency]\n";
  ScenarioFile::refused(blocks + "per_area = -1\n",
                        {"scenario.toml:7: frequency.per_area = -1", "0 to 1000 1/(m2 year)"});
  ScenarioFile::refused(blocks + "power_law = 3\n", {"frequency.power_law", "must be a table like { A"});
  ScenarioFile::refused(blocks + "power_law = { A = 1 }\n", {"has no b"});
  ScenarioFile::refused(blocks + "by_true_area = 1\n", {"must be true or false"});
  ScenarioFile::refused(blocks + "by_true_aera = true\n", {"did you mean 'by_true_area'"});
  ScenarioFile::refused(blocks + "per_area = 0.5\n", {"a source is a point, which has no area"});
}

/// N(>= V) = A V^-b with b = 1/3 over 1 to 2 m and 2 to 4 m is 1/D: 1 - 1/2 to 1/2 - 1/4, thus 2 : 1.
TEST_F(HazardFile, AnotherWeightingKeepsTheClassesOfAPowerLaw) {
  LoadedScenario run = load(std::string(kFiles) +
                            "[blocks]\ndiameter = [{ diameter = [1, 2] }, { diameter = [2, 4], weight = 9 }]\n"
                            "[frequency]\npower_law = { A = 0.1, b = 0.3333333333333333 }\n");
  Scenario again = run.scenario;
  const GivenFrequencies given = apply_weighting(write_text("w.toml", "[frequency]\ntotal = 6\n"), run.scenario);
  ASSERT_EQ(given.class_shares.size(), 2U);
  EXPECT_NEAR(given.class_shares[0], 2.0 / 3.0, 1e-12);
  EXPECT_EQ(class_shares_text(given), "the classes of blocks keep their shares of the events: 67 %, 33 %");
  EXPECT_NEAR(AnnualWeights::of(run.scenario)->scale().total, 6.0, 1e-9);
  const GivenFrequencies law =
      apply_weighting(write_text("w.toml", "[frequency]\npower_law = { A = 0.2, b = 0.5 }\n"), again);
  EXPECT_TRUE(law.class_shares.empty());  // it says how often each class comes
  EXPECT_EQ(class_shares_text(law), "");
}

TEST_F(HazardFile, Matrix) {
  const HazardMatrix m = read_matrix(write_text(
      "m.toml", "energies = [100]\nyears = [50]\nclasses = [[1, 0], [2, 1]]\nnames = [\"-\", \"a\", \"b\"]\n"));
  EXPECT_EQ(m.energies, std::vector<double>{100.0});
  EXPECT_EQ(m.classes, (std::vector<std::vector<int>>{{1, 0}, {2, 1}}));
  EXPECT_EQ(m.names[2], "b");
  const auto wrong = [&](const std::string& text, const std::vector<std::string>& parts) {
    expect_input_error([&] { read_matrix(write_text("m.toml", text)); }, parts);
  };
  wrong("energys = [30]\n", {"m.toml:1", "did you mean 'energies'"});
  wrong("years = [30]\n", {"m.toml", "classes: must be 3 rows"});
  wrong("energies = [300, 30]\n", {"m.toml: energies = [300, 30]:", "ascend"});
  wrong("energies = [10, 30, 300]\n",
        {"classes: must be 4 rows", "the file has none, and the default has 3 rows of 4"});
  wrong("classes = [[1.5]]\n", {"must be a whole number"});
}

TEST_F(HazardFile, StagedFilesReplaceOnlyTheirOwn) {
  const std::filesystem::path out(path("out"));
  std::filesystem::create_directory(out);
  expect_input_error([&] { StagedFiles(out, "hazard.json", false); }, {"no run.json"});
  std::ofstream(out / "run.json") << "{}";
  const auto put = [&](const std::string& name, const std::string& text) {
    StagedFiles staged(out, "hazard.json", true);
    std::ofstream(staged.temporary() / name) << text;
    std::ofstream(staged.temporary() / "hazard.json") << "{\"files\": [\"" << name << "\"]}";
    staged.commit();
  };
  put("a.tif", "1");
  EXPECT_TRUE(std::filesystem::exists(out / "a.tif"));
  expect_input_error([&] { StagedFiles(out, "hazard.json", false); }, {"--overwrite"});
  put("b.tif", "2");
  EXPECT_FALSE(std::filesystem::exists(out / "a.tif"));
  EXPECT_TRUE(std::filesystem::exists(out / "b.tif"));
  {
    StagedFiles staged(out, "hazard.json", true);
    std::ofstream(staged.temporary() / "c.tif") << "3";
  }  // never committed
  std::size_t left = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(out)) ++left;
  EXPECT_EQ(left, 3U) << "run.json, hazard.json, b.tif";
}

TEST_F(HazardFile, StagedFilesAreWrittenByOneProcessAtATime) {
  namespace fs = std::filesystem;
  const fs::path out(path("out")), killed = out / ".hazard.talus-1", other = out / ".hazard.talus-2";
  for (const fs::path& folder : {killed, other}) fs::create_directories(folder);
  std::ofstream(out / "run.json") << "{}";
  std::ofstream(killed / ".lock");  // that nobody holds
  {
    const StagedFiles first(out, "hazard.json", true);
    expect_input_error([&] { StagedFiles(out, "hazard.json", true); }, {"another process is writing its hazard.json"});
    EXPECT_TRUE(fs::exists(first.temporary()));
    EXPECT_TRUE(first.files().empty()) << "the lock is none of the results";
  }
  EXPECT_FALSE(fs::exists(killed));
  EXPECT_TRUE(fs::exists(other));
}

/// Whatever stops a replacement halfway: of each file the earlier or the new one is still there.
TEST_F(HazardFile, AStoppedReplacementLosesNoFile) {
  const std::filesystem::path out(path("out"));
  std::filesystem::create_directories(out / "b.tif" / "in the way");
  std::ofstream(out / "run.json") << "{}";
  std::ofstream(out / "a.tif") << "earlier";
  std::ofstream(out / "c.tif") << "earlier";
  std::ofstream(out / "hazard.json") << R"({"files": ["a.tif", "b.tif", "c.tif"]})";
  std::filesystem::path hidden;
  {
    StagedFiles staged(out, "hazard.json", true);
    hidden = staged.temporary();
    for (const char* name : {"a.tif", "b.tif", "c.tif", "hazard.json"}) std::ofstream(hidden / name) << "new";
    EXPECT_THROW(staged.commit(), std::runtime_error);  // b.tif cannot replace a folder
  }
  const auto text_of = [](const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string text;
    stream >> text;
    return text;
  };
  EXPECT_EQ(text_of(out / "a.tif"), "new");
  EXPECT_EQ(text_of(out / "c.tif"), "earlier");
  for (const char* name : {"b.tif", "c.tif", "hazard.json"}) EXPECT_EQ(text_of(hidden / name), "new") << name;
  EXPECT_EQ(files_of_record(out / "hazard.json"), (std::vector<std::string>{"a.tif", "b.tif", "c.tif"}));
  expect_input_error([&] { read_hazard_facts(out, {}); }, {"hazard.json", "incomplete", "--overwrite"});
  std::filesystem::remove_all(out / "b.tif");
  StagedFiles again(out, "hazard.json", true);  // the incomplete record says what may be replaced
  for (const char* name : {"a.tif", "d.tif"}) std::ofstream(again.temporary() / name) << "repaired";
  std::ofstream(again.temporary() / "hazard.json") << R"({"files": ["a.tif", "d.tif"]})";
  again.commit();
  EXPECT_EQ(text_of(out / "a.tif"), "repaired");
  EXPECT_FALSE(std::filesystem::exists(out / "c.tif"));
  EXPECT_EQ(files_of_record(out / "hazard.json"), (std::vector<std::string>{"a.tif", "d.tif"}));
}

}  // namespace
}  // namespace talus::io
