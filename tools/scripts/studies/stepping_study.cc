// The model of docs/physics.md by small steps of time. Shares no code with Talus, to be compared with its exact walk.
// stepping_study.py compiles and starts it.
//
//   stepping_study GRID STEP[s] TRAJECTORIES SEED parabola|euler < sources > ends.csv
//
// GRID: "columns rows cell west south c zones", the parameters of each zone, the heights (from the south), the zone of
// each cell. A slide is made of steps of constant acceleration; the block flies where the free parabola over one step
// ends above the ground. A flight:
//   parabola  exact at the ends of the steps, bisection in time at the ground
//   euler     semi-implicit: first the velocity of the end of the step, then the place by this velocity; at the ground
//             bisection along the straight way of the step, with the velocity of its end
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

constexpr double kGravity = 9.81, kStopSpeed = 0.5, kSlideSpeed = 0.1, kPatience = 5.0, kPi = 3.141592653589793;

struct V {
  double x = 0, y = 0, z = 0;
};
V operator+(V a, V b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
V operator-(V a, V b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
V operator*(double k, V a) {
  return {k * a.x, k * a.y, k * a.z};
}
double dot(V a, V b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
V cross(V a, V b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double norm(V a) {
  return std::sqrt(dot(a, a));
}
V unit(V a) {
  return (1.0 / norm(a)) * a;
}

struct Zone {
  double theta, psi, en, et, phi, low, high;
};

/// Heights at the centres of cells, bilinear between them.
struct Ground {
  int columns = 0, rows = 0;
  double cell = 1, west = 0, south = 0, c = 0.25;
  std::vector<double> z;
  std::vector<int> zone;
  std::vector<Zone> zones;

  struct At {
    bool there = false;
    double z = 0, gx = 0, gy = 0;
    V normal() const { return unit({-gx, -gy, 1.0}); }
  };
  At at(double x, double y) const {
    const double u = (x - west) / cell - 0.5, v = (y - south) / cell - 0.5;
    const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
    if (i < 0 || j < 0 || i + 1 >= columns || j + 1 >= rows) return {};
    const double p = u - i, q = v - j;
    const double* h = &z[static_cast<std::size_t>(j) * columns + i];
    const double a = h[0], b = h[1], d = h[columns], e = h[columns + 1], twist = a - b - d + e;
    return {true, a + (b - a) * p + (d - a) * q + twist * p * q, (b - a + twist * q) / cell,
            (d - a + twist * p) / cell};
  }
  const Zone& zone_at(double x, double y) const {
    const int i = static_cast<int>((x - west) / cell), j = static_cast<int>((y - south) / cell);
    return zones[zone[static_cast<std::size_t>(j) * columns + i]];
  }
};

/// SplitMix64, and normal numbers by Box and Muller.
struct Draws {
  std::uint64_t state;
  double uniform() {
    std::uint64_t k = state += 0x9E3779B97F4A7C15ULL;
    k = (k ^ (k >> 30)) * 0xBF58476D1CE4E5B9ULL;
    k = (k ^ (k >> 27)) * 0x94D049BB133111EBULL;
    return (static_cast<double>((k ^ (k >> 31)) >> 11) + 0.5) / 9007199254740992.0;
  }
  double normal() {
    const double r = std::sqrt(-2.0 * std::log(uniform()));
    return r * std::cos(2.0 * kPi * uniform());
  }
};

struct State {
  V p, v, w;
  double t = 0;
};

/// Steps 1 to 6 of the impact.
void impact(const Ground& g, const Zone& k, double diameter, V n, State& s, Draws& draws) {
  const double theta = std::atan(k.theta * std::max(0.0, 0.5 + 0.5 * draws.normal()));
  const double psi = std::atan(k.psi * 0.5 * draws.normal());
  const double arm = 0.5 * diameter * (k.low + (k.high - k.low) * draws.uniform());
  V heading{s.v.x, s.v.y, 0};
  if (norm(heading) < 1e-12) heading = {n.x, n.y, 0};
  if (norm(heading) < 1e-12) heading = {std::cos(2 * kPi * draws.uniform()), std::sin(2 * kPi * draws.uniform()), 0};
  heading = unit(heading);
  const V axis = cross({0, 0, 1}, heading);
  const V n1 = std::cos(theta) * n - std::sin(theta) * cross(axis, n) + (dot(axis, n) * (1 - std::cos(theta))) * axis;
  V m = std::cos(psi) * n1 + std::sin(psi) * unit(cross(n1, heading));
  if (dot(s.v, m) >= 0) m = n1;
  if (dot(s.v, m) >= 0) m = n;
  const double vn = std::max(0.0, -dot(s.v, m)), ed = g.c * diameter * vn * vn;
  const double kn = k.en / (ed + k.en), kt = k.et / (ed + k.et);
  const V vt = s.v + vn * m, wn = dot(s.w, m) * m, wt = s.w - wn;
  const V u = kt * (vt - arm * cross(s.w, m));
  const double slip = norm(u), j = std::min(2.0 / 7.0 * slip, k.phi * (1 + kn) * vn);
  const V along = slip > 0 ? (1 / slip) * u : V{};
  s.v = kt * vt - j * along + (kn * vn) * m;
  s.w = kt * wt + (2.5 * j / arm) * cross(m, along) + wn;
  const double into = dot(s.v, n);
  if (into < 0) s.v = s.v - into * n;
}

enum class Next { Impact, Fly, Stopped, Left };

struct Path {
  double impacts = 0, length = 0, lowest_y = 1e300;
  bool left = false;
};

struct Walk {
  const Ground& g;
  double diameter, step;
  bool euler;
  State s;
  Draws draws;
  Path path;
  V anchor{};
  double anchored = 0;

  V free_fall(const State& s, double t) const {
    return s.p + t * s.v - ((euler ? 1.0 : 0.5) * kGravity * t * t) * V{0, 0, 1};
  }
  double clearance(double t) const {
    const V p = free_fall(s, t);
    return p.z - g.at(p.x, p.y).z;
  }
  void go(double t) {
    const V p = free_fall(s, t);
    path.length += norm(p - s.p);
    s.p = p;
    s.v.z -= kGravity * t;
    s.t += t;
    path.lowest_y = std::min(path.lowest_y, s.p.y);
  }

  void land_on_the_parabola() {
    double low = 0, high = step;
    for (int i = 0; i < 60; ++i) (clearance(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
    go(high);
  }
  void land_on_the_chord(V end) {
    const V way = end - s.p;
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
      const double half = 0.5 * (low + high);
      const V p = s.p + half * way;
      (p.z > g.at(p.x, p.y).z ? low : high) = half;
    }
    path.length += high * norm(way);
    s.p = s.p + high * way;
    s.v.z -= kGravity * step;
    s.t += high * step;
    path.lowest_y = std::min(path.lowest_y, s.p.y);
  }

  Next fly() {
    while (true) {
      const V p = free_fall(s, step);
      const auto ground = g.at(p.x, p.y);
      if (!ground.there) return Next::Left;
      if (p.z > ground.z) {
        go(step);
        continue;
      }
      if (euler)
        land_on_the_chord(p);
      else
        land_on_the_parabola();
      s.p.z = g.at(s.p.x, s.p.y).z;
      return Next::Impact;
    }
  }

  Next slide() {
    double slid = 0;
    while (slid < diameter) {
      const auto at = g.at(s.p.x, s.p.y);
      const double speed = norm(s.v), mu = g.zone_at(s.p.x, s.p.y).phi;
      const bool held = std::hypot(at.gx, at.gy) <= mu;
      if (speed <= kStopSpeed && held) return Next::Stopped;
      const V n = at.normal();
      const V fall = V{0, 0, -kGravity} - (-kGravity * n.z) * n;
      const V a = speed > 0 ? fall - (mu * kGravity * n.z / speed) * s.v : fall;
      const V ballistic = free_fall(s, step);
      const auto under = g.at(ballistic.x, ballistic.y);
      if (!under.there) return Next::Left;
      if (ballistic.z > under.z) {
        go(step);
        return Next::Fly;
      }
      V there = s.p + step * s.v + (0.5 * step * step) * a;
      const auto next = g.at(there.x, there.y);
      if (!next.there) return Next::Left;
      there.z = next.z;
      V v = s.v + step * a;
      double fast = norm(v);
      if (dot(v, s.v) <= 0 && held) return Next::Stopped;
      v = v - dot(v, next.normal()) * next.normal();
      s.v = norm(v) > 0 ? (fast / norm(v)) * v : V{};
      slid += norm(there - s.p);
      path.length += norm(there - s.p);
      s.p = there;
      s.t += step;
      path.lowest_y = std::min(path.lowest_y, s.p.y);
    }
    return Next::Impact;
  }

  bool trapped() {
    if (std::hypot(s.p.x - anchor.x, s.p.y - anchor.y) > diameter) anchor = s.p, anchored = s.t;
    return s.t - anchored > kPatience;
  }

  void run() {
    Next next = fly();
    anchor = s.p, anchored = s.t;
    while (next == Next::Impact && path.impacts < 100000) {
      const auto at = g.at(s.p.x, s.p.y);
      const Zone& k = g.zone_at(s.p.x, s.p.y);
      const V n = at.normal();
      impact(g, k, diameter, n, s, draws);
      path.impacts += 1;
      if (norm(s.v) < kStopSpeed && std::hypot(at.gx, at.gy) <= k.phi) return;
      next = Next::Fly;
      if (dot(s.v, n) < kSlideSpeed) {
        s.v = s.v - dot(s.v, n) * n;
        next = slide();
        if (next != Next::Left && trapped()) return;
      }
      if (next == Next::Fly) {
        next = fly();
        if (next != Next::Left && trapped()) return;
      }
    }
    path.left = next == Next::Left;
  }
};

Ground read(const char* name) {
  std::ifstream in(name);
  Ground g;
  std::size_t zones = 0;
  in >> g.columns >> g.rows >> g.cell >> g.west >> g.south >> g.c >> zones;
  g.zones.resize(zones);
  for (Zone& k : g.zones) in >> k.theta >> k.psi >> k.en >> k.et >> k.phi >> k.low >> k.high;
  g.z.resize(static_cast<std::size_t>(g.columns) * g.rows);
  g.zone.resize(g.z.size());
  for (double& z : g.z) in >> z;
  for (int& k : g.zone) in >> k;
  return g;
}

}  // namespace

int main(int, char** arguments) {
  const Ground ground = read(arguments[1]);
  const double step = std::atof(arguments[2]);
  const bool euler = std::string(arguments[5]) == "euler";
  const auto trajectories = static_cast<std::uint64_t>(std::atoll(arguments[3]));
  const auto seed = static_cast<std::uint64_t>(std::atoll(arguments[4]));
  std::string name;
  double x, y, height, vx, vy, vz, diameter;
  std::printf("source,x,y,left,seconds,length,impacts,lowest_y\n");
  for (std::uint64_t source = 0; std::cin >> name >> x >> y >> height >> vx >> vy >> vz >> diameter; ++source)
    for (std::uint64_t i = 0; i < trajectories; ++i) {
      State s;
      s.p = {x, y, ground.at(x, y).z + height};
      s.v = {vx, vy, vz};
      const Draws draws{(seed * 1000 + source) * 100000007ULL + i * 0x632BE59BD9B4E019ULL};
      Walk walk{ground, diameter, step, euler, s, draws, {}, {}, 0};
      walk.run();
      const Path& path = walk.path;
      std::printf("%s,%.3f,%.3f,%d,%.3f,%.2f,%.0f,%.2f\n", name.c_str(), walk.s.p.x, walk.s.p.y, path.left ? 1 : 0,
                  walk.s.t, path.length, path.impacts, path.lowest_y);
    }
}
