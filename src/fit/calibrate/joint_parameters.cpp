#include "talus/fit/calibrate/joint_parameters.hpp"

#include <algorithm>
#include <map>

#include "talus/base/error.hpp"
#include "talus/base/text.hpp"

namespace talus {
namespace {

/// Whether `name`, as the user gives it ("phi", "effects.block-shape.loss"), means the parameter `key`.
bool means(const std::string& name, const std::string& key) {
  if (key.starts_with("ground.zones.")) return key.ends_with("." + name);
  const std::size_t inverse = key.find(".1/");  // searched as its inverse
  return name == key || (inverse != std::string::npos && name == key.substr(0, inverse + 1) + key.substr(inverse + 3));
}

/// The parameters of one key at all sites as one.
Parameter pooled(const std::vector<const Parameter*>& same) {
  Parameter all = *same.front();
  const auto count = static_cast<double>(same.size());
  all.centre = all.sd = 0.0;
  for (const Parameter* p : same) {
    all.centre += p->centre / count;
    all.sd += p->sd / count;
    all.lower = std::min(all.lower, p->lower);
    all.upper = std::max(all.upper, p->upper);
  }
  return all;
}

}  // namespace

JointParameters joint_parameters(std::span<const std::string> names, std::span<const std::vector<Parameter>> own,
                                 std::span<const std::string> share) {
  std::map<std::string, std::vector<const Parameter*>> shared;  // by key
  for (const std::string& name : share) {
    std::size_t most = 0;
    for (const std::vector<Parameter>& list : own)
      for (const Parameter& p : list)
        if (means(name, p.key)) {
          shared[p.key].push_back(&p);
          most = std::max(most, shared[p.key].size());
        }
    if (most < 2)
      throw InputError("--share " + name + ": no two campaigns have a fitted zone of the same name: " +
                       "give the zones that are to share it one name in [zone_names]");
  }
  JointParameters joint;
  std::map<std::string, std::size_t> number;
  for (std::size_t site = 0; site < own.size(); ++site) {
    joint.sites.emplace_back();
    for (const Parameter& p : own[site]) {
      const auto same = shared.find(p.key);
      const bool alone = same == shared.end() || same->second.size() < 2;
      const auto known = number.find(p.key);
      std::size_t place = joint.free.size();
      if (!alone && known != number.end()) {
        place = known->second;
      } else {
        joint.free.push_back(alone ? p : pooled(same->second));
        if (alone) joint.free.back().key = names[site] + ": " + p.key;
        if (!alone) number[p.key] = place;
      }
      joint.sites.back().push_back({place, p.get, p.set});
    }
  }
  return joint;
}

JointParameters with_shared(JointParameters joint, std::span<const std::vector<Parameter>> effect) {
  std::map<std::string, std::vector<const Parameter*>> same;
  for (const std::vector<Parameter>& list : effect)
    for (const Parameter& p : list) same[p.key].push_back(&p);
  std::map<std::string, std::size_t> number;
  for (std::size_t site = 0; site < effect.size(); ++site)
    for (const Parameter& p : effect[site]) {
      const auto [known, first] = number.emplace(p.key, joint.free.size());
      if (first) joint.free.push_back(pooled(same[p.key]));
      joint.sites[site].push_back({known->second, p.get, p.set});
    }
  return joint;
}

void check_shared(std::span<const std::string> share, std::span<const std::string> keys) {
  for (const std::string& name : share) {
    if (std::ranges::find(keys, name) == keys.end())
      throw InputError("--share " + name + ": it is not fitted" +
                       known_names(name, std::vector<std::string>(keys.begin(), keys.end())) +
                       ", or must be named by --fit, too");
    if (std::ranges::count(share, name) > 1) throw InputError("--share " + name + ": is named twice: name it once");
  }
}

}  // namespace talus
