#include "barrier_stretches.hpp"

#include <algorithm>
#include <functional>
#include <optional>

namespace talus::io {
namespace {

/// Text at the right of a column.
std::string right(const std::string& text, std::size_t width) {
  return std::string(width > text.size() ? width - text.size() : 1, ' ') + text;
}

std::string kilojoules(double joules) {
  return with_digits(joules * 1e-3, 4);
}

/// Width of the column of crossings.
std::size_t crossings_width(const BarrierReport& r) {
  return r.pieces() ? 11 : 9;
}

std::string stretch_line(const BarrierReport& r, const StretchRow& row) {
  const StretchDesign& s = row.values;
  std::string text = right(with_decimals(s.stretch.from, 1), 10) + right(with_decimals(s.stretch.to, 1), 10) +
                     right(std::to_string(s.crossings), crossings_width(r)) + right(percent(s.stretch.share), 10);
  if (row.per_year) text += right(with_digits(row.per_year->value, 3), 10);
  text += right(kilojoules(s.largest_energy), 11) + right(with_digits(s.largest_height, 3), 11);
  if (!s.design || !s.beyond)
    return text + "    too few: as many as " + with_digits(s.effective, 3) + " of equal weight\n";
  return text + right(kilojoules(s.design->sel), 10) + right(kilojoules(s.design->mel), 10) +
         right(with_digits(s.design->height, 3), 8) + right(percent(s.beyond->sel), 11) +
         right(percent(s.beyond->height), 11) + "\n";
}

/// The stretch with the highest value; nothing if none has a design.
template <class Value>
const StretchDesign* highest_of(const BarrierReport& r, Value value) {
  const StretchDesign* found = nullptr;
  for (const StretchRow& row : r.stretches)
    if (row.values.design &&
        (found == nullptr || std::invoke(value, *row.values.design) > std::invoke(value, *found->design)))
      found = &row.values;
  return found;
}

/// Where a value of the whole line is too low: stretches side by side as one, "from-to m", and the value that is enough
/// everywhere.
struct Missing {
  std::vector<std::string> where;
  double highest;
};

template <class Value>
Missing lack_of(const BarrierReport& r, Value value) {
  const double line = std::invoke(value, r.design);
  Missing lack{{}, line};
  std::optional<Stretch> open;
  const auto close = [&] {
    if (open) lack.where.push_back(with_decimals(open->from, 1) + "-" + with_decimals(open->to, 1) + " m");
    open.reset();
  };
  for (const StretchRow& row : r.stretches) {
    if (!row.values.design || !(std::invoke(value, *row.values.design) > line)) {
      close();
      continue;
    }
    if (!open) open = row.values.stretch;
    open->to = row.values.stretch.to;
    lack.highest = std::max(lack.highest, std::invoke(value, *row.values.design));
  }
  close();
  return lack;
}

std::string from_to(const Stretch& s) {
  return "from " + with_digits(s.from, 4) + " m to " + with_digits(s.to, 4) + " m";
}

Json stretch_row_of(const StretchRow& row) {
  const StretchDesign& s = row.values;
  Json json = {{"from_m", s.stretch.from},
               {"to_m", s.stretch.to},
               {"crossings", s.crossings},
               {"effective_crossings", s.effective},
               {"share", s.stretch.share},
               {"crossings_per_year", row.per_year ? bounded_of(*row.per_year) : Json()},
               {"largest_energy_kj", s.largest_energy * 1e-3},
               {"largest_jump_height_m", s.largest_height},
               {"design", Json()}};
  if (s.design && s.beyond)
    json["design"] = {{"speed_percentile_ms", s.design->speed_percentile},
                      {"height_percentile_m", s.design->height_percentile},
                      {"volume_m3", s.block.volume},
                      {"sel_kj", s.design->sel * 1e-3},
                      {"mel_kj", s.design->mel * 1e-3},
                      {"h_i_m", s.design->height},
                      {"above_sel", s.beyond->sel},
                      {"above_mel", s.beyond->mel},
                      {"above_h_i", s.beyond->height}};
  return json;
}

}  // namespace

std::string stretches_text(const BarrierReport& r) {
  if (r.stretches.empty()) return "";
  std::string text = "\ndesign by stretch, each of " + with_digits(r.longest, 4) +
                     " m at most (--stretch) and by its own crossings\n" + right("from m", 10) + right("to m", 10) +
                     right(r.pieces() ? "crossings" : "blocks", crossings_width(r)) + right("share", 10) +
                     (r.per_year ? right("1/year", 10) : "") + right("largest kJ", 11) + right("largest m", 11) +
                     right("SEL kJ", 10) + right("MEL kJ", 10) + right("h_i m", 8) + right("above SEL", 11) +
                     right("above h_i", 11) + "\n";
  std::size_t empty = 0;
  for (const StretchRow& row : r.stretches)
    if (row.values.crossings == 0)
      ++empty;
    else
      text += stretch_line(r, row);
  if (empty > 0)
    text += "  nothing crosses the other " + std::to_string(empty) + " stretches" +
            (r.without_height > 0.0 ? ": not all of them are safe, see the note below" : "") + "\n";
  const StretchDesign *energy = highest_of(r, &BarrierDesign::sel), *height = highest_of(r, &BarrierDesign::height);
  if (energy != nullptr)
    text += "  highest: SEL " + kilojoules(energy->design->sel) + " kJ " + from_to(energy->stretch) + ", h_i " +
            with_digits(height->design->height, 3) + " m " + from_to(height->stretch) + "\n";
  return text;
}

Json stretches_of(const BarrierReport& r) {
  Json list = Json::array();
  for (const StretchRow& row : r.stretches) list.push_back(stretch_row_of(row));
  return list;
}

std::string stretches_csv(const BarrierReport& r) {
  std::string text =
      "screen,from_m,to_m,crossings,effective_crossings,share,per_year,per_year_low,per_year_high,largest_energy_kj,"
      "largest_jump_height_m,speed_percentile_ms,height_percentile_m,volume_m3,sel_kj,mel_kj,h_i_m,above_sel,above_mel,"
      "above_h_i\n";
  for (const StretchRow& row : r.stretches) {
    const StretchDesign& s = row.values;
    text += csv_field(r.screen) + ',' + with_digits(s.stretch.from, 6) + ',' + with_digits(s.stretch.to, 6) + ',' +
            std::to_string(s.crossings);
    const auto add = [&](double value) { text += ',' + with_digits(value, 6); };
    add(s.effective), add(s.stretch.share);
    if (row.per_year)
      add(row.per_year->value), add(row.per_year->low), add(row.per_year->high);
    else
      text += ",,,";
    add(s.largest_energy * 1e-3), add(s.largest_height);
    if (s.design && s.beyond)
      for (const double value :
           {s.design->speed_percentile, s.design->height_percentile, s.block.volume, s.design->sel * 1e-3,
            s.design->mel * 1e-3, s.design->height, s.beyond->sel, s.beyond->mel, s.beyond->height})
        add(value);
    else
      text += ",,,,,,,,,";
    text += '\n';
  }
  return text;
}

std::optional<std::string> gap_note(double without_height) {
  if (!(without_height > 0.0)) return std::nullopt;
  return percent(without_height) +
         " of the line lie where the DEM has no height (off it, in its outer half cell or in a gap): no block gets "
         "there, so that nothing is told of this part, and the crossings are a lower bound (unsafe)";
}

std::optional<std::string> stretch_note(const BarrierReport& r) {
  const Missing sel = lack_of(r, &BarrierDesign::sel), height = lack_of(r, &BarrierDesign::height);
  const std::string energies = kilojoules(sel.highest) + " kJ", heights = with_digits(height.highest, 3) + " m";
  std::vector<std::string> texts;
  if (!sel.where.empty())
    texts.push_back("SEL (" + kilojoules(r.design.sel) + " kJ) on " + joined(sel.where) + ", which need up to " +
                    energies);
  if (!height.where.empty())
    texts.push_back("h_i (" + with_digits(r.design.height, 4) + " m) on " + joined(height.where) +
                    ", which need up to " + heights);
  if (texts.empty()) return std::nullopt;
  std::string text = "one design for the whole line is too low: " + texts.front();
  if (texts.size() > 1) text += "; " + texts.back();
  return text + ". Give each stretch its own design, or the whole line SEL " + energies + " and h_i " + heights;
}

}  // namespace talus::io
