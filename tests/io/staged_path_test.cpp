#include "talus/io/files/staged_path.hpp"

#include <unistd.h>

#include "files.hpp"
#include "talus/io/files/output_folder.hpp"

namespace talus::io {
namespace {

namespace fs = std::filesystem;

class Staged : public test::Files {
 protected:
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path(""))) names.push_back(entry.path().filename().string());
    return names;
  }
  const std::string pid_ = std::to_string(getpid());
};

TEST_F(Staged, AFileAppearsAtOnceOrNotAtAll) {
  {
    const StagedPath staged(StagedPath::Kind::File, path("map.tif"), ".tif");
    EXPECT_EQ(staged.hidden(), path(".map.talus-" + pid_ + ".tif"));
    write_text(staged.hidden().filename().string(), "half");
  }
  EXPECT_TRUE(names().empty());
  StagedPath staged(StagedPath::Kind::File, path("map.tif"), ".tif");
  write_text(staged.hidden().filename().string(), "whole");
  EXPECT_FALSE(staged.commit());
  EXPECT_EQ(names(), std::vector<std::string>{"map.tif"});
}

TEST_F(Staged, AFolderOfAnotherIsNeitherTakenNorRemoved) {
  fs::create_directory(path(".out.talus-" + pid_));  // of a process of the same number, on another machine
  { const StagedPath never_made(StagedPath::Kind::Folder, path("out")); }
  {
    StagedPath staged(StagedPath::Kind::Folder, path("out"));
    EXPECT_FALSE(staged.make_folder());
    EXPECT_EQ(staged.hidden(), path(".out.talus-" + pid_ + "-1"));
  }
  EXPECT_EQ(names(), std::vector<std::string>{".out.talus-" + pid_});
}

TEST_F(Staged, WhatIsKeptStays) {
  {
    StagedPath staged(StagedPath::Kind::Folder, path("run.2"));
    EXPECT_FALSE(staged.make_folder());
    staged.keep();
  }
  EXPECT_EQ(names(), std::vector<std::string>{".run.2.talus-" + pid_});
}

TEST_F(Staged, AFolderThatCannotBeWrittenIsNamed) {  // of another user: tests/cli/faults_test.py
  EXPECT_NO_THROW(refuse_unwritable(path("")));
  EXPECT_NO_THROW(refuse_unwritable(""));
  test::expect_input_error([&] { refuse_unwritable(path("none")); },
                           {path("none") + ": nothing can be written there (No such file or directory)"});
}

TEST_F(Staged, AFileThatCannotBeWrittenIsCalledByItsName) {
  try {
    replace_text(path("none/run.json"), "{}");
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "run.json: cannot be written: No such file or directory");
  }
}

TEST_F(Staged, SaysWhyANameCannotBeGiven) {
  StagedPath staged(StagedPath::Kind::File, path("taken"));
  write_text(staged.hidden().filename().string(), "");
  fs::create_directory(path("taken"));
  EXPECT_TRUE(staged.commit());
}

}  // namespace
}  // namespace talus::io
