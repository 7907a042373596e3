#pragma once
/// @file What quadrature knows of a ray: the exact side of the certifying suite. It reads voxels
/// and coefficients by itself and shares no code with the walks.

#include <array>
#include <functional>
#include <vector>

#include "freepath/media/medium.h"
#include "freepath/media/medium_channels.h"

namespace freepath::testing {

/// A part of a line in the world.
struct CertifiedRay {
  Vec3f origin;
  Vec3f direction;
  float t_max = 1;
};

/// The densities of a medium along a ray, cut where the interpolant has its seams: within a piece
/// every density is a cubic, so depths are exact, and other integrals are done by composite Gauss
/// quadrature. Works for any transform of any component.
class RayProfile {
 public:
  /// A node of the quadrature.
  struct Node {
    double t = 0;
    double width = 0;  ///< Its weight in ∫ dt [world].
    std::array<double, Medium::kMaxComponents> density{};
    std::array<double, kMaxChannels> transmittance{};  ///< From the origin to t.
  };

  /// @param channels of the medium's components
  /// @param interpolation kStochastic is kTrilinear in expectation
  RayProfile(const Medium& medium, const MediumChannels& channels, const CertifiedRay& ray,
             Interpolation interpolation);

  /// Optical depth of the whole ray.
  double depth(int channel) const { return cuts_.back().depth[channel]; }

  /// About `bins` + 1 distances, the first 0 and the last the ray's end, between which the
  /// collisions of a channel are about equally likely. Parts without extinction join a bin.
  std::vector<double> equal_bins(int channel, int bins) const;

  /// Calls f at every node between two distances that equal_bins() gave, or 0 and the ray's end.
  void visit(double begin, double end, const std::function<void(const Node&)>& f) const;

 private:
  using Cubic = std::array<double, 4>;  ///< Σ_j cubic[j] s^j, s from 0 to 1 along a piece.
  struct Piece {
    double begin = 0;
    double end = 0;
    std::array<Cubic, Medium::kMaxComponents> density{};
    std::array<double, kMaxChannels> depth{};  ///< Of the ray up to where it begins.
  };
  /// An end of a part that quadrature treats at once.
  struct Cut {
    double t = 0;
    std::array<double, kMaxChannels> depth{};
    std::size_t piece = 0;  ///< Of the part that begins here.
  };

  Piece make_piece(double begin, double end) const;
  void add_cuts(std::size_t piece);
  double depth_within(const Piece& piece, double s, int channel) const;
  std::array<double, kMaxChannels> depth_at(const Piece& piece, double t) const;

  const Medium& medium_;
  const MediumChannels& channels_;
  CertifiedRay ray_;
  bool nearest_;
  std::vector<Piece> pieces_;
  std::vector<Cut> cuts_;
};

}  // namespace freepath::testing
