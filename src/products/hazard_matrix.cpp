#include "talus/products/hazard_matrix.hpp"

#include <algorithm>

#include "talus/base/text.hpp"

namespace talus {
namespace {

bool ascend(const std::vector<double>& values) {
  return !values.empty() && values.front() > 0.0 &&
         std::ranges::adjacent_find(values, std::ranges::greater_equal{}) == values.end();
}

std::string fault_of_names(const std::vector<std::string>& names) {
  if (names.empty() || names.size() > 16) return "names: must be 1 to 16 words, of class 0 first";
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].find_first_not_of(" \t") == std::string::npos)
      return "names: class " + std::to_string(i) + " has an empty name, must have one that maps and reports can show";
    for (std::size_t j = 0; j < i; ++j)
      if (names[i] == names[j])
        return "names: classes " + std::to_string(j) + " and " + std::to_string(i) + " are both called '" + names[i] +
               "', must have names that maps and reports can tell apart";
  }
  return {};
}

}  // namespace

std::string fault_of(const HazardMatrix& m) {
  if (!ascend(m.energies) || m.energies.size() > 8)
    return "energies = " + list_text(m.energies) + ": must be 1 to 8 numbers above 0 kJ that ascend";
  if (!ascend(m.years) || m.years.size() > 8)
    return "years = " + list_text(m.years) + ": must be 1 to 8 numbers above 0 that ascend";
  if (std::string fault = fault_of_names(m.names); !fault.empty()) return fault;
  const std::string shape = "classes: must be " + std::to_string(m.energies.size() + 1) + " rows (weak first) of " +
                            std::to_string(m.years.size() + 1) + " whole numbers (often first; last what is rarer)";
  if (m.classes.size() != m.energies.size() + 1) return shape;
  for (std::size_t i = 0; i < m.classes.size(); ++i) {
    if (m.classes[i].size() != m.years.size() + 1) return shape;
    for (std::size_t j = 0; j < m.classes[i].size(); ++j) {
      const int value = m.classes[i][j];
      if (value < 0 || value >= static_cast<int>(m.names.size()))
        return "classes: " + std::to_string(value) + " has no name, must be 0 to " + std::to_string(m.names.size() - 1);
      if ((j > 0 && value > m.classes[i][j - 1]) || (i > 0 && value < m.classes[i - 1][j]))
        return "classes: " + std::to_string(value) +
               ": a class must not fall with the intensity, nor rise with the return period";
    }
  }
  return {};
}

int class_of(const HazardMatrix& matrix, std::span<const double> frequencies, bool rare) {
  int highest = 0;
  for (std::size_t i = 0; i < matrix.classes.size() && i < frequencies.size(); ++i) {
    if (!(frequencies[i] > 0.0)) continue;
    std::size_t column = 0;
    while (column < matrix.years.size() && !(frequencies[i] * matrix.years[column] >= kOnce)) ++column;
    if (column < matrix.years.size() || rare) highest = std::max(highest, matrix.classes[i][column]);
  }
  return highest;
}

BoundedClass class_of(const HazardMatrix& matrix, std::span<const Bounded> frequencies) {
  const auto side = [&](double Bounded::*member) {
    std::vector<double> values;
    for (const Bounded& f : frequencies) values.push_back(f.*member);
    return values;
  };
  const std::vector<double> low = side(&Bounded::low), high = side(&Bounded::high);
  const int here = class_of(matrix, side(&Bounded::value)), highest = class_of(matrix, high, false);
  return {here, class_of(matrix, low), std::max(here, highest), class_of(matrix, low, false) != highest};
}

}  // namespace talus
