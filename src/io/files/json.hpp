#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "talus/base/sample.hpp"
#include "talus/io/origin/origin.hpp"

namespace talus::io {

using Json = nlohmann::ordered_json;

/// Roundings of the numbers in a report: further digits would be noise.
double six_digits(double value);    ///< significant digits
double six_decimals(double value);  ///< decimals
inline double unrounded(double value) {
  return value;
}

/// A number in a report; null for NaN.
Json json_of(double value, double (*rounded)(double) = six_digits);

/// [low, high].
Json json_of(const Interval& interval, double (*rounded)(double) = six_digits);

/// Input files with their checksums.
Json json_of(std::span<const InputFile> files);

/// The text of a JSON file, indented; bytes that are no UTF-8 are replaced.
std::string json_text(const Json& json);

}  // namespace talus::io
