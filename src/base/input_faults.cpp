#include "talus/base/input_faults.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <string_view>

namespace talus {
namespace {

std::string summary_of(const std::vector<std::string>& faults, std::size_t count) {
  const std::size_t more = count - 1;
  if (more == 0) return faults.front();
  return faults.front() + " (and " + std::to_string(more) + (more == 1 ? " more fault)" : " more faults)");
}

/// The number of the feature that a fault begins with, and the rest of its text.
struct OfFeature {
  std::int64_t number = 0;
  std::string_view rest;
};

std::optional<OfFeature> feature_of(std::string_view fault, std::string_view before) {
  if (!fault.starts_with(before)) return std::nullopt;
  fault.remove_prefix(before.size());
  OfFeature found;
  const auto read = std::from_chars(fault.data(), fault.data() + fault.size(), found.number);
  if (read.ec != std::errc{}) return std::nullopt;
  found.rest = fault.substr(static_cast<std::size_t>(read.ptr - fault.data()));
  return found;
}

/// The length of the number that a text begins with; 0 if it begins with none.
std::size_t length_of_number(std::string_view text) {
  const std::size_t sign = text.starts_with('-') ? 1 : 0;
  if (sign >= text.size() || std::isdigit(static_cast<unsigned char>(text[sign])) == 0) return 0;
  double number = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  return static_cast<std::size_t>(read.ptr - text.data());
}

/// A fault without its values. Before the first " = " stands the name of a field, which stays ("field Ø1"); after it,
/// or without it, numbers go (but for the digits of a name), and quoted text after " = ". Other quoted texts are names
/// ("zone '3' is not described") and stay.
std::string without_values(std::string_view fault) {
  const std::size_t equals = fault.find(" = ");
  std::string kept(fault.substr(0, equals == std::string_view::npos ? 0 : equals));
  fault.remove_prefix(kept.size());
  bool in_name = false;  // the character before is of a word or number
  while (!fault.empty()) {
    std::size_t length = 1;
    if (fault.front() == '\'') {
      length = std::min(fault.find('\'', 1), fault.size() - 1) + 1;
      if (!kept.ends_with(" = ")) kept += fault.substr(0, length);
      in_name = false;
    } else if (const std::size_t digits = in_name ? 0 : length_of_number(fault); digits > 0) {
      length = digits;
      kept += '#';
    } else {
      in_name = std::isalnum(static_cast<unsigned char>(fault.front())) != 0 || fault.front() == '_';
      kept += fault.front();
    }
    fault.remove_prefix(length);
  }
  return kept;
}

}  // namespace

InputFaults::InputFaults(std::vector<std::string> faults, std::size_t count)
    : InputError(summary_of(faults, count)), faults_(std::move(faults)), count_(count) {}

void FaultList::add(std::string fault) {
  const auto feature = feature_of(fault, before_);
  const std::string kind_text = feature ? without_values(feature->rest) : fault;
  const auto found = index_of_kind_.find(kind_text);
  if (found == index_of_kind_.end()) {
    ++count_;
    if (kinds_.size() == kMost) {
      ++not_listed_;
      return;
    }
    index_of_kind_.emplace(kind_text, kinds_.size());
    kinds_.push_back({{faults_.size()}});
    faults_.push_back(std::move(fault));
    return;
  }
  Kind& kind = kinds_[found->second];
  if (std::ranges::any_of(kind.first, [&](std::size_t i) { return faults_[i] == fault; })) {
    ++repeated_;
    return;
  }
  ++count_;
  if (kind.first.size() < kShown) {
    kind.first.push_back(faults_.size());
    faults_.push_back(std::move(fault));
    return;
  }
  kind.low = kind.more == 0 ? feature->number : std::min(kind.low, feature->number);
  kind.high = kind.more == 0 ? feature->number : std::max(kind.high, feature->number);
  ++kind.more;
}

std::string FaultList::rest_text(const Kind& kind) const {
  const std::string low = std::to_string(kind.low), high = std::to_string(kind.high);
  return path_ + ": and " + std::to_string(kind.more) + " more like this, in " +
         (kind.low == kind.high ? feature_ + " " + low : feature_ + "s " + low + " to " + high) + after_;
}

void FaultList::stop() const {
  if (count_ == 0) return;
  std::map<std::size_t, std::string> rests;  // by the index of the fault that they follow
  for (const Kind& kind : kinds_)
    if (kind.more > 0) rests[kind.first.back()] = rest_text(kind);
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    lines.push_back(faults_[i]);
    if (const auto rest = rests.find(i); rest != rests.end()) lines.push_back(rest->second);
  }
  if (not_listed_ > 0) lines.push_back("and " + std::to_string(not_listed_) + " more faults of this kind of input");
  throw InputFaults(std::move(lines), count_);
}

}  // namespace talus
