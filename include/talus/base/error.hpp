#pragma once
#include <stdexcept>
#include <string>

namespace talus {

/// The input is wrong and the user can mend it: the program ends with exit code 2.
///
/// The message is one line: where (file, layer, key), what, the value found, what is allowed, the way out.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace talus
