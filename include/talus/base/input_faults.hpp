#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "talus/base/error.hpp"

namespace talus {

/// Several faults of one input. As one line it says the first and how many more there are.
class InputFaults : public InputError {
 public:
  /// @param faults  one at least; a line for each, or for several
  /// @param count   of the faults that the lines stand for
  InputFaults(std::vector<std::string> faults, std::size_t count);
  const std::vector<std::string>& faults() const { return faults_; }
  std::size_t count() const { return count_; }

 private:
  std::vector<std::string> faults_;
  std::size_t count_;
};

/// Collects the faults of an input, so that all are reported together. Of faults that differ only in the feature and
/// in numbers it keeps the first three, and says how many more there are.
class FaultList {
 public:
  FaultList() = default;
  /// @param path            of the layer
  /// @param feature, after  words around the number of a feature: "row", " below the header"
  FaultList(std::string path, std::string feature, std::string after)
      : path_(std::move(path)),
        feature_(std::move(feature)),
        before_(path_ + ": " + feature_ + " "),
        after_(std::move(after)) {}
  /// Faults of the lines of a text file.
  explicit FaultList(std::string path) : path_(std::move(path)), feature_("line"), before_(path_ + ":") {}

  /// How the faults of a feature begin: "cliffs.gpkg: feature 12", "trees.csv: row 12 below the header"; of a line:
  /// "blocks.csv:12".
  std::string label(std::int64_t number) const { return before_ + std::to_string(number) + after_; }

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
  /// Faults that differ only in the feature and in numbers.
  struct Kind {
    std::vector<std::size_t> first;  // indices in faults_
    std::size_t more = 0;
    std::int64_t low = 0, high = 0;  // of the features of these
  };

  void add(std::string fault);
  /// "cliffs.gpkg: and 97 more like this, in features 4 to 100".
  std::string rest_text(const Kind& kind) const;

  static constexpr std::size_t kShown = 3;
  static constexpr std::size_t kMost = 1000;  // kinds; of a layer of millions of bad features the rest are only counted
  std::string path_, feature_;
  std::string before_, after_;       // what stands around the number of a feature
  std::vector<std::string> faults_;  // the first of every kind, as they were met
  std::vector<Kind> kinds_;
  std::map<std::string, std::size_t> index_of_kind_;
  std::size_t count_ = 0;       // different faults
  std::size_t not_listed_ = 0;  // of these, those of further kinds
  std::size_t repeated_ = 0;    // of a column, met at each feature again
};

}  // namespace talus
