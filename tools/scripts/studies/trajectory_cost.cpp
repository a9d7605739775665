/// Prints what the trajectories of a model cost: quantiles of impacts, vertices and milliseconds, and how they ended;
/// then the error of the model with the pieces of a run and with those of a search. docs/diagnosis-time.md.
///
///   trajectory_cost campaign.toml SURFACE MODEL.toml|- TRIALS DRAG_LOSS [MOST_VERTICES]      -: upper-talus-3d
///
/// Not part of the build. From the folder of a build, such as build/release:
///   g++ -std=c++20 -O2 -fopenmp -I../../include -I../../src -I/usr/include/eigen3 -I/usr/include/gdal
///     ../../tools/scripts/studies/trajectory_cost.cpp -o trajectory_cost libtalus_io.a libtalus_core.a -lnlopt
///     -ltomlplusplus -lcrypto -lgdal -lproj
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "talus/fit/score/score.hpp"
#include "talus/io/campaign/campaign_file.hpp"
#include "talus/io/campaign/model_file.hpp"
#include "talus/physics/trace.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace {

void print_quantiles(const char* name, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double sum = 0.0;
  for (const double v : values) sum += v;
  const auto at = [&](double share) {
    return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
  };
  std::printf("%-9s mean %.4g  P50 %.4g  P99 %.4g  P99.9 %.4g  maximum %.4g\n", name,
              sum / static_cast<double>(values.size()), at(0.5), at(0.99), at(0.999), values.back());
}

double seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void print_paths(const talus::Campaign& c, const talus::Model& m, std::uint32_t trials, const talus::Effort& effort) {
  const talus::Cover cover{m.grounds, c.zones};
  const talus::World world{c.surface, cover, m.impact, talus::EndRules{}, m.effects.any() ? &m.effects : nullptr,
                           nullptr,   effort};
  talus::Path path;
  std::vector<double> impacts, vertices;
  int ends[talus::kEnds] = {};
  for (std::uint32_t block = 0; block < c.blocks.size(); ++block)
    for (std::uint32_t trial = 0; trial < trials; ++trial) {
      talus::trace(world, talus::release_of(c, block, 1, trial), path);
      impacts.push_back(path.impacts);
      vertices.push_back(static_cast<double>(path.vertices.size()));
      ++ends[static_cast<int>(path.end)];
    }
  print_quantiles("impacts", impacts);
  print_quantiles("vertices", vertices);
  std::printf("stopped %d, trapped %d, left %d, caught %d, limit %d\n", ends[0], ends[1], ends[2], ends[3], ends[4]);
}

void print_error(const talus::Campaign& c, const talus::Model& m, std::uint32_t trials, const talus::Effort& effort) {
  const std::vector<bool> rows(c.blocks.size(), true);
  for (const std::uint32_t first : {0U, 100'000U}) {  // two sets of random numbers
    const double start = seconds();
    const talus::Score s = talus::score(c, talus::observe(c, m, {trials, 1, first, 0, rows, {}, effort}), rows);
    std::printf("drag loss %g: error %.4f, cut short %.4f, %.1f s:", effort.drag_loss, s.total, s.cut_short,
                seconds() - start);
    for (const talus::GroupScore& group : s.groups) std::printf(" %s %.4f", group.name.c_str(), group.score);
    std::printf("\n");
  }
}

}  // namespace

int main(int count, char** words) {
  if (count < 6) return 2;
  const talus::io::LoadedCampaign loaded = talus::io::read_campaign(words[1], words[2]);
  const talus::Campaign& c = loaded.campaign;
  const talus::Model model =
      *words[3] == '-' ? talus::model_of_preset(c, talus::kDefaultPreset) : talus::io::read_model(words[3], c, nullptr);
  const auto trials = static_cast<std::uint32_t>(std::atoi(words[4]));
  talus::Effort effort;
  effort.drag_loss = std::atof(words[5]);
  if (count > 6) effort.most_vertices = static_cast<std::uint32_t>(std::atoi(words[6]));
  print_paths(c, model, trials, effort);
  print_error(c, model, trials, effort);
  return 0;
}
