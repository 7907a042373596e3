#pragma once
/// @file Types of statements ("diffuse", "sphere", ...) and what builds each.

#include <span>
#include <string_view>
#include <vector>

#include "freepath/scene/pbrt/scene.h"

namespace freepath {

/// Throws the Error for the type of a statement that cannot be built.
/// @param what "material"
/// @param known types that can be
/// @param unsupported others that pbrt knows
[[noreturn]] void fail_unknown_type(const PbrtEntity& entity, std::string_view what,
                                    std::span<const std::string_view> known,
                                    std::span<const std::string_view> unsupported = {});

/// A type of a statement, and the function that builds what it names.
template <class Make>
struct EntityKind {
  std::string_view type;
  Make make;
};

/// What builds a statement, by its type.
/// @throws Error as fail_unknown_type
template <class Kinds>
const auto& maker_of(const PbrtEntity& entity, std::string_view what, const Kinds& kinds,
                     std::span<const std::string_view> unsupported = {}) {
  std::vector<std::string_view> known;
  for (const auto& kind : kinds) {
    if (kind.type == entity.type) return kind.make;
    known.push_back(kind.type);
  }
  fail_unknown_type(entity, what, known, unsupported);
}

}  // namespace freepath
