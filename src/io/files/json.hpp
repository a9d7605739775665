#pragma once
#include <exception>
#include <filesystem>
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

/// The JSON in a text. Throws InputError or Json::exception if it is none, or is nested deeper than any record of ours.
Json parsed_record(const std::string& text);

/// The JSON in a file that Talus wrote (run.json, part.json). Throws InputError or Json::exception if the file is no
/// regular file, larger than any record of ours, or no JSON; before more than that is read.
Json read_record(const std::filesystem::path& file);

/// Throws InputError "FILE: cannot be understood (CAUSE), WAY_OUT".
[[noreturn]] void throw_not_understood(const std::filesystem::path& file, const std::string& cause,
                                       const std::string& way_out);

/// Calls `read`, which takes values from the record in `file`, and returns its result. Any exception of `read` becomes
/// InputError "FILE: cannot be understood (CAUSE), WAY_OUT".
template <class Read>
auto understood(const std::filesystem::path& file, const std::string& way_out, Read read) {
  try {
    return read();
  } catch (const std::exception& error) {
    throw_not_understood(file, error.what(), way_out);
  }
}

/// A whole number of a record, within bounds. (A conversion would wrap a larger one.) Throws InputError or
/// Json::exception.
std::int64_t whole_number(const Json& number, std::int64_t lowest, std::int64_t highest);

/// The text of a JSON file, indented; bytes that are no UTF-8 are replaced.
std::string json_text(const Json& json);

}  // namespace talus::io
