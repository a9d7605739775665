#pragma once
#include <limits>
#include <string_view>

namespace talus {

/// In place of a number that the input does not give.
inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// A number of the input: what it is called, what it means and which values are allowed. In the units of the files.
struct Bounds {
  std::string_view key;      ///< "blocks.density"; of a ground "En50"
  std::string_view unit;     ///< "kg/m3"; "1" where there is none
  std::string_view meaning;  ///< a few words, without a full stop
  double min, max;
  enum Ends { Closed, AboveMin, Between } ends = Closed;  ///< AboveMin: not min itself; Between: neither end
  bool whole = false;                                     ///< a whole number
};

/// A number of the input that is one number of `Owner`, in the units of the files: degrees, not radians.
/// Its default is what a fresh `Owner` holds (of a ground: what the preset says).
template <class Owner>
struct Field : Bounds {
  double (*get)(const Owner&);
  void (*set)(Owner&, double);
  double off = kNotGiven;  ///< the value at which it does nothing; NaN: it is no strength
};

}  // namespace talus
