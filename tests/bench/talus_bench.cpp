// Speed of the engine on one slope: talus-bench DEM SOURCES [Google Benchmark's options].
// tools/scripts/studies/benchmark.py makes the slope that all figures are measured on, and compares with the sketch and
// the floor.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "talus/base/memory.hpp"
#include "talus/io/results/write_vectors.hpp"
#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/physics/flight.hpp"
#include "talus/physics/tracer.hpp"
#include "talus/simulate/plan/plan.hpp"
#include "talus/simulate/simulate.hpp"

namespace {

using namespace talus;

std::optional<io::LoadedScenario> g_loaded;  // read once, before the benchmarks

Scenario& scenario_with(std::int64_t trajectories) {
  g_loaded->scenario.trajectories = static_cast<std::uint32_t>(trajectories);
  return g_loaded->scenario;
}

/// Trace, tally and merge with every raster on.
void run_with(benchmark::State& state, int threads, int lanes) {
  if (lanes > most_lanes()) return state.SkipWithError("this processor has fewer lanes");
  const Scenario& scenario = scenario_with(state.range(0));
  for (auto _ : state) {
    Tally tally(scenario.surface.grid(), {30.0, 300.0, 500.0}, {1.0, 2.0, 4.0});
    const auto start = std::chrono::steady_clock::now();
    const Totals totals = simulate(scenario, tally, {}, threads, lanes);
    state.counters["wall_s"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double n = static_cast<double>(totals.released), cpu = totals.cpu_seconds;
    state.SetIterationTime(cpu);
    state.counters["plan_Mm_per_cpu_s"] = 1e-9 * static_cast<double>(totals.plan_length_mm) / cpu;
    state.counters["Mm_per_cpu_s"] = 1e-9 * static_cast<double>(totals.length_mm) / cpu;
    state.counters["us_per_trajectory"] = 1e6 * cpu / n;
    state.counters["cells_per_trajectory"] = static_cast<double>(totals.cells_scored) / n;
    state.counters["touched_cells"] = static_cast<double>(tally.touched_cells());
  }
}

/// Arguments: trajectories per source, threads.
void run(benchmark::State& state) {
  run_with(state, static_cast<int>(state.range(1)), 0);
}
/// Arguments: trajectories per source, lanes; one thread.
void run_in_lanes(benchmark::State& state) {
  run_with(state, 1, static_cast<int>(state.range(1)));
}

/// A sample of trajectories for the parts below.
struct Sample {
  std::vector<Release> releases;
  std::vector<Path> paths;
  std::uint64_t spans = 0, impacts = 0;
  double plan_length = 0.0;
};

const Sample& sample() {
  static const Sample made = [] {
    Sample s;
    const Scenario& scenario = scenario_with(1);
    const World world = scenario.world();
    for (std::uint32_t source = 0; source < scenario.sources.size(); ++source) {
      s.releases.push_back(make_release(scenario, source, 0));
      trace(world, s.releases.back(), s.paths.emplace_back());
      s.spans += s.paths.back().spans.size();
      s.impacts += s.paths.back().impacts;
      s.plan_length += s.paths.back().plan_length;
    }
    return s;
  }();
  return made;
}

void per(benchmark::State& state, const char* unit, std::uint64_t count) {
  state.counters[unit] = benchmark::Counter(1e-9 * static_cast<double>(count) * static_cast<double>(state.iterations()),
                                            benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// The engine without tallies.
void trace_only(benchmark::State& state) {
  const Sample& s = sample();
  const World world = g_loaded->scenario.world();
  Path path;
  for (auto _ : state)
    for (const Release& release : s.releases) {
      trace(world, release, path);
      benchmark::DoNotOptimize(path.length);
    }
  per(state, "ns_per_patch", s.spans);
  per(state, "ns_per_plan_m", static_cast<std::uint64_t>(s.plan_length));
}

/// The engine without tallies, with several trajectories in the lanes of one instruction. Argument: lanes.
void trace_in_lanes(benchmark::State& state) {
  const Sample& s = sample();
  const int lanes = static_cast<int>(state.range(0));
  if (lanes > most_lanes()) return state.SkipWithError("this processor has fewer lanes");
  const World world = g_loaded->scenario.world();
  Tracer tracer(world, lanes);
  for (auto _ : state) {
    std::size_t next = 0;
    tracer.run(
        [&](Release& release, std::uint64_t&) {
          if (next == s.releases.size()) return false;
          release = s.releases[next++];
          return true;
        },
        [](const Release&, const Path& path, std::uint64_t) { benchmark::DoNotOptimize(path.length); });
  }
  per(state, "ns_per_patch", s.spans);
  per(state, "ns_per_plan_m", static_cast<std::uint64_t>(s.plan_length));
}

/// Crosses the patches between two vertices along a straight line and reads each. No contact with the ground is looked
/// for, and nothing is stored.
double walk(const Surface& surface, const Vertex& from, const Vertex& to) {
  const double u = surface.u_of(from.motion.position.x()), v = surface.v_of(from.motion.position.y());
  const double du = surface.u_of(to.motion.position.x()) - u, dv = surface.v_of(to.motion.position.y()) - v;
  PatchIndex at = surface.patch_at(from.motion.position.x(), from.motion.position.y());
  const double every_u = du != 0.0 ? 1.0 / std::abs(du) : 2.0, every_v = dv != 0.0 ? 1.0 / std::abs(dv) : 2.0;
  double next_u = du > 0.0 ? (at.column + 1 - u) * every_u : (u - at.column) * every_u;
  double next_v = dv > 0.0 ? (at.row + 1 - v) * every_v : (v - at.row) * every_v;
  double t = 0.0, sum = 0.0;
  Patch patch;
  while (surface.read(at, patch)) {
    sum += patch.height(u + du * t - at.column, v + dv * t - at.row);
    t = std::min(next_u, next_v);
    if (t >= 1.0) break;
    if (next_u <= next_v)
      at.column += du > 0.0 ? 1 : -1, next_u += every_u;
    else
      at.row += dv > 0.0 ? 1 : -1, next_v += every_v;
  }
  return sum;
}

/// The floor: a bare walk over the same patches, without impacts and tallies.
void floor_walk(benchmark::State& state) {
  const Sample& s = sample();
  for (auto _ : state)
    for (const Path& path : s.paths)
      for (std::size_t i = 1; i < path.vertices.size(); ++i)
        benchmark::DoNotOptimize(walk(g_loaded->scenario.surface, path.vertices[i - 1], path.vertices[i]));
  per(state, "ns_per_patch", s.spans);
  per(state, "ns_per_plan_m", static_cast<std::uint64_t>(s.plan_length));
}

/// The impact law alone, with its random numbers, on the impacts of the sample.
void impact_law(benchmark::State& state) {
  const Sample& s = sample();
  const World world = g_loaded->scenario.world();
  const Ground& ground = world.cover.grounds.front();
  const Vec3 normal = normal_of({0.3, -0.6});
  for (auto _ : state)
    for (std::size_t k = 0; k < s.paths.size(); ++k) {
      const Release& release = s.releases[k];
      Asperities asperities(Random(release.seed, release.source, release.block, Purpose::Impact), Roughness::Clamp);
      std::uint32_t event = 0;
      for (const Vertex& vertex : s.paths[k].vertices) {
        if (vertex.event != Event::Impact) continue;
        Motion before = vertex.motion;
        before.velocity -= 2.0 * std::max(0.0, before.velocity.dot(normal)) * normal;
        benchmark::DoNotOptimize(
            impact(world.impact, ground, release.body, before, normal, asperities.at(event++, ground)));
      }
    }
  per(state, "ns_per_impact", s.impacts);
  per(state, "ns_per_plan_m", static_cast<std::uint64_t>(s.plan_length));
}

/// Scoring alone: paths into the tally.
void score(benchmark::State& state) {
  const Sample& s = sample();
  std::uint64_t scored = 0;
  for (auto _ : state) {
    Tally tally(g_loaded->scenario.surface.grid(), {30.0, 300.0, 500.0}, {1.0, 2.0, 4.0});
    VisitBatch batch(g_loaded->scenario.surface.grid());
    for (int repeat = 0; repeat < 10; ++repeat)
      for (std::size_t k = 0; k < s.paths.size(); ++k) {
        batch.add(s.paths[k], 2400.0, s.releases[k].source, nullptr);
        if (!batch.full() && !(repeat == 9 && k + 1 == s.paths.size())) continue;
        scored += tally.add(batch);
        batch.clear();
      }
  }
  state.counters["ns_per_cell"] =
      benchmark::Counter(1e-9 * static_cast<double>(scored), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// A file that is removed at the end. Its ending is that of the argument: 0 GeoPackage, 1 FlatGeobuf.
struct TemporaryFile {
  explicit TemporaryFile(const benchmark::State& state)
      : path(std::filesystem::temp_directory_path() / (state.range(0) == 0 ? "talus-bench.gpkg" : "talus-bench.fgb")) {
    std::filesystem::remove(path);
  }
  ~TemporaryFile() { std::filesystem::remove(path); }
  std::filesystem::path path;
};

/// A million stops with their index: those of the sample, one centimetre further with every block.
void write_stops(benchmark::State& state) {
  constexpr std::uint32_t kBlocks = 1000;
  const Sample& s = sample();
  std::vector<StopRow> rows;
  for (std::size_t k = 0; k < s.paths.size(); ++k)
    for (std::uint32_t block = 0; block < kBlocks; ++block) {
      rows.push_back(stop_row(s.releases[k], s.paths[k]));
      rows.back().block = block;
      rows.back().x += 0.01 * block;
    }
  for (auto _ : state) {
    const TemporaryFile file(state);
    io::PointsWriter writer(file.path, *g_loaded, io::PointsWriter::Layer::Stops);
    for (std::size_t at = 0; at < rows.size(); at += 128)
      writer.write(std::span(rows).subspan(at, std::min<std::size_t>(128, rows.size() - at)));
    writer.finish();
  }
  per(state, "ns_per_row", rows.size());
}

/// The paths of the sample with their index.
void write_paths(benchmark::State& state) {
  const Sample& s = sample();
  const Grid& grid = g_loaded->scenario.surface.grid();
  std::vector<RecordedPath> paths;
  std::uint64_t points = 0;
  for (std::size_t k = 0; k < s.paths.size(); ++k) {
    paths.push_back({stop_row(s.releases[k], s.paths[k]), points_of(s.paths[k], grid.cell_x)});
    points += paths.back().points.size();
  }
  for (auto _ : state) {
    const TemporaryFile file(state);
    io::TrajectoriesWriter writer(file.path, g_loaded->geo, grid);
    for (int repeat = 0; repeat < 10; ++repeat)
      for (const RecordedPath& path : paths) writer.write(path);
    writer.finish();
  }
  per(state, "ns_per_row", 10 * paths.size());
  per(state, "ns_per_point", 10 * points);
}

BENCHMARK(run)->Args({10, 1})->Args({100, 1})->Args({10, 2})->Args({100, 2})->UseManualTime()->Iterations(1)->Unit(
    benchmark::kSecond);
BENCHMARK(run_in_lanes)
    ->Args({100, 1})
    ->Args({100, 4})
    ->Args({100, 8})
    ->UseManualTime()
    ->Iterations(1)
    ->Unit(benchmark::kSecond);
BENCHMARK(trace_only)->Unit(benchmark::kMillisecond);
BENCHMARK(trace_in_lanes)->Arg(1)->Arg(4)->Arg(8)->Unit(benchmark::kMillisecond);
BENCHMARK(floor_walk)->Unit(benchmark::kMillisecond);
BENCHMARK(impact_law)->Unit(benchmark::kMillisecond);
BENCHMARK(score)->Unit(benchmark::kMillisecond);
BENCHMARK(write_stops)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(write_paths)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  benchmark::Initialize(&argc, argv);
  if (argc < 3) {
    std::fputs("usage: talus-bench DEM SOURCES [--benchmark_...]\n", stderr);
    return 2;
  }
  try {
    io::RunFlags flags;
    flags.dem = argv[1];
    flags.sources = argv[2];
    flags.diameter = 1.2;
    g_loaded = io::load_scenario(flags);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "talus-bench: %s\n", error.what());
    return 2;
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
