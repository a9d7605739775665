#include "report_barriers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "svg.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"
#include "talus/base/vector.hpp"

namespace talus::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBarriers = 20, kMostStretches = 400;

void read_limits(const Json& json, BarrierPart& part) {
  for (const Json& quantity : json.value("reliability", Json::array()))
    for (const Json& one : quantity.at("exceeded")) {
      BarrierPart::Limit limit{quantity.at("quantity").get<std::string>(), one.at("name").get<std::string>(),
                               quantity.value("unit", "")};
      limit.value = number_of(one, "value");
      limit.weibull = number_of(one, "weibull");
      limit.share = number_of(one, "share");
      limit.share_low = one.at("share_interval").at(0).get<double>();
      limit.share_high = one.at("share_interval").at(1).get<double>();
      limit.agrees = quantity.value("agrees", false);
      if (const Json per_year = one.value("per_year", Json()); per_year.is_object()) {
        limit.rarer = !(number_of(per_year, "value") > 0.0);
        if (const double often = number_of(per_year, limit.rarer ? "high" : "value"); often > 0.0)
          limit.years = 1.0 / often;
      }
      part.limits.push_back(std::move(limit));
    }
}

/// NaN of what is not in an earlier design.
Bounded bounded_from(const Json& json) {
  if (json.is_null()) return {kNotGiven, kNotGiven, kNotGiven};
  return {number_of(json, "value"), number_of(json, "low"),
          number_of(json, "high", std::numeric_limits<double>::infinity())};
}

BarrierPart part_of(const Json& json) {
  BarrierPart part;
  part.screen = json.at("screen").get<std::string>();
  part.weighting = json.value("weighting", "");
  part.crossings = number_of(json, "crossings");
  part.blocks = number_of(json, "blocks", part.crossings);  // not in earlier designs
  for (const Json& one : json.at("design"))
    part.design.push_back(
        {one.at("name").get<std::string>(), one.value("unit", ""), one.value("from", ""), number_of(one, "value")});
  read_limits(json, part);
  for (const Json& one : json.value("once_in", Json::array()))
    part.once_in.push_back({number_of(one, "years"), bounded_from(one.at("energy_kj")),
                            bounded_from(one.at("jump_height_m")), bounded_from(one.value("centre_height_m", Json())),
                            bounded_from(one.at("speed_ms"))});
  for (const Json& one : json.value("stretches", Json::array())) {
    if (part.stretches.size() == kMostStretches) break;
    BarrierPart::Stretch stretch{number_of(one, "from_m"), number_of(one, "to_m"), number_of(one, "crossings")};
    if (const Json design = one.value("design", Json()); design.is_object()) {
      stretch.sel = number_of(design, "sel_kj");
      stretch.mel = number_of(design, "mel_kj");
      stretch.height = number_of(design, "h_i_m");
    }
    part.stretches.push_back(stretch);
  }
  part.notes = texts_of(json, "notes");
  part.frequency = frequency_of(json);
  return part;
}

/// The net at its height, and the design block with its speed, to scale.
Markup section_drawing(const BarrierPart& part) {
  const double height = part.value("h_i"), diameter = diameter_of(part.value("V"));
  if (!(height > 0.0 && height < 1e3 && diameter > 0.0 && diameter < 1e3)) return {};
  constexpr double kGround = 170.0, kNet = 250.0;
  const double below = std::max(0.0, height - part.value("f_min"));  // the clearance under the block
  const double scale = 130.0 / std::max(height, below + diameter), radius = 0.5 * scale * diameter;
  const double centre = kGround - scale * below - radius;
  Svg svg('\'', "");
  svg.element("line", {{"x1", 10}, {"x2", 370}, {"y1", kGround}, {"y2", kGround}, {"stroke", "#555"}});
  svg.element("line", {{"x1", kNet},
                       {"x2", kNet},
                       {"y1", kGround},
                       {"y2", kGround - scale * height},
                       {"stroke", "#00695c"},
                       {"stroke-width", 4}});
  svg.element("circle", {{"cx", 110}, {"cy", centre}, {"r", radius}, {"fill", "#bbb"}, {"stroke", "#555"}});
  svg.element("line", {{"x1", 115.0 + radius},
                       {"x2", std::max(140.0 + radius, 225.0)},
                       {"y1", centre},
                       {"y2", centre},
                       {"stroke", "#b3261e"},
                       {"stroke-width", 2}});
  svg.words({{"x", kNet + 8.0}, {"y", kGround - 0.5 * scale * height}}, "h_i = " + with_digits(height, 3) + " m");
  svg.words({{"x", 10}, {"y", kGround + 15.0}}, "design block " + with_digits(diameter, 3) +
                                                    " m, v_d = " + with_digits(part.value("v_d"), 3) +
                                                    " m/s, MEL = " + with_digits(part.value("MEL"), 4) + " kJ");
  return svg.drawing({{"width", 380}, {"height", 195}, {"viewBox", "0 0 380 195"}});
}

/// What each stretch needs along the line: bars of SEL, and the value of the whole line.
Markup stretch_chart(const BarrierPart& part, bool energy) {
  const auto of = [&](const BarrierPart::Stretch& s) { return energy ? s.sel : s.height; };
  const double whole = part.value(energy ? "SEL" : "h_i");
  double most = whole, last = 0.0;
  for (const auto& s : part.stretches) most = std::max(most, of(s)), last = std::max(last, s.to);
  if (!(most > 0.0 && last > 0.0)) return {};
  const Axis x{0.0, last, 44.0, 640.0}, y{0.0, 1.05 * most, 130.0, -108.0};
  Svg svg('\'', "");
  svg.words({{"x", 44}, {"y", 12}, {"font-weight", "bold"}},
            energy ? "SEL of each stretch [kJ]" : "h_i of each stretch [m]");
  for (const auto& s : part.stretches) {
    svg.element("rect", {{"x", x(s.from)},
                         {"y", y(of(s))},
                         {"width", std::max(0.5, x(s.to) - x(s.from) - 1.0)},
                         {"height", y(0.0) - y(of(s))},
                         {"fill", of(s) > whole ? "#b3261e" : "#5b7fa6"}});
    if (s.crossings > 0.0 && !(of(s) > 0.0))
      svg.words({{"x", 0.5 * (x(s.from) + x(s.to))}, {"y", y(0.0) - 3.0}, {"text-anchor", "middle"}}, "?");
  }
  svg.element(
      "line",
      {{"x1", 44}, {"x2", 684}, {"y1", y(whole)}, {"y2", y(whole)}, {"stroke", "#222"}, {"stroke-dasharray", "6 3"}});
  svg.words({{"x", 688}, {"y", y(whole) + 4.0}}, "line");
  for (const double tick : ticks(0.0, 1.05 * most, 4))
    svg.words({{"x", 40}, {"y", y(tick) + 4.0}, {"text-anchor", "end"}}, with_digits(tick, 4));
  for (const double tick : ticks(0.0, last, 8))
    svg.words({{"x", x(tick)}, {"y", 144}, {"text-anchor", "middle"}}, with_digits(tick, 5));
  svg.words({{"x", 364}, {"y", 158}, {"text-anchor", "middle"}}, "m along the line");
  return svg.drawing({{"width", 720}, {"height", 162}, {"viewBox", "0 0 720 162"}});
}

std::string once_in(const BarrierPart::Limit& limit) {
  if (!(limit.years > 0.0)) return "-";
  return (limit.rarer ? "rarer than once in " : "") + readable(limit.years) + " years";
}

Markup limits_table(const BarrierPart& part) {
  Markup html =
      "<table><tr><th>quantity</th><th>value</th><th>exceeded by, of the values [95 %]</th><th>by the Weibull "
      "law</th><th>once in</th></tr>\n"_html;
  for (const BarrierPart::Limit& l : part.limits)
    html += "<tr><td>"_html + l.quantity + "</td><td>" + l.name + " = " + with_digits(l.value, 4) + " " + l.unit +
            "</td><td>" + percent(l.share) + " [" + with_digits(100.0 * l.share_low, 3) + ", " +
            with_digits(100.0 * l.share_high, 3) + "]</td><td>" + (l.agrees ? percent(l.weibull) : "it does not fit") +
            "</td><td>" + once_in(l) + "</td></tr>\n";
  return html + "</table>\n";
}

Markup once_in_table(const BarrierPart& part) {
  if (part.once_in.empty()) return {};
  Markup html =
      "<table><tr><th>reached on the line once in [95 %]</th><th>energy, kJ</th><th>jump height, m</th>"
      "<th>centre height, m</th><th>speed, m/s</th></tr>\n"_html;
  for (const OnceIn& o : part.once_in)
    html += "<tr><td>"_html + readable(o.years) + " years</td><td>" + value_once_text(o.energy) + "</td><td>" +
            value_once_text(o.height) + "</td><td>" + value_once_text(o.centre) + "</td><td>" +
            value_once_text(o.speed) + "</td></tr>\n";
  return html +
         "</table>\n<p class='note'>Of the simulated crossings, without factors. 0: crossings are rarer; ?: too few "
         "trajectories for a bound.</p>\n";
}

Markup note_html(const std::string& note) {
  return "<p class='look'>Note: "_html + note + "</p>\n";
}

/// Notes that all barriers have, as those of the run: told once.
std::vector<std::string> common_notes(const std::vector<BarrierPart>& parts) {
  if (parts.size() < 2) return {};
  std::vector<std::string> common = parts.front().notes;
  std::erase_if(common, [&](const std::string& note) {
    return std::ranges::any_of(parts, [&](const BarrierPart& p) { return std::ranges::count(p.notes, note) == 0; });
  });
  return common;
}

Markup barrier_html(const BarrierPart& part, const std::vector<std::string>& told) {
  const bool pieces = part.crossings > part.blocks;
  Markup html = "<h3>Barrier at "_html + part.screen + "</h3>\n<p>" + grouped(part.crossings) +
                (pieces ? " crossings (blocks and pieces) of " + grouped(part.blocks) + " blocks; every block and piece"
                        : std::string(" blocks cross the line; every block")) +
                " counts " + part.weighting + ".</p>\n<table><tr><th>design value</th><th></th><th>from</th></tr>\n";
  for (const BarrierPart::Value& value : part.design)
    html += "<tr><td>"_html + value.name + "</td><td class='n'>" + with_digits(value.value, 4) + " " + value.unit +
            "</td><td>" + value.from + "</td></tr>\n";
  html += "</table>\n<figure>"_html + section_drawing(part) + "</figure>\n" + limits_table(part) + once_in_table(part);
  if (!part.stretches.empty())
    html +=
        "<figure>"_html + stretch_chart(part, true) + "<br>" + stretch_chart(part, false) +
        "<figcaption>Each stretch designed by its own crossings; red: more than the design of the whole line; ?: too "
        "few crossings for a design; dashed: the whole line.</figcaption></figure>\n";
  for (const std::string& note : part.notes)
    if (std::ranges::count(told, note) == 0) html += note_html(note);
  return html;
}

}  // namespace

double BarrierPart::value(const std::string& name) const {
  const auto found = std::ranges::find(design, name, &Value::name);
  return found == design.end() ? 0.0 : found->value;
}

std::vector<BarrierPart> read_barrier_parts(const fs::path& folder, const std::optional<HazardFacts>& hazard) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".json" && entry.path().filename().string().starts_with("barrier_"))
      files.push_back(entry.path());
  std::ranges::sort(files);
  if (files.size() > kMostBarriers) files.resize(kMostBarriers);
  std::vector<BarrierPart> parts;
  for (const fs::path& file : files) {
    BarrierPart& part = parts.emplace_back(understood(file, part_of));
    if (!hazard) continue;
    std::string note = other_frequency_note(part.weighting, part.frequency, hazard->frequency);
    if (!note.empty()) part.notes.push_back(std::move(note));
  }
  return parts;
}

Markup standing_html(const RunFacts& run) {
  constexpr std::size_t kMostRows = 100;
  if (run.barriers.empty()) return {};
  Markup html = "<h2>Barriers of the run</h2>\n<p>They stood in the way of the blocks, and each meeting counts"_html +
                (run.pieces > 0.0 ? ", of blocks and of pieces" : "") +
                ". Caught: below the top and within the capacity. Over: the block's lowest point at the top or above. "
                "Broken: below the top, above the capacity.</p>\n"
                "<table><tr><th>barrier</th><th>height</th><th>capacity</th><th>caught</th>"
                "<th>over</th><th>broken</th></tr>\n";
  for (std::size_t i = 0; i < std::min(run.barriers.size(), kMostRows); ++i) {
    const StandingBarrier& b = run.barriers[i];
    html += "<tr><td>"_html + b.line.id + "</td><td class='n'>" + with_digits(b.height, 4) + " m</td><td class='n'>" +
            b.capacity + " kJ</td><td class='n'>" + grouped(b.caught) + "</td><td class='n'>" + grouped(b.over) +
            "</td><td class='n'>" + grouped(b.broken) + "</td></tr>\n";
  }
  html += "</table>\n";
  if (run.barriers.size() > kMostRows)
    html += "<p class='note'>Only the first "_html + std::to_string(kMostRows) + " are shown.</p>\n";
  return html;
}

Markup barriers_html(const std::vector<BarrierPart>& parts) {
  if (parts.empty()) return {};
  Markup html = "<h2>Barriers</h2>\n"_html;
  const std::vector<std::string> common = common_notes(parts);
  for (const std::string& note : common) html += note_html(note);
  for (const BarrierPart& part : parts) html += barrier_html(part, common);
  return html;
}

}  // namespace talus::io
