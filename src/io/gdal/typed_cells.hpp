#pragma once
#include <vector>

#include "dataset.hpp"

namespace talus::io {

/// Copies of the features of a text table (one at least), with its columns of numbers as numbers; empty cells are NULL
/// there. A column in which any cell would not read back as it stands ("0123", "2020-01-01") stays text.
std::vector<Feature> with_numbers(const std::vector<Feature>& features);

}  // namespace talus::io
