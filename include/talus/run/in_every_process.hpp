#pragma once
#include <functional>
#include <stdexcept>

#include "talus/simulate/plan/process_group.hpp"

namespace talus::run {

/// Wrong input of a process group: every process throws it, and the leader alone reports it.
struct GroupInputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs `step` in every process of a group. If it throws InputError in one of them, all throw `GroupInputError` with
/// the first message. A single process throws the InputError itself.
void in_every_process(ProcessGroup& processes, const std::function<void()>& step);

}  // namespace talus::run
