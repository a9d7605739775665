#include <iostream>

#include "mpi_process_group.hpp"
#include "program.hpp"
#include "talus/base/error.hpp"
#include "talus/run/in_every_process.hpp"

namespace {

/// Parses the command line, the same in every process. Nothing if it is wrong: the leader has reported that.
Action action_of(int argc, char** argv, MpiProcessGroup& processes, int& code) {
  const auto run = [&processes](CLI::App& app, Action& action) { add_run(app, action, processes); };
  Action action;
  const auto understand = [&] {
    action = understood(argc, argv, {run});
    return 0;
  };
  if (processes.leads()) {
    code = exit_code_of(understand);
  } else {
    std::cout.setstate(std::ios::failbit);  // only the leader prints the help
    try {
      understand();
    } catch (const talus::InputError&) {
      code = kWrongInput;
    }
  }
  return action;
}

}  // namespace

int main(int argc, char** argv) {
  begin_program(argc, argv);
  int threads = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &threads);
  int code = kDone;
  {
    MpiProcessGroup processes;
    const Action action = action_of(argc, argv, processes, code);
    bool alike = true;  // all processes end in the same way
    if (action && threads < MPI_THREAD_SERIALIZED) {
      if (processes.leads()) say("error", "this MPI lets no threads call it (MPI_THREAD_SERIALIZED)");
      code = kFailed;
    } else if (action) {
      code = exit_code_of([&] {
        alike = false;
        int ended = kDone;
        try {
          ended = action();
        } catch (const talus::InputError& error) {
          if (processes.size() > 1) throw;  // thrown in one process: the others do not know
          say("error", error.what());
          ended = kWrongInput;
        } catch (const talus::run::GroupInputError& error) {
          if (processes.leads()) say("error", error.what());
          ended = kWrongInput;
        } catch (const Interrupted& error) {
          if (processes.leads()) say("", error.what());
          ended = kInterrupted;
        }
        alike = true;
        return ended;
      });
    }
    if (!alike) MPI_Abort(MPI_COMM_WORLD, code);
  }
  MPI_Finalize();
  return code;
}
