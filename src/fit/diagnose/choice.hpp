#pragma once
#include <algorithm>

#include "chosen_shares.hpp"
#include "talus/fit/diagnose/diagnosis.hpp"

namespace talus {

/// Least gains with which an effect is named [objective].
struct LeastGain {
  double fitted;  ///< on the fitting rows
  double unseen;  ///< in cross-validation

  bool are_in(const Confirmation& gains) const { return gains.fitted >= fitted && gains.unseen >= unseen; }
};

/// The choice among the effects that were fitted in a round: enough gain, also on blocks that a fit has not seen, and
/// again with new random numbers. docs/diagnosis-method.md.
class Choice {
 public:
  /// @param base     objective of the model without any of the effects
  /// @param streams  of all blocks
  Choice(const Score& base, const DiagnosisRules& rules, std::span<const std::uint32_t> streams)
      : base_(base),
        least_{rules.worth_naming * base.total, rules.worth_unseen * base.total},
        least_amount_(rules.least_amount),
        streams_(streams) {}

  /// Counts how often each would be chosen, then puts the best first: those that may be named by their gains on unseen
  /// blocks, the others by their net gains.
  template <class Candidate>
  void rank(std::vector<Candidate>& candidates) const {
    std::vector<PricedObjective> priced;
    for (const Candidate& c : candidates) priced.push_back({c.fitted.objective, c.price});
    const std::vector<double> shares = chosen_shares(base_, priced, streams_);
    for (std::size_t i = 0; i < candidates.size(); ++i) candidates[i].chosen_share = shares[i];
    std::ranges::stable_sort(candidates, [this](const Candidate& a, const Candidate& b) {
      if (may_be_named(a) != may_be_named(b)) return may_be_named(a);
      return may_be_named(a) ? a.unseen_gain() > b.unseen_gain() : a.net_gain() > b.net_gain();
    });
  }

  /// Names the first of the ranked effects that is confirmed, moves it to the front and lists those that the data
  /// cannot tell from it. Names none where none is confirmed.
  ///
  /// @param round    its candidates ranked
  /// @param confirm  gives a candidate's Confirmation
  template <class Round, class Confirm>
  void name_in(Round& round, const Confirm& confirm) const {
    auto& all = round.candidates;
    const auto chosen = std::ranges::find_if(all, [&](auto& c) {
      if (!may_be_named(c)) return false;
      c.confirmation = confirm(c);
      return least_.are_in(c.confirmation);
    });
    if (chosen == all.end()) return;
    std::rotate(all.begin(), chosen, chosen + 1);
    round.effect = all.front().effect;
    round.where = all.front().where;
    for (const auto& other : std::span(all).subspan(1))
      if (may_be_named(other) && is_alike(other.fitted.objective, all.front().fitted.objective))
        round.alike.push_back(other.effect);
  }

 private:
  bool may_be_named(const FittedEffect& c) const {
    return c.amount > least_amount_ && c.gain > least_.fitted && c.unseen_gain() > least_.unseen;
  }
  bool is_alike(const Score& other, const Score& best) const {
    return difference(other, best, streams_).interval.high > 0.0;
  }

  const Score& base_;
  LeastGain least_;
  double least_amount_;
  std::span<const std::uint32_t> streams_;
};

}  // namespace talus
