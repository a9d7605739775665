#pragma once
#include <limits>
#include <string_view>

namespace talus {

/// NaN: a number that is not given, not known or not defined.
inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// Name, meaning and allowed values of a number of the input, in the units of the files.
struct Bounds {
  std::string_view key;      ///< for instance "blocks.density"; for a number of a ground "En50"
  std::string_view unit;     ///< for instance "kg/m3"; "1" if it has none
  std::string_view meaning;  ///< a few words, without a full stop
  double min, max;
  enum Ends { Closed, AboveMin, Between } ends = Closed;  ///< AboveMin: min excluded; Between: both ends excluded
  bool whole = false;                                     ///< a whole number
};

/// A number of the input that is stored in an `Owner`. `get` and `set` use the units of the files: degrees, not
/// radians. Its default is the value in a new `Owner` (for a ground: the value of the preset).
template <class Owner>
struct Field : Bounds {
  double (*get)(const Owner&);
  void (*set)(Owner&, double);
  double off = kNotGiven;  ///< the value at which an effect does nothing; NaN: the number has no such value
};

}  // namespace talus
