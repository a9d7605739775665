#include "barrier_stretches.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

#include "io/gdal/dataset.hpp"
#include "io/gdal/layer_file.hpp"
#include "talus/base/error.hpp"
#include "talus/io/results/vector_style.hpp"
#include "talus/simulate/screens/screens.hpp"

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
    return text + "    no design: as much as " + with_digits(s.effective, 3) + " crossings of equal weight, must be " +
           std::to_string(fewest_for_percentile(r.factors.percentile)) + "\n";
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

/// Where the value of the whole line is too low: stretches side by side as one, "from-to m", and the value that is
/// enough everywhere.
struct Missing {
  std::vector<std::string> where;
  double highest;
};

/// @param value  of a stretch, to compare with that of the line; 0 where it has none
template <class Value>
Missing lack_of(const BarrierReport& r, double line, Value value) {
  Missing lack{{}, line};
  std::optional<Stretch> open;
  const auto close = [&] {
    if (open) lack.where.push_back(with_decimals(open->from, 1) + "-" + with_decimals(open->to, 1) + " m");
    open.reset();
  };
  for (const StretchRow& row : r.stretches) {
    const double here = value(row.values);
    if (!(here > line)) {
      close();
      continue;
    }
    if (!open) open = row.values.stretch;
    open->to = row.values.stretch.to;
    lack.highest = std::max(lack.highest, here);
  }
  close();
  return lack;
}

/// A value of the design of a stretch; 0 where it has none.
auto of_design(double BarrierDesign::*value) {
  return [value](const StretchDesign& s) { return s.design ? (*s.design).*value : 0.0; };
}

/// The largest of a stretch without a design; 0 where it has one.
auto without_design(double StretchDesign::*largest) {
  return [largest](const StretchDesign& s) { return s.design ? 0.0 : s.*largest; };
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

/// A number of the stretches in the tables; nothing where a stretch has none.
struct Column {
  const char* name;
  std::function<std::optional<double>(const StretchRow&)> of;
  bool whole = false;
};

std::function<std::optional<double>(const StretchRow&)> of_all(double (*value)(const StretchDesign&)) {
  return [value](const StretchRow& row) -> std::optional<double> { return value(row.values); };
}

std::function<std::optional<double>(const StretchRow&)> per_year(double Bounded::*part) {
  return [part](const StretchRow& row) { return row.per_year ? std::optional((*row.per_year).*part) : std::nullopt; };
}

/// Of the stretches that have a design.
std::function<std::optional<double>(const StretchRow&)> designed(double (*value)(const StretchDesign&)) {
  return [value](const StretchRow& row) {
    return row.values.design && row.values.beyond ? std::optional(value(row.values)) : std::nullopt;
  };
}

const std::vector<Column>& columns() {
  using Design = const StretchDesign&;
  static const std::vector<Column> all{
      {"from_m", of_all([](Design s) { return s.stretch.from; })},
      {"to_m", of_all([](Design s) { return s.stretch.to; })},
      {"crossings", of_all([](Design s) { return static_cast<double>(s.crossings); }), true},
      {"effective_crossings", of_all([](Design s) { return s.effective; })},
      {"share", of_all([](Design s) { return s.stretch.share; })},
      {"per_year", per_year(&Bounded::value)},
      {"per_year_low", per_year(&Bounded::low)},
      {"per_year_high", per_year(&Bounded::high)},
      {"largest_energy_kj", of_all([](Design s) { return s.largest_energy * 1e-3; })},
      {"largest_jump_height_m", of_all([](Design s) { return s.largest_height; })},
      {"speed_percentile_ms", designed([](Design s) { return s.design->speed_percentile; })},
      {"height_percentile_m", designed([](Design s) { return s.design->height_percentile; })},
      {"volume_m3", designed([](Design s) { return s.block.volume; })},
      {"sel_kj", designed([](Design s) { return s.design->sel * 1e-3; })},
      {"mel_kj", designed([](Design s) { return s.design->mel * 1e-3; })},
      {"h_i_m", designed([](Design s) { return s.design->height; })},
      {"above_sel", designed([](Design s) { return s.beyond->sel; })},
      {"above_mel", designed([](Design s) { return s.beyond->mel; })},
      {"above_h_i", designed([](Design s) { return s.beyond->height; })}};
  return all;
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
    text += std::string("  nothing ") + (r.never > 0 ? "that falls " : "") + "crosses the other " +
            std::to_string(empty) + " stretches" +
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
  std::string text = "screen";
  for (const Column& column : columns()) text += std::string(",") + column.name;
  text += '\n';
  for (const StretchRow& row : r.stretches) {
    text += csv_field(r.screen);
    for (const Column& column : columns()) {
      text += ',';
      if (const auto value = column.of(row))
        text += column.whole ? std::to_string(static_cast<std::int64_t>(*value)) : with_digits(*value, 6);
    }
    text += '\n';
  }
  return text;
}

bool is_of_design(const std::filesystem::path& file, const std::string& name) {
  try {
    const Dataset dataset = open_dataset(file, GDAL_OF_VECTOR);
    OGRLayer* const layer = dataset->GetLayerByName(name.c_str());
    return layer != nullptr && layer->GetLayerDefn()->GetFieldIndex("mel_kj") >= 0;
  } catch (const InputError&) {
    return false;  // no layer at all
  }
}

void write_stretches(const std::filesystem::path& file, const std::string& name, const BarrierReport& report,
                     const Screen& line, const std::string& crs_wkt) {
  std::vector<LayerFile::Column> fields{{"screen", OFTString}};
  for (const Column& column : columns()) fields.push_back({column.name, column.whole ? OFTInteger64 : OFTReal});
  const std::unique_ptr<LayerFile> layers = new_layer_file(file, {crs_wkt});
  OGRLayer* layer = layers->add_bulk_layer(name.c_str(), wkbLineString, fields);
  for (const StretchRow& stretch : report.stretches) {
    const GdalMessages messages;
    const Feature row(OGRFeature::CreateFeature(layer->GetLayerDefn()));
    row->SetField(0, report.screen.c_str());
    int next = 1;
    for (const Column& column : columns()) {
      if (const auto value = column.of(stretch)) row->SetField(next, column.whole ? *value : six_digits(*value));
      ++next;
    }
    auto places = std::make_unique<OGRLineString>();
    for (const Eigen::Vector2d& place : part_along(line, stretch.values.stretch.from, stretch.values.stretch.to))
      places->addPoint(place.x(), place.y());
    row->SetGeometryDirectly(places.release());
    layers->append(layer, *row);
  }
  layers->set_style(name, style_of(StyledLayer::Stretches));
  layers->finish();
}

std::optional<std::string> gap_note(double without_height) {
  if (!(without_height > 0.0)) return std::nullopt;
  return percent(without_height) +
         " of the line lie where the DEM has no height (off it, in its outer half cell or in a gap): no block gets "
         "there, so that nothing is known of this part, and the crossings are a lower bound (unsafe)";
}

std::optional<std::string> stretch_note(const BarrierReport& r) {
  const Missing sel = lack_of(r, r.design.sel, of_design(&BarrierDesign::sel));
  const Missing height = lack_of(r, r.design.height, of_design(&BarrierDesign::height));
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

std::optional<std::string> undesigned_note(const BarrierReport& r) {
  const Missing energy = lack_of(r, r.design.sel, without_design(&StretchDesign::largest_energy));
  const Missing height = lack_of(r, r.design.height, without_design(&StretchDesign::largest_height));
  std::vector<std::string> texts;
  if (!energy.where.empty())
    texts.push_back("above SEL on " + joined(energy.where) + " (up to " + kilojoules(energy.highest) + " kJ)");
  if (!height.where.empty())
    texts.push_back("above h_i on " + joined(height.where) + " (up to " + with_digits(height.highest, 3) + " m)");
  if (texts.empty()) return std::nullopt;
  return "on stretches with too few crossings for a design, blocks are " + joined(texts) +
         ": run more trajectories, or give these stretches the design of a similar neighbour";
}

}  // namespace talus::io
