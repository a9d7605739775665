#include "talus/io/results/write_lines.hpp"

#include <algorithm>

#include "talus/base/text.hpp"

namespace talus::io {
std::string screens_summary_csv(const Scenario& scenario, const ScreenSummary& summary) {
  std::string text = "screen,quantity,unit,crossings,blocks,share_of_released,mean,p50,p95,p99,maximum\n";
  const auto released = static_cast<double>(scenario.released());
  for (std::size_t s = 0; s < scenario.screens.size(); ++s)
    for (std::size_t q = 0; q < screen_quantities().size(); ++q) {
      const ScreenQuantity& quantity = screen_quantities()[q];
      const ScreenSummary::Row row = summary.row(s, q);
      text += csv_field(scenario.screens[s].id) + ',' + std::string(quantity.name) + ',' + std::string(quantity.unit) +
              ',' + std::to_string(row.crossings) + ',' + std::to_string(row.blocks);
      for (const double value :
           {static_cast<double>(row.blocks) / released, row.mean, row.p50, row.p95, row.p99, row.maximum})
        text += ',' + csv_field(value);
      text += '\n';
    }
  return text;
}

std::string barriers_csv(const Scenario& scenario, const Totals& totals) {
  std::string text = "barrier,from_m,to_m,hits,caught,over,broken\n";
  for (std::size_t b = 0; b < totals.barriers.size(); ++b)
    for (std::size_t k = 0; k < totals.barriers.parts(b).size(); ++k) {
      const BarrierCounts& part = totals.barriers.parts(b)[k];
      const double from = kBarrierPart * static_cast<double>(k);
      text += csv_field(scenario.barriers.list()[b].id) + ',' + csv_field(from) + ',' +
              csv_field(std::min(from + kBarrierPart, scenario.barriers.length(b)));
      for (const std::uint64_t count : {part.hits(), part.caught, part.over, part.broken})
        text += ',' + std::to_string(count);
      text += '\n';
    }
  return text;
}

}  // namespace talus::io
