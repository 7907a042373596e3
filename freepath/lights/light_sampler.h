#pragma once
/// @file Choosing one of many lights.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/lights/light_bounds.h"

namespace freepath {

/// A light and the probability of its choice; with 0 there is none.
struct LightChoice {
  uint32_t light = 0;
  float probability = 0;
};

/// Draws lights by their power, if they are few; else by what they may contribute at a point: down
/// a binary tree, choosing at each node between both groups of lights [Conty18]. The probability of
/// any light is known everywhere, and is positive where it shines. Immutable.
class LightSampler {
 public:
  /// More lights than these make a tree.
  static constexpr std::size_t kFewLights = 16;

  LightSampler() = default;
  /// @param lights those with a power of 0 are never drawn
  explicit LightSampler(const std::vector<LightBounds>& lights);

  LightChoice choose(const Vec3f& position, float u) const;
  float probability(const Vec3f& position, uint32_t light) const;

  /// Whether there is nothing to draw.
  bool is_dark() const { return probabilities_.empty() && nodes_.empty(); }

 private:
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

  struct Node {
    LightBounds bounds;
    uint32_t parent = kNone;
    uint32_t second = kNone;  // the first child is the next node; none in a leaf
    uint32_t light = kNone;
  };

  using Lights = std::vector<LightBounds>;
  /// Adds the tree of lights order[first, last).
  void build(const Lights& lights, std::vector<uint32_t>* order, std::size_t first,
             std::size_t last, uint32_t parent);

  std::vector<float> probabilities_;  // of each light, if they are few
  std::vector<Node> nodes_;
  std::vector<uint32_t> leaves_;  // node of each light
};

}  // namespace freepath
