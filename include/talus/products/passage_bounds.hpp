#pragma once
#include "talus/products/hazard.hpp"

namespace talus {

/// The 97.5 % quantile of the gamma distribution of a shape k >= 1 and scale 1, divided by k; 3.69 at 1. From a table
/// in the logarithm of k: relative error below 1e-4.
double gamma_high(double shape);
/// The 2.5 % quantile likewise; 0.0253 at 1. 0 for a shape below 1.
double gamma_low(double shape);

/// The 95 % gamma interval of Fay & Feuer, as `gamma_interval`, from the table: for every cell of a map. If all counts
/// together weigh less than one of the mean weight (a path that only grazes a place), the lower bound is 0.
Bounded table_interval(double sum, double squares, double largest);

/// The mean length of a released block in a cell [m], with bounds.
///
/// @param length   sum over the blocks [m]
/// @param squares  sum of the squares of the length of each block [m^2]
/// @param straight  way through the cell [m], the longest of a straight path: the unit where nothing was counted
///
///   longest = max(straight, squares / length)             blocks that wander stay longer: the mean over their length
///   v = squares - length^2 / released                     the sum of the squares of the differences to the mean
///   low  = max(gamma interval, length - longest d(v / longest^2)) / released
///   high = min(gamma interval, length + longest d(v / longest^2)) / released
///
/// with d(k) the upper Poisson bound of k, less k. Blocks are taken as one sample; strata can only narrow it. Two 95 %
/// intervals are cut with each other, and still cover 95 %: shown by simulation in the tests, not proven. Lengths far
/// above `straight` with a heavy tail are not covered, nor are they seen by fewer than about ten blocks.
Bounded mean_length(double length, double squares, double straight, double released);

}  // namespace talus
