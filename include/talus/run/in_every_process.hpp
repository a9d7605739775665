#pragma once
#include <functional>
#include <stdexcept>

#include "talus/simulate/plan/process_group.hpp"

namespace talus::run {

/// Wrong input of a process group: all processes know it, and the leader says it for all.
struct GroupInputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs `step` in every process of a group, and makes them agree on whether it failed: where it throws InputError in
/// one of them, throws `GroupInputError` in all; in a single process, the InputError itself.
void in_every_process(ProcessGroup& processes, const std::function<void()>& step);

}  // namespace talus::run
