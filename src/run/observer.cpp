#include "talus/run/observer.hpp"

namespace talus::run {

void stop_interrupted() {
  throw Interrupted("interrupted; nothing was written");
}

}  // namespace talus::run
