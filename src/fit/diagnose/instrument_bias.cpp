#include "instrument_bias.hpp"

#include <algorithm>

#include "fit/calibrate/amount.hpp"

namespace talus {

void add_biases(std::vector<Candidate>& list, const Campaign& campaign) {
  const auto add = [&](std::size_t which, const std::string& name, double Bias::*quantity, const char* what) {
    list.push_back({"instrument-bias",
                    name + " " + what,
                    {amount(
                        "instrument-bias." + name + "." + what, "1", {.lower = -0.6, .upper = 1.5, .noticed = 0.15},
                        [=](const Model& m) { return which < m.bias.size() ? m.bias[which].*quantity : 0.0; },
                        [=](Model& m, double v) { m.bias[which].*quantity = v; })},
                    1,
                    [=](Model& m) { m.bias.resize(std::max(m.bias.size(), which + 1)); }});
  };
  for (std::size_t s = 0; s < campaign.screens.size(); ++s) {
    const auto crossed = std::count_if(campaign.blocks.begin(), campaign.blocks.end(),
                                       [s](const MeasuredBlock& b) { return !b.holdout && b.passages[s].has_value(); });
    if (crossed < 5) continue;
    add(instrument_of_screen(s), "screen " + campaign.screens[s].id, &Bias::speed, "speed");
    add(instrument_of_screen(s), "screen " + campaign.screens[s].id, &Bias::jump, "jump");
    add(instrument_of_screen(s), "screen " + campaign.screens[s].id, &Bias::spin, "spin");
  }
  const bool sampled = std::any_of(campaign.blocks.begin(), campaign.blocks.end(),
                                   [](const MeasuredBlock& b) { return !b.holdout && !b.samples.empty(); });
  if (!sampled) return;
  add(kSampler, "samples", &Bias::speed, "speed");
  add(kSampler, "samples", &Bias::spin, "spin");
}

}  // namespace talus
