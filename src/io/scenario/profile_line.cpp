#include "profile_line.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "io/gdal/layer.hpp"
#include "io/gdal/off_map.hpp"
#include "profile_keys.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/base/vector.hpp"

namespace talus::io {
namespace {

constexpr double kNoticedOff = 0.1;  // m by which the profile may miss the terrain without a word

/// Shares of the way between two values of one coordinate at which it crosses whole numbers, of `least` to `most`: a
/// vertex may lie far off the DEM.
void crossings(double from, double to, double least, double most, std::vector<double>& shares) {
  if (from == to) return;
  const double low = std::max(std::ceil(std::min(from, to)), least), high = std::min(std::max(from, to), most);
  for (double line = low; line <= high; line += 1.0) shares.push_back((line - from) / (to - from));
}

/// Shares of the way from a to b at which it comes to another patch of the terrain, and the first off it.
std::vector<double> shares_at_patches(const Surface& surface, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Grid& grid = surface.grid();
  const double u_a = surface.u_of(a.x()), v_a = surface.v_of(a.y()), u_b = surface.u_of(b.x()),
               v_b = surface.v_of(b.y());
  const double columns = grid.columns, rows = grid.rows;
  std::vector<double> shares{0.0, 1.0};
  crossings(u_a, u_b, -1.0, columns, shares);
  crossings(v_a, v_b, -1.0, rows, shares);
  if (surface.creased()) {
    crossings(v_a - u_a, v_b - u_b, -columns, rows, shares);
    crossings(v_a + u_a, v_b + u_b, -2.0, columns + rows, shares);
  }
  std::sort(shares.begin(), shares.end());
  return shares;
}

/// Numbers of the vertices of a line that are no closer than `least` to the one before: without the slips of a hand and
/// the scatter of a GPS.
std::vector<int> vertices_apart(const OGRLineString& line, double least) {
  std::vector<int> apart{0};
  for (int i = 1; i < line.getNumPoints(); ++i)
    if (std::hypot(line.getX(i) - line.getX(apart.back()), line.getY(i) - line.getY(apart.back())) >= least)
      apart.push_back(i);
  return apart;
}

/// The first vertex on the way to which a line meets itself: it touches or crosses an earlier part, or turns by more
/// than 150 degrees, as a line that is drawn there and back; nothing if it passes each place once.
std::optional<int> vertex_back(const OGRLineString& line) {
  const double kBack = -std::cos(radians(30.0));
  std::optional<int> found;
  for (int i = 2; i < line.getNumPoints() && !found; ++i) {
    const auto way = [&](int k) {
      return Eigen::Vector2d(line.getX(k) - line.getX(k - 1), line.getY(k) - line.getY(k - 1));
    };
    const Eigen::Vector2d in = way(i - 1), out = way(i);
    if (in.dot(out) < kBack * in.norm() * out.norm()) found = i;
  }
  const auto meets_itself = [&](int last) {
    OGRLineString part;
    for (int i = 0; i <= last; ++i) part.addPoint(line.getX(i), line.getY(i));
    return part.get_IsClosed() != 0 || part.IsSimple() == 0;
  };
  int whole = 1, crossed = found.value_or(line.getNumPoints()) - 1;
  if (!OGRGeometryFactory::haveGEOS() || crossed < 2 || !meets_itself(crossed)) return found;
  while (crossed - whole > 1) (meets_itself((whole + crossed) / 2) ? crossed : whole) = (whole + crossed) / 2;
  return crossed;
}

/// Throws InputError if the line passes a place twice, by more than a cell: x would stand for two grounds of one place.
void refuse_way_back(const OGRLineString& line, double step, const std::string& path, const Terrain& terrain) {
  const Grid& grid = terrain.heights.grid;
  const std::vector<int> apart = vertices_apart(line, std::max({step, grid.cell_x, grid.cell_y}));
  OGRLineString drawn;
  for (const int i : apart) drawn.addPoint(line.getX(i), line.getY(i));
  const auto back = vertex_back(drawn);
  if (!back) return;
  const int vertex = apart[static_cast<std::size_t>(*back)];
  const MapPlace place(terrain.geo, grid);
  throw InputError(path + ": the line runs back over itself or crosses itself before its vertex " +
                   std::to_string(vertex + 1) + " (" + with_decimals(place.x(line.getX(vertex)), 1) + ", " +
                   with_decimals(place.y(line.getY(vertex)), 1) +
                   "), must pass each place once: draw it down the fall line, or smooth a track that was surveyed "
                   "(ogr2ogr -simplify)");
}

}  // namespace

ProfileLine profile_along(const std::vector<Eigen::Vector2d>& plan, const Surface& surface, double step,
                          const std::string& name) {
  ProfileLine out{{}, plan};
  std::vector<Eigen::Vector2d>& nodes = out.profile.nodes;
  std::vector<Eigen::Vector2d> terrain;  // (x, z) of every sample
  double before = 0.0;
  const auto add = [&](const Eigen::Vector2d& place, double x, bool last) {
    const auto z = surface.height(place.x(), place.y());
    if (!z)
      throw InputError(name + ": there is no terrain under it " + text_of(std::round(x * 10.0) / 10.0) +
                       " m from its start, must lie on the DEM, strictly between the centres of its outermost cells");
    terrain.emplace_back(x, *z);
    if (last)
      while (nodes.size() > 1 && !is_a_step(x - nodes.back().x(), step)) nodes.pop_back();
    if (nodes.empty() || is_a_step(x - nodes.back().x(), step)) nodes.emplace_back(x, *z);
  };
  for (std::size_t i = 1; i < plan.size(); ++i) {
    const Eigen::Vector2d &a = plan[i - 1], &b = plan[i];
    const double length = (b - a).norm();
    for (const double share : shares_at_patches(surface, a, b))
      add(a + share * (b - a), before + share * length, i + 1 == plan.size() && share == 1.0);
    before += length;
  }
  if (nodes.size() < 2) throw InputError(name + ": is shorter than step = " + text_of(step) + " m, must be longer");
  for (const Eigen::Vector2d& sample : terrain) {
    const double off = std::abs(out.profile.height(sample.x()) - sample.y());
    if (off > out.most_off) out.most_off = off, out.most_off_at = sample.x();
  }
  return out;
}

ProfileLine read_profile_line(const std::string& path, const Terrain& terrain, const ScenarioSpec& spec,
                              LoadedScenario& out) {
  Layer layer("profile", path, terrain);
  std::vector<Eigen::Vector2d> plan;
  while (const Feature feature = layer.next()) {
    const Parts parts = layer.parts(*feature);
    if (parts.lines.size() != 1 || !parts.polygons.empty() || !parts.points.empty())
      throw InputError(layer.label(*feature) + ": is no single line, must be one line from the top to the bottom");
    if (!plan.empty()) throw InputError(path + ": has several lines, must have one: a profile is one line");
    const OGRLineString& line = parts.lines.front();
    refuse_way_back(line, spec.profile->step, path, terrain);
    for (int i = 0; i < line.getNumPoints(); ++i) plan.emplace_back(line.getX(i), line.getY(i));
  }
  if (plan.size() < 2) throw InputError(path + ": has no line, must have one");
  OGREnvelope box;
  for (const Eigen::Vector2d& place : plan) box.Merge(place.x(), place.y());
  if (wholly_off(box, terrain.heights.grid)) throw InputError(off_dem_text(path, box, layer, terrain));
  layer.tell(out);
  const double step = spec.profile->step;
  ProfileLine line = profile_along(plan, Surface(terrain.heights, spec.surface), step, path);
  if (line.most_off > kNoticedOff)
    out.warnings.push_back(
        path + ": step = " + text_of(step) + " m leaves out terrain: at x = " + with_decimals(line.most_off_at, 1) +
        " m the profile is " + with_digits(line.most_off, 2) + " m above or below the DEM; " +
        (step > kProfileStep.min ? "give a smaller step"
                                 : "there is no smaller step: see in profile.svg whether blocks pass there"));
  return line;
}

}  // namespace talus::io
