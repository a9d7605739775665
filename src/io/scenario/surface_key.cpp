#include "surface_key.hpp"

namespace talus::io {
namespace {

constexpr const char* kAllowed = "must be 'bilinear' or 'creased'";

}  // namespace

std::optional<SurfaceKind> read_surface(TableReader& top) {
  const auto name = top.text("surface");
  if (!name) return std::nullopt;
  const auto kind = surface_kind(*name);
  if (!kind) top.fault("surface", *top.value()->find("surface"), kAllowed);
  return kind;
}

std::optional<SurfaceKind> surface_of_flag(const std::string& value, std::vector<std::string>& faults) {
  const auto kind = surface_kind(value);
  if (!kind) faults.push_back("flag --surface = '" + value + "': " + kAllowed);
  return kind;
}

}  // namespace talus::io
