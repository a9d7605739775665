#include "talus/simulate/plan/process_group.hpp"

namespace talus {

ProcessGroup& alone() {
  thread_local ProcessGroup one;  // simulations of several threads must not share its counter
  return one;
}

}  // namespace talus
