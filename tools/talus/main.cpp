#include "program.hpp"

int main(int argc, char** argv) {
  begin_program(argc, argv);
  const auto run = [](CLI::App& app, Action& action) { add_run(app, action, talus::alone()); };
  return exit_code_of([&] {
    return understood(argc, argv,
                      {run, add_check, add_presets, add_profile, add_trace, add_barrier, add_calibrate, add_diagnose,
                       add_score, add_sources, add_hazard, add_compare, add_merge, add_report})();
  });
}
