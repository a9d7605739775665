#include "talus/physics/effects/registry.hpp"

#include <algorithm>

namespace talus {
namespace {

constexpr auto kAll = std::apply(
    [](const auto&... entry) { return std::array{static_cast<const EffectEntry&>(entry)...}; }, registry::kEntries);

constexpr bool names_differ() {
  for (std::size_t i = 0; i < kAll.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (kAll[i].name == kAll[j].name) return false;
  return true;
}
static_assert(names_differ(), "two effects have the same name");

}  // namespace

bool EffectEntry::acts(const Effects& effects) const {
  return std::ranges::any_of(fields(),
                             [&](const EffectField& f) { return f.is_strength() && f.get(effects) != f.off; });
}

bool Effects::any() const {
  return std::ranges::any_of(kAll, [this](const EffectEntry& entry) { return entry.acts(*this); });
}

std::span<const EffectEntry> effect_entries() {
  return kAll;
}

const EffectEntry* find_effect(std::string_view name) {
  const auto found = std::ranges::find(kAll, name, &EffectEntry::name);
  return found == kAll.end() ? nullptr : &*found;
}

}  // namespace talus
