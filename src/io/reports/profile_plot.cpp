#include <algorithm>
#include <cmath>
#include <cstdio>

#include "talus/io/results/write_profile.hpp"

namespace talus::io {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr double kWidth = 960.0, kLeft = 70.0, kPlot = 860.0, kPanel = 130.0, kGap = 46.0;
constexpr double kFinest = 1.5;        // between the points of a line that is drawn
constexpr double kMostHeight = 420.0;  // of the drawing of the profile, which has equal scales where it fits

std::string number(double value, const char* format = "%.1f") {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

/// Places of about five ticks at 1, 2 or 5 times a power of ten.
std::vector<double> ticks(double low, double high, int wanted) {
  const double unit = std::pow(10.0, std::floor(std::log10((high - low) / wanted)));
  double every = unit;
  for (const double k : {1.0, 2.0, 5.0, 10.0})
    if ((high - low) / (k * unit) <= wanted) {
      every = k * unit;
      break;
    }
  std::vector<double> out;
  for (double at = std::ceil(low / every) * every; at <= high + 1e-9 * every; at += every) out.push_back(at);
  return out;
}

/// A pair of axes and the drawing between them.
class Panel {
 public:
  Panel(std::string& svg, double top, double height, Range x, Range y)
      : svg_(svg), top_(top), height_(height), x_(x), y_(y) {}

  void frame(const std::string& title, const std::string& x_label) const {
    for (const double at : ticks(x_.low, x_.high, 8)) {
      rule(x(at), top_, x(at), top_ + height_);
      text(x(at), top_ + height_ + 14.0, "middle", number(at, "%g"));
    }
    for (const double at : ticks(y_.low, y_.high, height_ > 200.0 ? 8 : 4)) {
      rule(kLeft, y(at), kLeft + kPlot, y(at));
      text(kLeft - 6.0, y(at) + 4.0, "end", number(at, "%g"));
    }
    svg_ += "<rect class=\"frame\" x=\"" + number(kLeft) + "\" y=\"" + number(top_) + "\" width=\"" + number(kPlot) +
            "\" height=\"" + number(height_) + "\"/>\n";
    text(kLeft, top_ - 6.0, "start", title);
    text(kLeft + kPlot, top_ + height_ + 28.0, "end", x_label);
  }

  void line(const Points& points, const char* style) const {
    svg_ += std::string("<polyline class=\"") + style + "\" points=\"";
    Eigen::Vector2d drawn(-1e9, 0.0);
    for (const Eigen::Vector2d& p : points) {
      const Eigen::Vector2d at(x(p.x()), y(p.y()));
      if ((at - drawn).norm() < kFinest && &p != &points.back()) continue;
      svg_ += number(at.x()) + "," + number(at.y()) + " ";
      drawn = at;
    }
    svg_ += "\"/>\n";
  }

  void mark(double at, const std::string& name) const {
    svg_ += "<line class=\"screen\" x1=\"" + number(x(at)) + "\" x2=\"" + number(x(at)) + "\" y1=\"" + number(top_) +
            "\" y2=\"" + number(top_ + height_) + "\"/>\n";
    text(x(at) + 3.0, top_ + 12.0, "start", name);
  }

 private:
  double x(double value) const { return kLeft + kPlot * (value - x_.low) / (x_.high - x_.low); }
  double y(double value) const { return top_ + height_ * (y_.high - value) / (y_.high - y_.low); }
  void rule(double x1, double y1, double x2, double y2) const {
    svg_ += "<line class=\"grid\" x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" +
            number(y2) + "\"/>\n";
  }
  void text(double at_x, double at_y, const char* anchor, const std::string& words) const {
    svg_ += "<text x=\"" + number(at_x) + "\" y=\"" + number(at_y) + "\" text-anchor=\"" + anchor + "\">" +
            escaped(words) + "</text>\n";
  }

  std::string& svg_;
  double top_, height_;
  Range x_, y_;
};

/// One number of every bin that is crossed, in the middle of the bin.
template <class Get>
Points along(const LoadedProfile& p, const std::vector<ProfileBin>& bins, Get get) {
  Points points;
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

/// The share of the blocks that goes farther than a distance, as stairs without steps: at the end of each bin.
Points beyond(const Runout& runout, double width) {
  Points points{{0.0, 1.0}};
  std::uint64_t stopped = 0;
  for (std::size_t i = 0; i < runout.stops.size(); ++i) {
    stopped += runout.stops[i];
    points.emplace_back(width * static_cast<double>(i + 1),
                        static_cast<double>(runout.released - stopped) / static_cast<double>(runout.released));
  }
  return points;
}

constexpr char kStyle[] =
    "<style>text{font:12px sans-serif;fill:#333}polyline,.frame{fill:none}.frame{stroke:#555}.grid{stroke:#e3e3e3}"
    ".ground{stroke:#222;stroke-width:2}.zone{stroke:#c8791b;stroke-width:5}.path{stroke:#0b62c4;stroke-width:.6;"
    "opacity:.45}"
    ".screen{stroke:#b0127b;stroke-dasharray:4 "
    "3}.max{stroke:#999}.p99{stroke:#d9480f}.p95{stroke:#d9480f;stroke-width:2}"
    ".p50{stroke:#1f7a33;stroke-width:2}.mean{stroke:#1f7a33;stroke-dasharray:5 "
    "3}.beyond{stroke:#0b62c4;stroke-width:2}"
    "</style>\n";

void draw_ground(const Panel& panel, const LoadedProfile& p, std::span<const RecordedPath> paths) {
  const Scenario& s = p.loaded.scenario;
  const Grid& grid = s.surface.grid();
  for (const RecordedPath& path : paths) {
    Points points;
    for (const PathPoint& at : path.points) points.emplace_back(grid.west + at.x, p.datum + at.z);
    panel.line(points, "path");
  }
  panel.line(p.profile.nodes, "ground");
  Points zone;
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
  std::string body;
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
  const std::string size = number(top + kPanel + kGap, "%.0f");
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(kWidth, "%.0f") + "\" height=\"" + size +
         "\" viewBox=\"0 0 " + number(kWidth, "%.0f") + " " + size + "\">\n" + kStyle +
         "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n" + body + "</svg>\n";
}

}  // namespace talus::io
