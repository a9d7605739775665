#pragma once
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "talus/base/bounds.hpp"
#include "talus/physics/effects/effect_area.hpp"

/// Structure of an entry in the registry of effects (registry.hpp). docs/adding-an-effect.md.
namespace talus {

struct Effects;

/// Part of the data in which `talus diagnose` looks for an effect.
enum class Sought {
  Nowhere,
  Everywhere,
  InZones,   ///< everywhere, and in each zone of the ground that the paths meet
  OfShapes,  ///< in each of its variants, if some blocks are not spheres
  OnDays     ///< on each day of releases, if there are several
};

/// Unit of the numbers of a search: 1, or the median of the blocks of the campaign.
enum class Typical { One, BlockMass /* [kg] */, BlockDiameter /* [m] */ };

/// Search of `talus diagnose` over a number of an effect.
struct SearchRange {
  double lower, upper;  ///< limits of the search, cut at the bounds of the number
  double noticed;       ///< smallest change that matters in practice
  Typical times = Typical::One;
  double off = 0.0;                    ///< value at which the search starts
  std::string_view inverse_unit = {};  ///< if given, 1/number is searched; 0 stands for the number 0
};

/// A fixed value of a number that is not searched. Each variant is tried.
struct Variant {
  std::string_view where;  ///< its name in the results of `diagnose`; empty: no variant
  double value = 0.0;
};

/// A number of an effect, with its full key: "vegetation-drag.coefficient".
struct EffectField : Field<Effects> {
  std::optional<SearchRange> search;
  Typical set_to = Typical::One;      ///< if not One, a search sets the number to this median
  std::array<Variant, 2> variants{};  ///< a search tries each of them
  bool by_cell = false;               ///< may be a raster instead

  bool is_strength() const { return !std::isnan(off); }
};

inline constexpr std::size_t kMostFields = 8;

/// Description of one effect, without its physics. Readers, writers, `diagnose` and tests use it.
struct EffectEntry {
  std::string_view name;  ///< in scenario, docs and diagnosis
  Sought sought;
  int turn;  ///< its rank among the candidates of `diagnose`: small numbers first
  std::array<EffectField, kMostFields> all_fields;
  std::size_t field_count;
  EffectArea* (*area_in)(Effects&);        ///< null: it acts everywhere
  std::vector<int>* (*days_in)(Effects&);  ///< null: it acts on all days
  bool leaves_plane;                       ///< it turns blocks sideways (`kLeavesPlane`): not for a profile
  bool mapped;                             ///< it can have a map of rasters or trees

  std::span<const EffectField> fields() const { return std::span(all_fields).first(field_count); }
  /// Key without the name of the effect: "coefficient".
  std::string_view key_of(const EffectField& field) const { return field.key.substr(name.size() + 1); }
  /// Whether a strength of the effect differs from its off value.
  bool acts(const Effects& effects) const;

  EffectArea* area(Effects& effects) const { return area_in == nullptr ? nullptr : area_in(effects); }
  const EffectArea* area(const Effects& effects) const { return area(const_cast<Effects&>(effects)); }
  std::vector<int>* days(Effects& effects) const { return days_in == nullptr ? nullptr : days_in(effects); }
  const std::vector<int>* days(const Effects& effects) const { return days(const_cast<Effects&>(effects)); }
};

/// An entry that holds its member of `Effects` at compile time.
template <auto effect>
struct EntryOf : EffectEntry {
  static constexpr auto kMember = effect;
};

namespace registry {

/// Stands for a value of any type, to count the members of an aggregate.
struct Anything {
  template <class T>
  operator T() const;
};

template <class Aggregate, std::size_t... i>
constexpr bool takes(std::index_sequence<i...>) {
  return requires {
    Aggregate{(static_cast<void>(i), Anything{})...};
  };
}

/// Number of members of an aggregate.
template <class Aggregate, std::size_t n = 0>
constexpr std::size_t members_of() {
  if constexpr (takes<Aggregate>(std::make_index_sequence<n + 1>{}))
    return members_of<Aggregate, n + 1>();
  else
    return n;
}

/// A number of an effect, as written in the registry.
template <auto member>
struct Number {
  Bounds bounds;
  double off = kNotGiven;
  std::optional<SearchRange> search = {};
  Typical set_to = Typical::One;
  std::array<Variant, 2> variants = {};
  bool by_cell = false;
};

/// A number that may be a raster instead.
template <auto member>
constexpr Number<member> by_cell(Number<member> number) {
  number.by_cell = true;
  return number;
}

/// A strength: a number whose value 0 switches it off.
template <auto member>
constexpr Number<member> strength(const Bounds& bounds, const std::optional<SearchRange>& search) {
  return {bounds, 0.0, search};
}
/// A number that controls how the effect acts, not how strongly.
template <auto member>
constexpr Number<member> manner(const Bounds& bounds) {
  return {bounds};
}

/// Whether a search stays within the bounds. Otherwise a fit could write a file that cannot be read. A search in
/// multiples of a median, or of the inverse, is cut off at the bounds by `candidates_of`.
constexpr bool within(const Bounds& bounds, const std::optional<SearchRange>& search) {
  return !search || search->times != Typical::One || !search->inverse_unit.empty() ||
         (bounds.min <= search->lower && search->upper <= bounds.max);
}

template <class Effect, class Owner>
Effect owned_by(Effect Owner::*);
template <auto effect>
using EffectType = decltype(owned_by(effect));

template <auto effect, auto member>
constexpr EffectField lift(const Number<member>& number) {
  return {{number.bounds, [](const auto& e) -> double { return e.*effect.*member; },
           [](auto& e, double value) { e.*effect.*member = value; }, number.off},
          number.search,
          number.set_to,
          number.variants,
          number.by_cell};
}

/// Makes the entry of one effect. A contradiction in it throws, which is an error at compile time.
template <auto effect, auto... members>
consteval EntryOf<effect> entry(std::string_view name, Sought sought, int turn, const Number<members>&... numbers) {
  using Effect = EffectType<effect>;
  constexpr bool kPlaced = requires(Effect & e) {
    e.where;
  }
  , kDated = requires(Effect & e) {
    e.days;
  }
  , kMapped = requires(Effect & e) {
    e.map;
  };
  static_assert(members_of<Effect>() == sizeof...(members) + (kPlaced ? 1 : 0) + (kDated ? 1 : 0) + (kMapped ? 1 : 0),
                "each number of an effect must be in its entry; beside numbers it has `where`, `days` and `map` only");
  EntryOf<effect> out{
      {name, sought, turn, {lift<effect>(numbers)...}, sizeof...(members), nullptr, nullptr, false, kMapped}};
  if constexpr (kPlaced) out.area_in = [](auto& e) -> EffectArea* { return &(e.*effect).where; };
  if constexpr (kDated) out.days_in = [](auto& e) -> std::vector<int>* { return &(e.*effect).days; };
  out.leaves_plane = requires {
    Effect::kLeavesPlane;
  };
  if (sought == Sought::InZones && !kPlaced) throw "an effect that is sought in zones must have `EffectArea where`";
  if (sought == Sought::OnDays && !kDated) throw "an effect that is sought on days must have `std::vector<int> days`";
  const bool allowed = (within(numbers.bounds, numbers.search) && ...);
  if (!allowed) throw "a search goes beyond the bounds of its number";
  const bool named = (numbers.bounds.key.starts_with(name) && ...) && ((numbers.bounds.key[name.size()] == '.') && ...);
  if (!named) throw "a key does not begin with the name of its effect";
  return out;
}

}  // namespace registry
}  // namespace talus
