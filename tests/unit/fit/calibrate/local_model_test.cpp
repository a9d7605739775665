#include "fit/calibrate/local_model.hpp"

#include <gtest/gtest.h>
#include <omp.h>

namespace talus {
namespace {

Eigen::MatrixXd product_with(int threads, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(threads);
  Eigen::MatrixXd product = a * b;
  omp_set_num_threads(before);
  return product;
}

// The fit sums over evaluations by products of matrices. Their bits must not follow from the machine.
TEST(MatrixProducts, DoNotDependOnTheNumberOfProcessors) {
  std::srand(1);
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(300, 900), b = Eigen::MatrixXd::Random(900, 200);
  const Eigen::MatrixXd one = product_with(1, a, b);
  for (const int threads : {2, 7, 64}) EXPECT_TRUE(product_with(threads, a, b) == one) << threads;
}

TEST(MatrixProducts, DoNotDependOnTheCachesOfTheProcessor) {
  EXPECT_EQ(Eigen::l1CacheSize(), 32 << 10);
  EXPECT_EQ(Eigen::l2CacheSize(), 512 << 10);
  EXPECT_EQ(Eigen::l3CacheSize(), 4 << 20);
}

}  // namespace
}  // namespace talus
