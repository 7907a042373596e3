#include "freepath/scene/assembly/entity_kinds.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "freepath/scene/pbrt/nearest_name.h"

namespace freepath {

void fail_unknown_type(const PbrtEntity& entity, std::string_view what,
                       std::span<const std::string_view> known,
                       std::span<const std::string_view> unsupported) {
  const std::string type = in_quotes(entity.type);
  if (std::ranges::find(unsupported, entity.type) != unsupported.end()) {
    fail_at(entity.location, "the {} {} is not supported; there are: {}", what, type,
            fmt::join(known, ", "));
  }
  const std::string meant = did_you_mean(entity.type, known);
  if (!meant.empty()) fail_at(entity.location, "there is no {} of type {}{}", what, type, meant);
  fail_at(entity.location, "there is no {} of type {}; there are: {}", what, type,
          fmt::join(known, ", "));
}

}  // namespace freepath
