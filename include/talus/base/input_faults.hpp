#pragma once
#include <string>
#include <utility>
#include <vector>

#include "talus/base/error.hpp"

namespace talus {

/// Several faults of one input. As one line it says the first and how many more there are.
class InputFaults : public InputError {
 public:
  explicit InputFaults(std::vector<std::string> faults);
  const std::vector<std::string>& faults() const { return faults_; }

 private:
  std::vector<std::string> faults_;
};

/// Collects the faults of an input, so that all are reported together.
class FaultList {
 public:
  /// Does some work; if it throws InputError, keeps the fault. @return whether there was none
  template <class Work>
  bool attempt(Work&& work) {
    try {
      std::forward<Work>(work)();
      return true;
    } catch (const InputError& error) {
      add(error.what());
      return false;
    }
  }
  /// Throws InputFaults if there is any.
  void stop() const;
  /// How often work failed.
  std::size_t count() const { return count_ + repeated_; }

 private:
  void add(std::string fault);

  static constexpr std::size_t kMost = 1000;  // of a layer of millions of bad features the rest are only counted
  std::vector<std::string> faults_;
  std::size_t count_ = 0;     // different faults
  std::size_t repeated_ = 0;  // of a column, met at each feature again
};

}  // namespace talus
