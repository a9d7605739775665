#include "io/files/own_files.hpp"

#include <algorithm>

#include "files.hpp"

namespace talus::io::test {

class OwnFiles : public Files {
 protected:
  /// Writes a file into a folder below the folder of the test.
  void file(const std::string& name, const std::string& text = "") {
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    write_text(name, text);
  }
  std::vector<std::string> foreign() const { return foreign_in(path("out")); }
};

using Names = std::vector<std::string>;

TEST_F(OwnFiles, OfARunAreThoseThatItsRecordsList) {
  file("out/run.json", R"({"files": ["energy.tif", "energy.qml", "../mine.txt", 7]})");
  file("out/hazard.json", R"({"files": ["hazard_class.tif"]})");
  for (const char* name : {"energy.tif", "energy.qml", "hazard_class.tif", "energy.tif.aux.xml", "barrier_road.csv",
                           "barrier_road_stretches.csv", "barrier_road.gpkg", ".DS_Store", ".hazard.talus-17/a.tif",
                           "unfinished/part.json"})
    file(std::string("out/") + name);
  file("out/barrier_road.json", R"({"program": "talus", "screen": "road"})");
  EXPECT_EQ(foreign(), Names{});
  for (const char* name : {"barrier_mine.json", "barrier_mine.csv", ".sub.talus-17/unfinished/part.json", "mine.txt",
                           "velocity.tif", "velocity.tif.aux.xml", "barrier_notes.csv", "fitted.toml", ".git/config",
                           "photos/a.jpg", "tally-1", "energy.tif.bak"})
    file(std::string("out/") + name);
  EXPECT_EQ(foreign(), (Names{".git/", ".sub.talus-17/", "barrier_mine.csv", "barrier_mine.json", "barrier_notes.csv",
                              "energy.tif.bak", "fitted.toml", "mine.txt", "photos/", "tally-1", "velocity.tif",
                              "velocity.tif.aux.xml"}));
  std::filesystem::remove(path("out/energy.tif"));
  std::filesystem::create_directory(path("out/energy.tif"));  // a folder is none of the files of a run
  EXPECT_EQ(foreign()[5], "energy.tif.bak");
  EXPECT_EQ(foreign()[6], "energy.tif/");
}

TEST_F(OwnFiles, PagesOfTheReportByWhatTheyHold) {
  const std::string page = R"(<!doctype html><meta name="generator" content="talus report">)";
  file("out/run.json", "{}");
  file("out/report.html", page);
  file("out/for the canton.html", page);
  file("out/page.txt", page);
  file("out/mine.html", "<p>mine</p>");
  EXPECT_EQ(foreign(), (Names{"mine.html", "page.txt"}));
  EXPECT_EQ(later_results(path("out")), (Names{"for the canton.html", "report.html"}));
  file("out/hazard.json", R"({"files": ["hazard_class.tif"]})");
  file("out/energy.tif");
  file("out/barrier_road.json", R"({"program": "talus", "screen": "road"})");
  const Names later = later_results(path("out"));
  for (const char* name : {"hazard_class.tif", "barrier_road.json", "report.html"})
    EXPECT_EQ(std::ranges::count(later, name), 1) << name;
  EXPECT_EQ(later.size(), 4U);
}

TEST_F(OwnFiles, OfPartsAndFitsAreKnownByTheirNames) {
  for (const char* name :
       {"part.json", "scenario.toml", ".lock", "tally-1-0.bin", "rows-1-0.bin", "rest-2.bin", "reach-0.bin"})
    file(std::string("out/") + name);
  EXPECT_EQ(foreign(), Names{});
  file("out/report.md");
  EXPECT_EQ(foreign(), Names{"report.md"});
  for (const char* name : {"part.json", "scenario.toml", "tally-1-0.bin", "rows-1-0.bin", "rest-2.bin", "reach-0.bin"})
    std::filesystem::remove(path(std::string("out/") + name));
  for (const char* name : {"calibration.json", "fitted.toml", "alder/fitted.toml", "alder/with_effect.toml"})
    file(std::string("out/") + name);
  EXPECT_EQ(foreign(), Names{});
  file("out/alder/notes.txt");
  EXPECT_EQ(foreign(), Names{"alder/"});
}

TEST_F(OwnFiles, WhatReadersLeaveBesideAFileIsRemovedWithoutTheFile) {
  for (const char* name : {"a.tif", "a.tif.aux.xml", "a.tif.ovr", "b.gpkg", "b.gpkg-wal", "b.gpkg-shm",
                           "b.gpkg-journal", "c.gpkg-wal", "b.gpkg.bak"})
    file(std::string("out/") + name);
  remove_beside(path("out/a.tif"), {"a.tif.aux.xml"});
  remove_beside(path("out/b.gpkg"));
  Names left;
  for (const auto& entry : std::filesystem::directory_iterator(path("out")))
    left.push_back(entry.path().filename().string());
  std::ranges::sort(left);
  EXPECT_EQ(left, (Names{"a.tif", "a.tif.aux.xml", "b.gpkg", "b.gpkg.bak", "c.gpkg-wal"}));
}

}  // namespace talus::io::test
