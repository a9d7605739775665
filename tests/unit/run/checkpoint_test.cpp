#include "talus/run/checkpoint.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "io/scenario/scenario_spec.hpp"
#include "run/checkpoint_tally.hpp"
#include "support/scenarios.hpp"
#include "talus/base/error.hpp"

namespace talus::run {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kSources = 3, kTrajectories = 300;  // three units of work to a source

LoadedScenario loaded(std::uint64_t seed = 1) {
  LoadedScenario out;
  Scenario scenario = test::rough_slope(kSources, kTrajectories);
  scenario.seed = seed;
  auto spec = std::make_shared<io::ScenarioSpec>();
  spec->values.seed = seed;
  spec->values.trajectories = kTrajectories;
  out.spec = std::move(spec);
  out.scenario = make_scenario(std::move(scenario));
  out.settings = {{"trajectories", std::to_string(kTrajectories), "1", "scenario"}};
  return out;
}

Tally tally_of(const Scenario& s) {
  return {s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds};
}

/// A run in a folder of its own, with the blocks that stopped, in the order of their rows.
class CheckpointOfARun : public testing::Test {
 protected:
  CheckpointOfARun()
      : folder_(fs::temp_directory_path() / ("talus-checkpoint-" + std::to_string(getpid()) + "-" +
                                             testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~CheckpointOfARun() override { fs::remove_all(folder_); }

  /// Traces the next units of work and saves them. Returns whether the round is done.
  bool session(const LoadedScenario& plan, bool first, int units) {
    Tally tally = tally_of(plan.scenario);
    Checkpoint checkpoint = first ? Checkpoint(folder_, plan, {}, {}) : Checkpoint::opened(folder_, plan, true);
    Sinks sinks = checkpoint.sinks();
    int traced = 0;
    sinks.pause = [&] { return ++traced >= units; };
    Simulation simulation(plan.scenario, {}, false, tally, sinks);
    checkpoint.restore(simulation, tally);
    simulation.advance(1, 1);  // in lanes blocks of the next units are on their way at a pause
    if (simulation.round_done()) checkpoint.end_round(0);
    checkpoint.save(simulation, tally);
    return simulation.round_done();
  }

  /// Changes one byte in the middle of a file.
  void damage(const fs::path& file) const {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    const auto middle = static_cast<std::streamoff>(fs::file_size(file) / 2);
    stream.seekg(middle);
    const int byte = stream.get();
    stream.seekp(middle);
    stream.put(static_cast<char>(byte ^ 1));
  }

  fs::path file_named(const std::string& beginning) const {
    for (const auto& entry : fs::directory_iterator(folder_))
      if (entry.path().filename().string().starts_with(beginning)) return entry.path();
    return {};
  }

  fs::path folder_;
};

/// Counts that a small run leaves at 0.
TEST(CheckpointTotals, KeepTheirCounts) {
  Totals totals;
  totals.left_blocks = 3;
  totals.limited_blocks = 5;
  totals.first_limit = {7, 8};
  ByteWriter out;
  put_totals(totals, out);
  ByteReader in(out.bytes());
  const Totals again = get_totals(Barriers(std::vector<Barrier>{}), in);
  EXPECT_EQ(again.left_blocks, 3U);
  EXPECT_EQ(again.limited_blocks, 5U);
  EXPECT_EQ(again.first_limit, (std::array<std::uint32_t, 2>{7, 8}));
}

TEST_F(CheckpointOfARun, EndsAsARunWithoutAPause) {
  const LoadedScenario plan = loaded();
  Tally whole = tally_of(plan.scenario);
  std::vector<std::uint64_t> expected_rows, rows;
  const auto collect = [](std::vector<std::uint64_t>& out) {
    Sinks sinks;
    sinks.stops = [&out](std::span<const StopRow> some) {
      for (const StopRow& row : some) out.push_back(std::uint64_t{row.source} * kTrajectories + row.block);
    };
    return sinks;
  };
  const Sinks uninterrupted = collect(expected_rows);
  Simulation simulation(plan.scenario, {}, false, whole, uninterrupted);
  simulation.advance(1);
  int sessions = 1;
  for (bool done = session(plan, true, 2); !done; ++sessions) done = session(plan, false, 2);
  EXPECT_GE(sessions, 4) << "nine units of work, two at a time";
  const Checkpoint checkpoint = Checkpoint::opened(folder_, plan, false);
  Tally tally = tally_of(plan.scenario);
  const Totals totals = checkpoint.add_to(tally);
  checkpoint.replay(0, collect(rows));
  test::expect_same_records(tally, whole);
  EXPECT_EQ(totals.ends, simulation.totals().ends);
  EXPECT_EQ(totals.left_blocks, simulation.totals().left_blocks);
  EXPECT_EQ(totals.limited_blocks, simulation.totals().limited_blocks);
  EXPECT_EQ(totals.first_limit, simulation.totals().first_limit);
  EXPECT_EQ(totals.length_mm, simulation.totals().length_mm);
  EXPECT_EQ(rows.size(), plan.scenario.released());
  EXPECT_EQ(rows, expected_rows);
}

TEST_F(CheckpointOfARun, KeepsWhatWasSaidOfItsPlan) {
  LoadedScenario begun = loaded(), now = loaded();
  begun.warnings = {"fitted on cells of 0.5 m"};
  begun.notes = {"fields read: name"};
  begun.inputs = {{"scenario", "/a/s.toml", "1"}, {"include", "/a/f.toml", "2"}, {"dem", "/a/dem.tif", "3"}};
  session(begun, true, 2);
  now.warnings = {"another"};
  now.inputs = {{"scenario", "/b/part/scenario.toml", "4"}, {"dem", "/b/dem.tif", "3"}};
  begun.inputs.erase(begun.inputs.begin(), begun.inputs.begin() + 2);
  Checkpoint::opened(folder_, begun, false).recall(now, 2);  // the plan has the content of the DEM
  EXPECT_EQ(now.warnings, begun.warnings);
  EXPECT_EQ(now.notes, begun.notes);
  ASSERT_EQ(now.inputs.size(), 3U);
  EXPECT_EQ(now.inputs[0].path, "/a/s.toml");
  EXPECT_EQ(now.inputs[1].sha256, "2");
  EXPECT_EQ(now.inputs[2].path, "/b/dem.tif");  // where it was read now
  ASSERT_EQ(now.settings.size(), 1U);
  EXPECT_EQ(now.settings[0].value, std::to_string(2 * kTrajectories));
}

TEST_F(CheckpointOfARun, OfADamagedFileIsRefused) {
  const LoadedScenario plan = loaded();
  for (const char* name : {"tally-", "rest-", "reach-", "rows-"}) {
    for (const auto& entry : fs::directory_iterator(folder_)) fs::remove(entry.path());
    session(plan, true, 2);
    const fs::path file = file_named(name);
    ASSERT_FALSE(file.empty()) << name;
    damage(file);
    const auto read_all = [&] {
      const Checkpoint checkpoint = Checkpoint::opened(folder_, plan, false);
      Tally tally = tally_of(plan.scenario);
      const Sinks none;
      Simulation simulation(plan.scenario, {}, false, tally, none);
      checkpoint.restore(simulation, tally);
      checkpoint.replay(0, none);
    };
    EXPECT_THROW(read_all(), InputError) << name;
  }
}

TEST_F(CheckpointOfARun, OfADamagedManifestOrAnotherPlanIsRefused) {
  const LoadedScenario plan = loaded(1);
  session(plan, true, 2);
  EXPECT_NO_THROW(Checkpoint::opened(folder_, plan, false));
  EXPECT_THROW(Checkpoint::opened(folder_, loaded(2), false), InputError);
  damage(folder_ / kCheckpointManifest);
  EXPECT_THROW(Checkpoint::opened(folder_, plan, false), InputError);
}

}  // namespace
}  // namespace talus::run
