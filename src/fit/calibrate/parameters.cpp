#include "talus/fit/calibrate/parameters.hpp"

#include <algorithm>
#include <limits>

#include "talus/base/elementary.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus {
namespace {

constexpr double kReach = 2.5;          // bounds of a ground parameter, in sd from its start
constexpr double kTouchedShare = 0.05;  // share of the paths that touch a zone whose ground is fitted

}  // namespace

double Parameter::value(double z) const {
  const double free = scale == Scale::Log ? centre * exponential(sd * z) : centre + sd * z;
  return std::clamp(free, lower, upper);
}

double Parameter::z(double value) const {
  if (scale == Scale::Linear) return (value - centre) / sd;
  return value > 0.0 ? natural_log(value / centre) / sd : -std::numeric_limits<double>::infinity();
}

double Parameter::within(double place) const {
  return std::clamp(place, z(lower), z(upper));
}

std::vector<Parameter> ground_parameters(const Campaign& campaign, const Model& start,
                                         std::span<const std::string> keys, const std::vector<bool>& zones) {
  static const std::vector<std::string> known{"theta_scale", "psi_scale", "En50", "Et50", "phi"};
  std::vector<Parameter> parameters;
  for (std::size_t zone = 0; zone < start.grounds.size(); ++zone)
    for (const std::string& key : keys) {
      const auto fields = ground_fields();
      const auto field = std::find_if(fields.begin(), fields.end(), [&](const auto& f) { return f.key == key; });
      if (field == fields.end() || std::find(known.begin(), known.end(), key) == known.end())
        throw InputError("'" + key + "' is no parameter that can be fitted" + known_names(key, known) +
                         "; numbers of effects are called effects.NAME.NUMBER, as effects.vegetation-drag.coefficient");
      if (std::ranges::count(keys, key) > 1) throw InputError("'" + key + "' is to be fitted twice: name it once");
      if (!zones[zone]) continue;
      Parameter p;
      p.key = "ground.zones." + campaign.zone_names[zone] + "." + key;
      p.unit = field->unit == "1" ? "" : std::string(field->unit);
      p.scale = key == "phi" ? Parameter::Scale::Linear : Parameter::Scale::Log;
      p.sd = key == "phi" ? 8.0 : 1.0;
      p.centre = field->get(start.grounds[zone]);
      if (p.scale == Parameter::Scale::Log) p.centre = std::max(p.centre, kLeastStart);
      p.reach = kReach;
      p.lower = field->min;
      p.upper = field->max;
      const double low = p.scale == Parameter::Scale::Log ? p.centre * exponential(-kReach) : p.centre - kReach * p.sd;
      const double high = p.scale == Parameter::Scale::Log ? p.centre * exponential(kReach) : p.centre + kReach * p.sd;
      p.lower = std::max(p.lower, low);
      p.upper = std::min(p.upper, high);
      p.get = [get = field->get, zone](const Model& model) { return get(model.grounds[zone]); };
      p.set = [set = field->set, zone](Model& model, double value) { set(model.grounds[zone], value); };
      parameters.push_back(std::move(p));
    }
  if (parameters.empty())
    throw InputError(
        "no zone is touched by enough of the simulated paths, so that nothing can be fitted: are the releases on the "
        "slope?");
  return parameters;
}

void check_start(std::span<const Parameter> parameters, const Model& start) {
  for (const Parameter& p : parameters)
    if (p.scale == Parameter::Scale::Log && p.get(start) < kLeastStart)
      throw InputError(p.key + " = " + with_digits(p.get(start), 3) + " at the start, must be " + text_of(kLeastStart) +
                       " at least to be fitted, as a search by factors does not leave 0: give another start by "
                       "--parameters, or leave it out of --fit");
}

std::vector<bool> touched_zones(const Campaign& campaign, std::span<const BlockRuns> runs) {
  std::vector<double> hits(campaign.zone_names.size(), 0.0);
  double trials = 0.0;
  for (const BlockRuns& block : runs) {
    trials += block.trials;
    for (std::size_t zone = 0; zone < block.zone_hits.size(); ++zone)  // a band adds a copy of each zone
      hits[zone % hits.size()] += block.zone_hits[zone];
  }
  std::vector<bool> touched;
  touched.reserve(hits.size());
  for (const double count : hits) touched.push_back(count > 0.0 && count >= kTouchedShare * trials);
  return touched;
}

Model model_at(const Model& start, std::span<const Parameter> free, const Eigen::VectorXd& z) {
  Model model = start;
  for (std::size_t i = 0; i < free.size(); ++i) free[i].set(model, free[i].value(z[static_cast<Eigen::Index>(i)]));
  return model;
}

}  // namespace talus
