#pragma once
#include <ctime>
#include <string>
#include <vector>

namespace talus {

/// Processor time of one phase of a diagnosis.
struct PhaseTime {
  std::string phase;   ///< "ground", "tests", "fits", "comparison", "cross-validation", "confirmation"
  std::string effect;  ///< of a fit; empty: of no effect in particular
  double cpu = 0.0;    ///< of all threads together [s]
};

/// Where the processor time of a diagnosis went: no result depends on it. docs/diagnosis-time.md.
class Timesheet {
 public:
  /// The time from its making to its end belongs to a phase, unless a phase around it has it already.
  class Phase {
   public:
    Phase(Timesheet& sheet, std::string phase, std::string effect = {});
    ~Phase();
    Phase(const Phase&) = delete;
    Phase& operator=(const Phase&) = delete;

   private:
    Timesheet& sheet_;
    PhaseTime time_;
    std::clock_t start_;
  };

  void add(const PhaseTime& time);
  void add(const Timesheet& other);
  /// The phases in the order in which they began.
  const std::vector<PhaseTime>& phases() const { return phases_; }

 private:
  std::vector<PhaseTime> phases_;
  int open_ = 0;  // phases that are under way, one in another
};

}  // namespace talus
