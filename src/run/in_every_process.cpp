#include "talus/run/in_every_process.hpp"

#include <string>

#include "talus/base/error.hpp"

namespace talus::run {

void in_every_process(ProcessGroup& processes, const std::function<void()>& step) {
  if (processes.size() == 1) return step();
  std::string fault;
  try {
    step();
  } catch (const InputError& error) {
    fault = error.what();
  }
  std::string first;
  for (const std::string& given : processes.gather(fault))
    if (first.empty()) first = given;
  first = processes.tell(first);
  if (!first.empty()) throw GroupInputError(first);
}

}  // namespace talus::run
