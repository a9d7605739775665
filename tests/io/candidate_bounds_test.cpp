#include "files.hpp"
#include "support/campaigns.hpp"
#include "talus/fit/diagnose/candidates.hpp"
#include "talus/io/campaign/campaign_file.hpp"
#include "talus/io/campaign/model_file.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::io::test {
namespace {

using talus::test::campaign_on_slope;
using talus::test::model_of_slope;

class CandidateBounds : public Files {};

/// Whatever a diagnosis finds, `score` can read: each candidate at both ends of its search is a model within the bounds
/// of the files, and reads back with the value that was searched.
TEST_F(CandidateBounds, AreThoseOfTheModelFile) {
  LoadedCampaign loaded;
  Campaign& c = loaded.campaign;
  c = campaign_on_slope(30);
  talus::test::measure(c, model_of_slope(), 5);
  for (std::size_t b = 0; b < c.blocks.size(); ++b) {
    c.blocks[b].day = 1 + static_cast<int>(b % 2);
    c.blocks[b].axes = c.blocks[b].axes.cwiseProduct(Vec3(1.3, 1.0, 0.8));
    c.blocks[b].samples.push_back({60.0, c.blocks[b].y, 0.0, 52.0, 8.0, 9.0});
  }
  loaded.zone_codes = {""};
  const Model base = model_of_slope();
  const auto runs = observe(c, base, {20, 1, 0, 0, fitting_rows(c), {}});
  std::size_t tried = 0;
  for (const Candidate& candidate : candidates_of(c, base, runs, {}, {})) {
    for (const bool upper : {false, true}) {
      Eigen::VectorXd z(std::ssize(candidate.parameters));
      for (std::size_t i = 0; i < candidate.parameters.size(); ++i) {
        const Parameter& p = candidate.parameters[i];
        z[static_cast<Eigen::Index>(i)] = p.z(upper ? p.upper : p.lower);
      }
      const Model model = with(base, candidate, z);
      SCOPED_TRACE(candidate.effect + ' ' + candidate.where + (upper ? " upper" : " lower"));
      ++tried;
      for (const Ground& ground : model.grounds)  // of a band, which no file holds, too
        for (const auto& field : ground_fields()) {
          EXPECT_GE(field.get(ground), field.min) << field.key;
          EXPECT_LE(field.get(ground), field.max) << field.key;
        }
      if (candidate.effect == "undeclared-zone") continue;
      Model read;
      ASSERT_NO_THROW(read = read_model(write_text("m.toml", model_text(model, loaded, "test")), c));
      for (const Parameter& p : candidate.parameters)
        if (candidate.effect != "undeclared-barrier" || !read.barriers.empty()) {
          EXPECT_NEAR(p.get(read), p.get(model), 1e-9 * std::abs(p.get(model))) << p.key;
        }
    }
  }
  EXPECT_GT(tried, 60U);
}

}  // namespace
}  // namespace talus::io::test
