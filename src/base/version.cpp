#include "talus/base/version.hpp"

namespace talus {

std::string_view version() {
  return TALUS_VERSION;
}  // defined by CMakeLists.txt

}  // namespace talus
