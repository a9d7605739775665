#pragma once
#include <boost/math/policies/policy.hpp>

namespace talus {

/// Boost computes a function of a double in long double by default, which takes several times as long. Bounds are
/// written as float, of 24 bits: a double has enough for them.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

}  // namespace talus
