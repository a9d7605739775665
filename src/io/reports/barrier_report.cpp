#include "talus/io/reports/barrier_report.hpp"

#include <algorithm>
#include <cmath>
#include <list>

#include "barrier_stretches.hpp"
#include "io/files/json.hpp"
#include "io/files/own_files.hpp"
#include "io/files/posix_bytes.hpp"
#include "io/results/frequency_record.hpp"
#include "talus/base/error.hpp"
#include "talus/base/vector.hpp"
#include "talus/base/version.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/files/staged_path.hpp"

namespace talus::io {
namespace {

/// A row of the table of design values: name, value, unit, origin.
struct DesignRow {
  std::string name;
  double value;
  std::string unit, from;
};

std::string between(const Interval& i, double factor) {
  return "[" + with_digits(factor * i.low, 3) + ", " + with_digits(factor * i.high, 3) + "]";
}

/// Bounds of a share in percent, as fine as percent() tells it.
std::string between_percents(const Interval& i) {
  return between({i.low < kSmallestShare ? 0.0 : i.low, std::max(i.high, kSmallestShare)}, 100.0);
}

std::vector<DesignRow> design_rows(const BarrierReport& r) {
  const BarrierDesign& d = r.design;
  const DesignFactors& f = r.factors;
  const std::string rank = with_digits(100.0 * f.percentile, 4),
                    reach = " x gTr " + with_digits(f.trajectory, 4) + " x gDp " + with_digits(f.topography, 4);
  const double diameter = diameter_of(r.block.volume);
  return {{"v" + rank, d.speed_percentile, "m/s", "of the crossings"},
          {"v_d", d.speed, "m/s", "v" + rank + reach},
          {"V", r.block.volume, "m3", r.block_from + ", diameter " + with_digits(diameter, 4) + " m"},
          {"m_d", d.mass, "kg",
           "V x " + with_digits(r.block.density, 4) + " kg/m3 x gVol " + with_digits(f.volume, 4) + " x gG " +
               with_digits(f.density, 4)},
          {"E_d", d.energy * 1e-3, "kJ", "1/2 m_d v_d^2"},
          {"E" + rank, d.energy_percentile * 1e-3, "kJ", "of the crossings, no part of the design"},
          {"SEL", d.sel * 1e-3, "kJ", "E_d x gE " + with_digits(f.sel, 4)},
          {"MEL", d.mel * 1e-3, "kJ", "E_d x gE " + with_digits(f.mel, 4)},
          {"h" + rank, d.height_percentile, "m", "of the crossings, vertical, of the block's lowest point"},
          {"f_min", d.freeboard, "m", "half the block, at least " + with_digits(f.freeboard, 4) + " m"},
          {"h_i", d.height, "m", "h" + rank + reach + " + f_min"},
          {"h_top", d.top, "m", "h" + rank + reach + " + diameter: of the block's top"}};
}

/// A cell of a column: its text and at least one blank.
std::string cell(const std::string& text, std::size_t width) {
  return padded(text + ' ', width);
}

/// "[0.9, 1.1]"
std::string between(const Bounded& b) {
  return between(Interval{b.low, b.high}, 1.0);
}

/// The crossings whose frequencies are known: the simulated ones, also where the probabilities are of observed ones.
constexpr const char* kWithFrequency = "the simulated crossings";

std::string reliability_text(const Reliability& r) {
  std::string text = "  " + cell(r.quantity, 14) + "Weibull shape " + with_digits(r.fit.law.shape, 3) + " " +
                     between(r.fit.shape, 1.0) + ", scale " + with_digits(r.fit.law.scale, 3) + " " + r.unit + " " +
                     between(r.fit.scale, 1.0) + "; A2 = " + with_digits(r.fit.distance, 3) +
                     (r.fit.accepted() ? " agrees" : " DEPARTS") + " (5 % limit 0.757)" +
                     (r.fit.zeros > 0 ? "; " + std::to_string(r.fit.zeros) + " of " + std::to_string(r.fit.values) +
                                            " are 0 and no part of the fit"
                                      : "") +
                     "\n";
  for (const Reliability::Limit& l : r.limits)
    text +=
        "    " + cell(l.name, 6) + cell(with_digits(l.value, 4) + " " + r.unit, 14) + "exceeded by " +
        (r.fit.accepted()
             ? cell(percent(l.exceeded.fitted) + " " + between_percents(l.exceeded.fitted_bounds), 28) + "of the law, "
             : std::string()) +
        percent(l.exceeded.observed) + " " + between(l.exceeded.observed_bounds, 100.0) + " of the values\n" +
        (l.per_year ? "          by frequency: " + frequency_text(l) + "\n" : "");
  return text;
}

std::string once_in_text(const BarrierReport& r) {
  if (r.once_in.empty()) return "";
  std::string text = "\nreached anywhere on the line once in so many years, without factors, by " +
                     std::string(kWithFrequency) + " [95 %]\n";
  for (const OnceIn& o : r.once_in)
    text += "  " + cell(readable(o.years) + " years", 12) + cell("energy " + value_once_text(o.energy) + " kJ", 32) +
            cell("jump height " + value_once_text(o.height) + " m", 34) +
            cell(std::string(kCentre) + " " + value_once_text(o.centre) + " m", 36) + "speed " +
            value_once_text(o.speed) + " m/s\n";
  return text;
}

Json once_in_of(const BarrierReport& r) {
  const auto bounded = [](const Bounded& b) {
    Json json = bounded_of(b);
    if (!std::isfinite(b.high)) json["high"] = nullptr;
    return json;
  };
  Json rows = Json::array();
  for (const OnceIn& o : r.once_in)
    rows.push_back({{"years", o.years},
                    {"energy_kj", bounded(o.energy)},
                    {"jump_height_m", bounded(o.height)},
                    {"centre_height_m", bounded(o.centre)},
                    {"speed_ms", bounded(o.speed)}});
  return rows;
}

std::string stretch_text(const Stretch& s) {
  return with_digits(s.width(), 4) + " m, from " + with_digits(s.from, 4) + " m to " + with_digits(s.to, 4) +
         " m along the line (" + percent(s.share) + " of the crossings)";
}

Json stretch_of(const Stretch& s) {
  return {{"width_m", s.width()}, {"from_m", s.from}, {"to_m", s.to}, {"share", s.share}};
}

std::string width_text(const BarrierWidth& width, double containment) {
  return "\nwidth\n  for a containment of " + percent(containment) + "  " + stretch_text(width.shortest) +
         "\n  by the map                   " +
         (width.above ? stretch_text(*width.above) + ": " : std::string("none: no ")) + "bins of " +
         with_digits(width.bin, 4) + " m that more than " + percent(1.0 - containment) +
         " of the released blocks cross\n";
}

Json width_of(const BarrierWidth& width, double containment) {
  return {{"target", containment},
          {"shortest", stretch_of(width.shortest)},
          {"bin_m", width.bin},
          {"by_impact_probability", width.above ? stretch_of(*width.above) : Json()}};
}

Json reliability_of(const Reliability& r) {
  Json limits = Json::array();
  for (const Reliability::Limit& l : r.limits)
    limits.push_back({{"name", l.name},
                      {"value", l.value},
                      {"weibull", l.exceeded.fitted},
                      {"weibull_interval", json_of(l.exceeded.fitted_bounds, unrounded)},
                      {"share", l.exceeded.observed},
                      {"share_interval", json_of(l.exceeded.observed_bounds, unrounded)},
                      {"share_by_frequency", l.by_frequency ? Json(*l.by_frequency) : Json()},
                      {"per_year", l.per_year ? bounded_of(*l.per_year) : Json()}});
  return {{"quantity", r.quantity},
          {"unit", r.unit},
          {"values", r.fit.values},
          {"zeros", r.fit.zeros},
          {"shape", r.fit.law.shape},
          {"shape_interval", json_of(r.fit.shape, unrounded)},
          {"scale", r.fit.law.scale},
          {"scale_interval", json_of(r.fit.scale, unrounded)},
          {"anderson_darling", r.fit.distance},
          {"anderson_darling_5_percent", kAndersonDarling5},
          {"agrees", r.fit.accepted()},
          {"exceeded", std::move(limits)}};
}

/// ",0.01,0.005,0.02"
std::string csv_share(double share, const Interval& bounds) {
  return ',' + with_digits(share, 6) + ',' + with_digits(bounds.low, 6) + ',' + with_digits(bounds.high, 6);
}

/// "12 blocks cross it"; with pieces "40 crossings (blocks and pieces) of 12 blocks".
std::string crossings_text(const BarrierReport& r) {
  if (!r.pieces()) return std::to_string(r.crossings) + " blocks cross it";
  return std::to_string(r.crossings) + " crossings (blocks and pieces) of " + std::to_string(r.blocks) + " blocks";
}

/// " (SEL 120 kJ, h_i 3.2 m)" of a design that was written; empty if it does not say.
std::string written_values(const Json& design) {
  std::vector<std::string> texts;
  try {
    for (const Json& row : design.at("design"))
      for (const char* name : {"SEL", "h_i"})
        if (row.at("name") == name)
          texts.push_back(std::string(name) + " " + with_digits(row.at("value").get<double>(), 4) + " " +
                          row.at("unit").get<std::string>());
  } catch (const Json::exception&) {
    return "";
  }
  return texts.empty() ? "" : " (" + joined(texts) + ")";
}

/// The files of a design under hidden names, until all are complete: a full disk leaves the earlier design whole.
class NewDesign {
 public:
  NewDesign(std::filesystem::path folder, std::string name) : folder_(std::move(folder)), name_(std::move(name)) {}

  /// @return the hidden name of the new file with this ending
  const std::filesystem::path& add(const std::string& end) {
    const std::filesystem::path file = folder_ / (name_ + end);
    return files_.emplace_back(StagedPath::Kind::File, file, file.extension().string()).hidden();
  }
  void add(const std::string& end, const std::string& text) { write_text(add(end), text, name_ + end); }
  /// Gives the files their names, in the order in which they were added.
  void commit() {
    for (const StagedPath& file : files_) synchronise(file.hidden());
    for (StagedPath& file : files_) {
      remove_beside(file.path());
      if (const std::error_code error = file.commit())
        throw std::runtime_error(file.path().filename().string() +
                                 ": cannot be written: " + system_text(error.value()));
    }
  }

 private:
  std::filesystem::path folder_;
  std::string name_;
  std::list<StagedPath> files_;
};

}  // namespace

std::optional<std::string> write_barrier(const std::filesystem::path& folder, const std::string& name,
                                         const BarrierReport& report, const Screen& line, const std::string& crs_wkt) {
  const std::filesystem::path file = folder / (name + ".json");
  const bool earlier = is_design(file);
  for (const std::string_view end : kOfDesign)
    if (const auto own = folder / (name + std::string(end)); !earlier && std::filesystem::exists(own))
      throw InputError(own.string() + ": is there and of no earlier design by talus barrier (no " +
                       file.filename().string() + " of it), must not be replaced: move it or give it another name");
  if (const auto own = folder / (name + ".gpkg"); std::filesystem::exists(own) && !is_of_design(own, name))
    throw InputError(own.string() + ": is there and was not written by talus barrier (no layer " + name +
                     " with a field mel_kj), must not be replaced: move it or give it another name");
  const std::string json = barrier_json(report);
  std::optional<std::string> replaced;
  if (earlier)
    if (const Json design = read_record(file); json_text(design) != json)
      replaced = "replaces the earlier design of screen " + report.screen + written_values(design);
  NewDesign design(folder, name);
  design.add(".json", json);  // first: it says that the tables are ours
  design.add(".csv", barrier_csv(report));
  if (report.width) {  // a profile has no line
    design.add("_stretches.csv", stretches_csv(report));
    write_stretches(design.add(".gpkg"), name, report, line, crs_wkt);
  }
  design.commit();
  return replaced;
}

std::string value_once_text(const Bounded& b) {
  if (std::isnan(b.value)) return "?";
  return with_digits(b.value, 3) + " [" + with_digits(b.low, 3) + ", " +
         (std::isfinite(b.high) ? with_digits(b.high, 3) : "?") + "]";
}

std::optional<std::string> often_note(const BarrierReport& r) {
  if (r.once_in.empty()) return std::nullopt;
  const auto& [rarest, energy, jump, centre, speed] = r.once_in.back();
  const double sel = r.design.sel * 1e-3, height = r.design.height;
  std::vector<std::string> texts;
  if (energy.high > sel)
    texts.push_back("with " + value_once_text(energy) + " kJ (SEL " + with_digits(sel, 4) + " kJ)");
  if (centre.high > height)
    texts.push_back("with its centre " + value_once_text(centre) + " m above the ground (h_i " +
                    with_digits(height, 4) + " m)");
  if (texts.empty()) return std::nullopt;
  const std::string years = "once in " + readable(rarest) + " years",
                    may = energy.value > sel || centre.value > height ? "" : "may ";
  const bool known = std::isfinite(energy.high) && std::isfinite(centre.high);
  return "blocks " + may + "exceed this design more often than " + years + ": " + years + " one passes " +
         texts.front() + (texts.size() > 1 ? ", one " + texts.back() : "") +
         ". The design holds a share of the blocks, however many fall. If that is too often, build for the "
         "upper bounds, which have no safety factors, or for another note's value if that is higher" +
         (known ? "" : "; a bound \"?\" is not known: run more trajectories first");
}

std::string frequency_text(const Reliability::Limit& l) {
  if (!l.by_frequency || !l.per_year) return "";
  std::string text = percent(*l.by_frequency) + " of " + kWithFrequency + ", ";
  if (!(l.per_year->value > 0.0)) return text + "rarer than once in " + readable(1.0 / l.per_year->high) + " years";
  const Bounded years = return_period(*l.per_year);
  return text + "once in " + readable(years.value) + " years [" + readable(years.low) + ", " + readable(years.high) +
         "]";
}

std::string barrier_text(const BarrierReport& r) {
  std::string text = "screen " + r.screen + ": " + crossings_text(r) + ", " +
                     percent(static_cast<double>(r.blocks) / r.released) + " of those released";
  if (r.per_year) text += "; " + with_digits(r.per_year->value, 3) + " per year " + between(*r.per_year);
  text += std::string("\nevery block") + (r.pieces() ? " and piece" : "") + " counts " + r.weighting +
          "\n\ndesign values\n";
  for (const DesignRow& row : design_rows(r))
    text += "  " + cell(row.name, 8) + cell(with_digits(row.value, 4) + " " + row.unit, 14) + row.from + "\n";
  text += "  Choose the net by MEL or by SEL, not by both: docs/barrier.md, \"Design values\".\n";
  text += std::string("\nprobability that a block") + (r.pieces() ? " or piece" : "") + " exceeds them, by " +
          r.values + " [95 %]\n";
  for (const Reliability& quantity : r.reliability) text += reliability_text(quantity);
  text += once_in_text(r) + stretches_text(r);
  if (r.width) text += width_text(*r.width, r.containment);
  for (const std::string& note : r.notes) text += "\nnote: " + note + "\n";
  return text;
}

std::string barrier_json(const BarrierReport& r) {
  Json json;
  json["program"] = "talus";
  json["version"] = version();
  json["screen"] = r.screen;
  json["released"] = r.released;
  json["crossings"] = r.crossings;
  json["blocks"] = r.blocks;
  json["weighting"] = r.weighting;
  if (!r.frequency.file.empty()) json["frequency"] = json_of(r.frequency, r.events_per_year);
  json["effective_crossings"] = r.effective;
  json["crossings_per_year"] = r.per_year ? bounded_of(*r.per_year) : Json();
  json["factors"] = {{"gTr", r.factors.trajectory},
                     {"gDp", r.factors.topography},
                     {"gVol", r.factors.volume},
                     {"gG", r.factors.density},
                     {"gE_sel", r.factors.sel},
                     {"gE_mel", r.factors.mel},
                     {"percentile", 100.0 * r.factors.percentile},
                     {"least_freeboard_m", r.factors.freeboard}};
  Json design = Json::array();
  for (const DesignRow& row : design_rows(r))
    design.push_back({{"name", row.name}, {"value", row.value}, {"unit", row.unit}, {"from", row.from}});
  json["design"] = std::move(design);
  json["reliability_of"] = r.values;
  if (r.per_year) json["frequency_of"] = kWithFrequency;
  json["reliability"] = Json::array();
  for (const Reliability& quantity : r.reliability) json["reliability"].push_back(reliability_of(quantity));
  json["once_in"] = once_in_of(r);
  json["longest_stretch_m"] = r.longest;
  json["stretches"] = stretches_of(r);
  json["containment"] = r.width ? width_of(*r.width, r.containment) : Json();
  json["notes"] = r.notes;
  return json_text(json);
}

std::string barrier_csv(const BarrierReport& r) {
  std::string text = "screen,name,value,unit,weibull,weibull_low,weibull_high,share,share_low,share_high\n";
  const std::string screen = csv_field(r.screen);
  for (const DesignRow& row : design_rows(r)) {
    text += screen + ',' + row.name + ',' + with_digits(row.value, 6) + ',' + row.unit;
    std::string law = ",,,", share = ",,,";
    for (const Reliability& quantity : r.reliability)
      for (const Reliability::Limit& limit : quantity.limits) {
        if (limit.name != row.name || quantity.quantity == kCentre) continue;  // h_i: of the jump, as in the paper
        if (quantity.fit.accepted()) law = csv_share(limit.exceeded.fitted, limit.exceeded.fitted_bounds);
        share = csv_share(limit.exceeded.observed, limit.exceeded.observed_bounds);
      }
    text += law + share + '\n';
  }
  return text;
}

}  // namespace talus::io
