#pragma once
#include <stdexcept>
#include <string>

namespace talus {

/// An error in the input that the user can correct: the program ends with exit code 2.
///
/// The message is one line: where (file, layer, key), what is wrong, the value found, what is allowed, the remedy.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace talus
