#include "talus/simulate/scenario/parameter_table.hpp"

#include <array>
#include <charconv>

#include "talus/base/elementary.hpp"
#include "talus/base/expect.hpp"
#include "talus/base/text.hpp"

namespace talus {

namespace {

// Made of + - * / only: the same bits on every machine.
double tangent(double angle) {
  const SineCosine s = sine_cosine_of_turn(angle / 360.0);
  return s.sine / s.cosine;
}

// The shortest decimal angle [deg] that has exactly this tangent, so that 30 is written as 30 and reads back the same.
double angle_of(double tan_phi) {
  const double angle = degrees(std::atan(tan_phi));
  std::array<char, 40> text{};
  for (int digits = 1; digits <= 17; ++digits) {
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), angle, std::chars_format::scientific, digits).ptr;
    double rounded = angle;
    std::from_chars(text.data(), end, rounded);
    for (const double candidate : {rounded, std::nextafter(rounded, 0.0), std::nextafter(rounded, 90.0)})
      if (tangent(candidate) == tan_phi) return candidate;
  }
  return angle;
}

template <auto member>
constexpr double get_ground(const Ground& g) {
  return g.*member;
}
template <auto member>
constexpr void set_ground(Ground& g, double value) {
  g.*member = value;
}

constexpr auto kAbove = Bounds::AboveMin;

constexpr std::array<Field<Ground>, 7> kGround{{
    {{"theta_scale", "1", "longitudinal roughness", 0.0, 5.0},
     get_ground<&Ground::theta_scale>,
     set_ground<&Ground::theta_scale>},
    {{"psi_scale", "1", "transverse roughness", 0.0, 5.0},
     get_ground<&Ground::psi_scale>,
     set_ground<&Ground::psi_scale>},
    {{"En50", "m3/s2", "c D v_n^2 at which half of the normal momentum is kept", 0.0, 1e6, kAbove},
     get_ground<&Ground::En50>,
     set_ground<&Ground::En50>},
    {{"Et50", "m3/s2", "c D v_n^2 at which half of the tangential momentum is kept", 0.0, 1e6, kAbove},
     get_ground<&Ground::Et50>,
     set_ground<&Ground::Et50>},
    {{"phi", "deg", "friction angle", 0.0, 89.0, Bounds::Between},
     [](const Ground& g) { return angle_of(g.tan_phi); },
     [](Ground& g, double phi) { g.tan_phi = tangent(phi); }},
    {{"shape_min", "1", "smallest factor on the radius at an impact", 0.2, 5.0},
     get_ground<&Ground::shape_min>,
     set_ground<&Ground::shape_min>},
    {{"shape_max", "1", "largest factor on the radius at an impact", 0.2, 5.0},
     get_ground<&Ground::shape_max>,
     set_ground<&Ground::shape_max>},
}};

constexpr std::array<Field<Scenario>, 10> kScenario{{
    {{"seed", "1", "of the random numbers", 0.0, 9007199254740991.0, Bounds::Closed, true},
     [](const Scenario& s) { return static_cast<double>(s.seed); },
     [](Scenario& s, double v) { s.seed = static_cast<std::uint64_t>(v); }},
    {{"trajectories", "1", "blocks released per source cell", 1.0, 1e9, Bounds::Closed, true},
     [](const Scenario& s) { return static_cast<double>(s.trajectories); },
     [](Scenario& s, double v) { s.trajectories = static_cast<std::uint32_t>(v); }},
    {{"day", "1", "of the run, for wet-ground", 0.0, 1e6, Bounds::Closed, true},
     [](const Scenario& s) { return static_cast<double>(s.day); },
     [](Scenario& s, double v) { s.day = static_cast<int>(v); }},
    {{"blocks.density", "kg/m3", "mass per volume of the rock", 500.0, 8000.0},
     [](const Scenario& s) { return s.blocks.density; },
     [](Scenario& s, double v) { s.blocks.density = v; }},
    {{"model.deformation_coefficient", "1", "c in E_d = c D v_n^2", 0.0, 100.0, kAbove},
     [](const Scenario& s) { return s.impact.deformation_coefficient; },
     [](Scenario& s, double v) { s.impact.deformation_coefficient = v; }},
    {{"model.stop_speed", "m/s", "a block slower than this after an impact stops where friction holds it", 0.0, 10.0,
      kAbove},
     [](const Scenario& s) { return s.rules.stop_speed; },
     [](Scenario& s, double v) { s.rules.stop_speed = v; }},
    {{"model.trap_time", "s",
      "a block that stays within one diameter for longer than this ends there (times sqrt(D / 2 m) above 2 m)", 0.0,
      3600.0, kAbove},
     [](const Scenario& s) { return s.rules.trap_time; },
     [](Scenario& s, double v) { s.rules.trap_time = v; }},
    {{"model.time_limit", "s", "longest duration of a trajectory", 0.0, 86400.0, kAbove},
     [](const Scenario& s) { return s.rules.time_limit; },
     [](Scenario& s, double v) { s.rules.time_limit = v; }},
    {{"model.impact_limit", "1", "largest number of impacts of a trajectory", 1.0, 1e7, Bounds::Closed, true},
     [](const Scenario& s) { return static_cast<double>(s.rules.impact_limit); },
     [](Scenario& s, double v) { s.rules.impact_limit = static_cast<std::uint32_t>(v); }},
    {{"output.trajectories", "1", "paths that are written as vectors", 0.0, 1e7, Bounds::Closed, true},
     [](const Scenario& s) { return static_cast<double>(s.output.paths); },
     [](Scenario& s, double v) { s.output.paths = static_cast<std::uint32_t>(v); }},
}};

constexpr std::array<Bounds, 21> kLists{{
    {"blocks.diameter", "m", "diameter of the sphere of equal volume", 0.01, 50.0},
    {"blocks.weight", "1", "share of a class of blocks, relative to the others", 0.0, 1e9, kAbove},
    {"blocks.frequency", "1/year", "events per year of a class of blocks", 0.0, 1e6},
    {"blocks.volume", "m3", "of the blocks of a class, in place of the diameter", 1e-6, 65000.0},
    {"blocks.volume_min", "m3", "smallest volume of the power law", 1e-6, 65000.0},
    {"blocks.volume_max", "m3", "largest volume of the power law", 1e-6, 65000.0},
    {"blocks.exponent", "1", "b in N(>= V) ~ V^-b", 1e-6, 10.0},
    {"blocks.axes", "1", "L1 >= L2 >= L3, relative to each other", 1e-3, 1000.0},
    {"sources.release_height", "m", "of the release above the terrain", 0.0, 500.0},
    {"sources.frequency", "1/year", "events per year of the whole feature", 0.0, 1e6},
    {"sources.velocity", "m/s", "component of the velocity at the release", -200.0, 200.0},
    {"output.energy_thresholds", "kJ", "kinetic energy, translational unless count_rotation", 0.01, 1e9},
    {"output.height_thresholds", "m", "vertical height above the terrain", 0.0, 1e4, kAbove},
    {"output.passages_below", "m", "clearance below which a passage counts in passage densities; 0: any", 0.0, 1e4},
    {"barriers.height", "m", "of the top of a barrier above the ground", 0.0, 100.0},
    {"barriers.capacity", "kJ", "translational energy that a barrier takes", 0.0,
     std::numeric_limits<double>::infinity()},
    {"frequency.total", "1/year", "events per year of all sources together", 0.0, 1e6, kAbove},
    {"frequency.per_area", "1/(m2 year)", "events per area of the sources and year", 0.0, 1e3},
    {"frequency.power_law.A", "1/year", "events per year of 1 m3 and more", 0.0, 1e6},
    {"frequency.power_law.b", "1", "b in N(>= V) = A V^-b", 1e-6, 10.0},
    {"dem.cell", "m", "size of the cells", 0.05, 100.0},
}};

}  // namespace

std::span<const Field<Ground>> ground_fields() {
  return kGround;
}
std::span<const Field<Scenario>> scenario_fields() {
  return kScenario;
}
std::span<const Bounds> list_bounds() {
  return kLists;
}

const Bounds& bounds_of(std::string_view key) {
  for (const Bounds& bounds : kLists)
    if (bounds.key == key) return bounds;
  TALUS_EXPECT(false, "a key is one of the table");
  return kLists.front();
}

std::optional<std::string> fault_of(const Bounds& b, double value) {
  const bool low = b.ends == Bounds::Closed ? value >= b.min : value > b.min;
  const bool high = b.ends == Bounds::Between ? value < b.max : value <= b.max;
  if (low && high && (!b.whole || value == std::floor(value))) return std::nullopt;
  std::string text = b.whole ? "must be a whole number, " : "must be ";
  if (b.ends == Bounds::Closed) text += text_of(b.min) + " to " + text_of(b.max);
  if (b.ends == Bounds::AboveMin) text += "above " + text_of(b.min) + " and at most " + text_of(b.max);
  if (b.ends == Bounds::Between) text += "above " + text_of(b.min) + " and below " + text_of(b.max);
  if (b.unit != "1") text.append(" ").append(b.unit);
  return text + " (" + std::string(b.meaning) + ")";
}

}  // namespace talus
