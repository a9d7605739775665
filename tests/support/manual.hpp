#pragma once
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

namespace talus::test {

/// The numbers in a text like "above 0, at most 60".
inline std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end != word.c_str()) numbers.push_back(value);
  }
  return numbers;
}

}  // namespace talus::test
