#include "talus/base/input_faults.hpp"

#include <algorithm>
#include <iterator>

namespace talus {
namespace {

std::string summary_of(const std::vector<std::string>& faults) {
  const std::size_t more = faults.size() - 1;
  if (more == 0) return faults.front();
  return faults.front() + " (and " + std::to_string(more) + (more == 1 ? " more fault)" : " more faults)");
}

}  // namespace

InputFaults::InputFaults(std::vector<std::string> faults)
    : InputError(summary_of(faults)), faults_(std::move(faults)) {}

void FaultList::add(std::string fault) {
  constexpr std::ptrdiff_t kLatest = 16;  // more than the columns that a feature is read from
  if (std::find(faults_.end() - std::min(kLatest, std::ssize(faults_)), faults_.end(), fault) != faults_.end()) {
    ++repeated_;
    return;
  }
  if (++count_ <= kMost) faults_.push_back(std::move(fault));
}

void FaultList::stop() const {
  if (faults_.empty()) return;
  std::vector<std::string> all = faults_;
  if (count_ > kMost) all.push_back("and " + std::to_string(count_ - kMost) + " more faults of this kind of input");
  throw InputFaults(std::move(all));
}

}  // namespace talus
