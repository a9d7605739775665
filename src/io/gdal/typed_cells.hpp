#pragma once
#include <vector>

#include "dataset.hpp"

namespace talus::io {

/// Copies of the features of a text table (one at least), with its columns of numbers as numbers; empty cells are NULL
/// there. A column in which any cell would not read back as it stands ("0123", "+43", "1e3", "2020-01-01") stays text.
/// Zeros after a decimal point do not matter ("0.50"), except in the columns `name` and `id`: these are numbers only if
/// all their cells are whole ones.
std::vector<Feature> with_numbers(const std::vector<Feature>& features);

}  // namespace talus::io
