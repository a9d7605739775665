#include "talus/io/reports/profile_plot.hpp"

#include <algorithm>

#include "svg.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

using Places = std::vector<Eigen::Vector2d>;

constexpr double kDrawing = 960.0, kLeft = 70.0, kPlot = 860.0, kPanel = 130.0, kGap = 46.0;
constexpr double kFinest = 1.5;        // least distance between the points of a drawn line [px]
constexpr double kMostHeight = 420.0;  // of the drawing of the profile [px]; its scales are equal if it fits

/// A pair of axes and the drawing between them.
class Panel {
 public:
  Panel(Svg& svg, double top, double height, Range x, Range y)
      : svg_(svg), top_(top), height_(height), x_{x.low, x.high, kLeft, kPlot}, y_{y.high, y.low, top, height} {}

  void frame(const std::string& title, const std::string& x_label) const {
    for (const double at : ticks(x_.first, x_.last, 8)) {
      rule(x_(at), top_, x_(at), top_ + height_);
      text(x_(at), top_ + height_ + 14.0, "middle", with_digits(at, 6));
    }
    for (const double at : ticks(y_.last, y_.first, height_ > 200.0 ? 8 : 4)) {
      rule(kLeft, y_(at), kLeft + kPlot, y_(at));
      text(kLeft - 6.0, y_(at) + 4.0, "end", with_digits(at, 6));
    }
    svg_.element("rect", {{"class", "frame"}, {"x", kLeft}, {"y", top_}, {"width", kPlot}, {"height", height_}});
    text(kLeft, top_ - 6.0, "start", title);
    text(kLeft + kPlot, top_ + height_ + 28.0, "end", x_label);
  }

  void line(const Places& points, const char* style) const {
    std::string places;
    Eigen::Vector2d drawn(-1e9, 0.0);
    for (const Eigen::Vector2d& p : points) {
      const Eigen::Vector2d at(x_(p.x()), y_(p.y()));
      if ((at - drawn).norm() < kFinest && &p != &points.back()) continue;
      places += with_decimals(at.x(), 1) + "," + with_decimals(at.y(), 1) + " ";
      drawn = at;
    }
    svg_.element("polyline", {{"class", style}, {"points", places}});
  }

  void mark(double at, const std::string& name) const {
    svg_.element("line", {{"class", "screen"}, {"x1", x_(at)}, {"x2", x_(at)}, {"y1", top_}, {"y2", top_ + height_}});
    text(x_(at) + 3.0, top_ + 12.0, "start", name);
  }

 private:
  void rule(double x1, double y1, double x2, double y2) const {
    svg_.element("line", {{"class", "grid"}, {"x1", x1}, {"y1", y1}, {"x2", x2}, {"y2", y2}});
  }
  void text(double at_x, double at_y, const char* anchor, const std::string& words) const {
    svg_.words({{"x", at_x}, {"y", at_y}, {"text-anchor", anchor}}, words);
  }

  Svg& svg_;
  double top_, height_;
  Axis x_, y_;
};

/// One number of each bin that blocks cross, at the middle of the bin.
template <class Get>
Places along(const LoadedProfile& p, const std::vector<ProfileBin>& bins, Get get) {
  Places points;
  for (const ProfileBin& bin : bins)
    if (bin.speed.count > 0)
      points.emplace_back(std::min(p.profile.from() + 0.5 * (bin.from + bin.to), p.profile.to()), get(bin));
  return points;
}

void envelope(const Panel& panel, const LoadedProfile& p, const std::vector<ProfileBin>& bins,
              BinDistribution ProfileBin::*quantity) {
  panel.line(along(p, bins, [=](const ProfileBin& b) { return (b.*quantity).max; }), "max");
  panel.line(along(p, bins, [=](const ProfileBin& b) { return (b.*quantity).p99; }), "p99");
  panel.line(along(p, bins, [=](const ProfileBin& b) { return (b.*quantity).p95; }), "p95");
  panel.line(along(p, bins, [=](const ProfileBin& b) { return (b.*quantity).p50; }), "p50");
  panel.line(along(p, bins, [=](const ProfileBin& b) { return (b.*quantity).mean; }), "mean");
}

/// Share of the blocks that go farther than a distance, at the end of each bin; straight lines in between.
Places beyond(const Runout& runout, double width) {
  Places points{{0.0, 1.0}};
  std::uint64_t stopped = 0;
  for (std::size_t i = 0; i < runout.stops.size(); ++i) {
    stopped += runout.stops[i];
    points.emplace_back(width * static_cast<double>(i + 1),
                        static_cast<double>(runout.released - stopped) / static_cast<double>(runout.released));
  }
  return points;
}

Markup profile_style() {
  return "<style>text{font:12px sans-serif;fill:#333}polyline,.frame{fill:none}.frame{stroke:#555}.grid{stroke:#e3e3e3}"
         ".ground{stroke:#222;stroke-width:2}.zone{stroke:#c8791b;stroke-width:5}.path{stroke:#0b62c4;stroke-width:.6;"
         "opacity:.45}"
         ".screen{stroke:#b0127b;stroke-dasharray:4 "
         "3}.max{stroke:#999}.p99{stroke:#d9480f}.p95{stroke:#d9480f;stroke-width:2}"
         ".p50{stroke:#1f7a33;stroke-width:2}.mean{stroke:#1f7a33;stroke-dasharray:5 "
         "3}.beyond{stroke:#0b62c4;stroke-width:2}"
         "</style>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"_html;
}

void draw_ground(const Panel& panel, const LoadedProfile& p, std::span<const RecordedPath> paths) {
  const Scenario& s = p.loaded.scenario;
  const Grid& grid = s.surface.grid();
  for (const RecordedPath& path : paths) {
    Places points;
    for (const PathPoint& at : path.points) points.emplace_back(grid.west + at.x, p.datum + at.z);
    panel.line(points, "path");
  }
  panel.line(p.profile.nodes, "ground");
  Places zone;
  for (int c = 0; !s.cover.zones.values.empty() && c < grid.columns; ++c) {
    const double x = grid.west + grid.centre_x(c);
    if (s.cover.zones.at(c, 0) != 0) zone.emplace_back(x, p.profile.height(x));
    if ((s.cover.zones.at(c, 0) == 0 || c + 1 == grid.columns) && !zone.empty())
      panel.line(std::exchange(zone, {}), "zone");
  }
}

double most(const std::vector<ProfileBin>& bins, BinDistribution ProfileBin::*quantity) {
  double value = 1e-3;
  for (const ProfileBin& bin : bins) value = std::max(value, (bin.*quantity).max);
  return 1.04 * value;
}

}  // namespace

std::string profile_svg(const LoadedProfile& p, const ProfileResults& results, std::span<const RecordedPath> paths) {
  const Profile& profile = p.profile;
  const Range x{profile.from(), profile.to()};
  double low = profile.nodes[0].y(), high = low;
  for (const Eigen::Vector2d& node : profile.nodes) low = std::min(low, node.y()), high = std::max(high, node.y());
  const double margin = 0.03 * (high - low) + 1.0,
               height = std::clamp((high - low + 2.0 * margin) / (x.high - x.low) * kPlot, 120.0, kMostHeight);
  Svg body;
  double top = 30.0;
  const Panel ground(body, top, height, x, {low - margin, high + margin});
  const std::vector<Screen>& screens = p.loaded.scenario.screens;
  ground.frame("height (m); ground black, other zones of ground orange, paths blue", "");
  draw_ground(ground, p, paths);
  for (const Screen& screen : screens) ground.mark(profile.from() - 0.5 * p.step + screen.lines[0][0].x(), screen.id);
  top += height + kGap;
  for (const auto& [quantity, title] :
       {std::pair{&ProfileBin::speed, "speed (m/s): max grey, P99 and P95 (bold) red, median green, mean dashed"},
        {&ProfileBin::energy, "translational energy (kJ)"},
        {&ProfileBin::height, "height above the ground (m)"}}) {
    const Panel panel(body, top, kPanel, x, {0.0, most(results.bins, quantity)});
    panel.frame(title, "x (m)");
    envelope(panel, p, results.bins, quantity);
    top += kPanel + kGap;
  }
  const double farthest = p.bin * static_cast<double>(std::max<std::size_t>(1, results.runout.stops.size()));
  const Panel reach(body, top, kPanel, {0.0, farthest}, {0.0, 1.0});
  reach.frame("share of the blocks that goes farther", "distance from the release (m)");
  reach.line(beyond(results.runout, p.bin), "beyond");
  const std::string width = with_decimals(kDrawing, 0), size = with_decimals(top + kPanel + kGap, 0);
  const Markup drawing = body.drawing({{"xmlns", "http://www.w3.org/2000/svg"},
                                       {"width", width},
                                       {"height", size},
                                       {"viewBox", "0 0 " + width + " " + size}},
                                      profile_style());
  return drawing.text();
}

}  // namespace talus::io
