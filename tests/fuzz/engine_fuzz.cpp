#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "fuzz.hpp"
#include "talus/simulate/plan/plan.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "talus/simulate/simulate.hpp"

namespace {

using namespace talus;

/// Stops at a rule that does not hold.
void hold(bool true_always, const char* rule) {
  if (true_always) return;
  std::fprintf(stderr, "does not hold: %s\n", rule);
  __builtin_trap();
}

/// A value that the bounds allow. One in four lies at an end.
double allowed(fuzz::Bytes& bytes, const Bounds& bounds) {
  const double share = std::array{0.0, 1.0, -1.0, -1.0}[bytes.index(4)], any = bytes.number(0.0, 1.0);
  double value = std::lerp(bounds.min, bounds.max, share < 0.0 ? std::pow(any, 4.0) : share);
  if (bounds.whole) value = std::round(value);
  return fault_of(bounds, value) ? std::lerp(bounds.min, bounds.max, 0.5) : value;
}

/// Heights on a slope: a byte of 255 is a hole, 254 a cliff, 253 a pit.
Surface terrain(fuzz::Bytes& bytes, SurfaceKind kind) {
  Grid grid;
  grid.columns = static_cast<int>(4 + bytes.index(12));
  grid.rows = static_cast<int>(4 + bytes.index(12));
  grid.cell_x = grid.cell_y = std::array{0.25, 1.0, 5.0, 25.0}[bytes.index(4)];
  const double steep = bytes.number(0.0, 3.0), rough = bytes.number(0.0, 2.0) * grid.cell_x / 255.0;
  Raster<float> heights(grid, 0.0F);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const std::uint8_t b = bytes.byte();
      double z = steep * grid.cell_x * (grid.columns - column) + rough * b;
      if (b == 255) z = std::nan("");
      if (b == 254) z += 300.0;
      if (b == 253) z -= 300.0;
      heights.at(column, row) = static_cast<float>(z);
    }
  return Surface(std::move(heights), kind);
}

void set_effects(fuzz::Bytes& bytes, Scenario& s) {
  for (const EffectEntry& entry : effect_entries()) {
    if (!bytes.yes()) continue;
    for (const EffectField& field : entry.fields()) field.set(s.effects, allowed(bytes, field));
  }
  s.drag_and_stems = true;
  s.day = static_cast<int>(bytes.index(4));
}

Scenario scenario_of(fuzz::Bytes& bytes) {
  Scenario s;
  s.surface = terrain(bytes, bytes.yes() ? SurfaceKind::Bilinear : SurfaceKind::Creased);
  s.cover.grounds = {Ground{}};
  s.zone_names = {"default"};
  for (const Field<Ground>& field : ground_fields()) field.set(s.cover.grounds[0], allowed(bytes, field));
  s.features = {SourceFeature{}};
  s.features[0].release_height = {0.0, bytes.number(0.0, 20.0)};
  s.features[0].velocity = {bytes.number(-20.0, 20.0), bytes.number(-20.0, 20.0), bytes.number(-20.0, 20.0)};
  s.blocks.classes = {{{0.05 + bytes.number(0.0, 0.5), 0.6 + bytes.number(0.0, 10.0)}, 1.0, kNotGiven}};
  s.blocks.axes = {1.0, bytes.number(0.5, 1.0), 0.5};
  if (bytes.yes()) set_effects(bytes, s);
  const Grid& grid = s.surface.grid();
  for (int i = 0; i < 3; ++i) {
    SourceCell cell;
    cell.x = (static_cast<double>(bytes.index(static_cast<std::size_t>(grid.columns))) + 0.5) * grid.cell_x;
    cell.y = (static_cast<double>(bytes.index(static_cast<std::size_t>(grid.rows))) + 0.5) * grid.cell_y;
    if (s.surface.height(cell.x, cell.y)) s.sources.push_back(cell);
  }
  s.rules.time_limit = 60.0;
  s.rules.impact_limit = 2000;
  s.trajectories = 4;
  return make_scenario(std::move(s));
}

bool finite(const Motion& m) {
  return std::isfinite(m.time) && m.position.allFinite() && m.velocity.allFinite() && m.spin.allFinite();
}

/// Time never runs backwards, and all numbers are finite.
void check_path(const Path& path) {
  hold(path.vertices.size() >= 2, "a path has a start and an end");
  hold(path.length >= 0.0 && path.plan_length <= path.length * (1.0 + 1e-9) + 1e-6,
       "a path is no shorter than its plan");
  double before = 0.0;
  for (const Vertex& vertex : path.vertices) {
    hold(finite(vertex.motion), "numbers are finite");
    hold(vertex.motion.time >= before - 1e-9, "time goes on");
    before = vertex.motion.time;
  }
}

/// Without effects the energy, as the height that it could lift the block to, never grows. docs/physics.md, "Energy".
void check_energy(const Path& path, double radius) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vertex& vertex : path.vertices) {
    const Motion& m = vertex.motion;
    const double spin = 0.4 * radius * radius * m.spin.squaredNorm();
    const double height = m.position.z() + (m.velocity.squaredNorm() + spin) / (2.0 * kGravity);
    hold(height <= lowest + 1e-6 * std::max(1.0, std::abs(height)), "energy never grows");
    lowest = std::min(lowest, height);
  }
}

void check_paths(const Scenario& s) {
  Path path;
  const Ground& ground = s.cover.grounds[0];
  const bool sphere = ground.shape_min == 1.0 && ground.shape_max == 1.0;
  for (std::uint32_t source = 0; source < s.sources.size(); ++source)
    for (std::uint32_t block = 0; block < s.trajectories; ++block) {
      const Release release = make_release(s, source, block);
      trace(s.world(), release, path);
      if (std::isnan(release.motion.position.z())) {  // in a cell at a hole
        hold(path.end == End::Left, "a block that is released over no terrain leaves it");
        continue;
      }
      check_path(path);
      if (!s.effects.any() && sphere) check_energy(path, release.body.radius());
    }
}

/// Each block has one end; the tally has each that stays once; one thread and three make the same sums.
void check_sums(const Scenario& s) {
  std::array<std::uint64_t, 2> deposits{};
  std::array<Totals, 2> totals;
  for (int i = 0; i < 2; ++i) {
    Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
    totals[i] = simulate(s, tally, {}, 1 + 2 * i);
    for (int row = 0; row < tally.grid().rows; ++row)
      for (int column = 0; column < tally.grid().columns; ++column)
        if (const CellRecord* cell = tally.find(column, row)) deposits[i] += cell->deposits;
    hold(totals[i].released == s.released(), "all blocks are released");
    hold(std::accumulate(totals[i].ends.begin(), totals[i].ends.end(), std::uint64_t{0}) == totals[i].released,
         "each block has one end");
  }
  hold(deposits[0] == deposits[1] && totals[0].ends == totals[1].ends && totals[0].length_mm == totals[1].length_mm,
       "one thread and three make the same sums");
}

}  // namespace

/// The bytes are a terrain with holes, cliffs and pits, a ground, effects and sources; all numbers within their bounds.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes bytes(data, size);
  fuzz::refused_or_read([&] {
    const Scenario s = scenario_of(bytes);
    check_paths(s);
    check_sums(s);
  });
  return 0;
}
