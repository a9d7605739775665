#include "json.hpp"

#include <cmath>

#include "io/gdal/regular_file.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"

namespace talus::io {

double six_digits(double value) {
  return number_in(significant(value, 6));
}

double six_decimals(double value) {
  return std::round(value * 1e6) / 1e6;
}

Json json_of(double value, double (*rounded)(double)) {
  return std::isnan(value) ? Json() : Json(rounded(value));
}

Json json_of(const Interval& interval, double (*rounded)(double)) {
  return Json::array({json_of(interval.low, rounded), json_of(interval.high, rounded)});
}

Json json_of(std::span<const InputFile> files) {
  Json list = Json::array();
  for (const InputFile& file : files)
    list.push_back({{"role", file.role}, {"path", file.path}, {"sha256", file.sha256}});
  return list;
}

Json parsed_record(const std::string& text) {
  constexpr int kDeepest = 32;
  return Json::parse(text, [](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepest) throw InputError("it is nested more than " + std::to_string(kDeepest) + " deep");
    return true;
  });
}

Json read_record(const std::filesystem::path& file) {
  return parsed_record(read_file(file.string(), file.string(), "a record of talus", kMostRecord));
}

void throw_not_understood(const std::filesystem::path& file, const std::string& cause, const std::string& way_out) {
  throw InputError(file.string() + ": cannot be understood (" + cause + "), " + way_out);
}

std::int64_t whole_number(const Json& number, std::int64_t lowest, std::int64_t highest) {
  const bool whole = number.is_number_integer() && !(number.is_number_unsigned() && number.get<std::uint64_t>() >> 63U);
  if (!whole || number.get<std::int64_t>() < lowest || number.get<std::int64_t>() > highest)
    throw InputError("it has the number " + number.dump().substr(0, 40) + ", must be " + std::to_string(lowest) +
                     " to " + std::to_string(highest));
  return number.get<std::int64_t>();
}

std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace talus::io
