// A block thrown off a ledge 20 m above a plain, at 10 m/s: where does it land, and how does it rebound?
#include <cmath>
#include <cstdio>
#include <talus/talus.hpp>

int main() {
  const talus::Grid grid{.columns = 100, .rows = 20, .cell_x = 2.0, .cell_y = 2.0};
  const talus::Surface plain(talus::Raster<float>(grid, 0.0F));
  const talus::Cover cover{{talus::Ground{.En50 = 15.0}}, {}};  // smooth ground everywhere

  talus::Release release;
  release.body = talus::block_of(1.0, 2700.0);  // diameter [m], density [kg/m3]
  release.motion.position = {10.0, 20.0, 20.0};
  release.motion.velocity = {10.0, 0.0, 0.0};
  talus::Path path;
  talus::trace({plain, cover, {}, {}}, release, path);

  const talus::Motion& impact = path.vertices.at(1).motion;  // just after it
  std::printf("Talus %s: lands after %.6f s at x = %.6f m, rebounds at %.6f m/s\n", talus::version().data(),
              impact.time, impact.position.x(), impact.velocity.z());

  // From outside: free fall, and Eq. 3 of Mitchell & Hungr, k_n = E_50 / (c D v^2 + E_50) with c = 0.25.
  const double fall = std::sqrt(2.0 * 20.0 / 9.81), v = 9.81 * fall;
  const double rebound = v * 15.0 / (0.25 * 1.0 * v * v + 15.0);
  const bool right = std::abs(impact.time - fall) < 1e-12 &&
                     std::abs(impact.position.x() - 10.0 - 10.0 * fall) < 1e-11 &&
                     std::abs(impact.velocity.z() - rebound) < 1e-12 && path.end == talus::End::Stopped;
  std::puts(right ? "as free fall and the restitution law say" : "WRONG");
  return right ? 0 : 1;
}
