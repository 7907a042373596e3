#pragma once
/// @file The part of a medium's extinction that a power series has to estimate: what lies above the
/// minima of the super-voxels.

#include <algorithm>
#include <span>
#include <vector>

#include "freepath/tracking/reference/reference_flight.h"
#include "freepath/tracking/reference/reference_medium.h"

namespace freepath {

/// Transmittance is exp(-control) times that of the residual, mu_t minus the minimum of the
/// super-voxel. This holds the control's optical depth, and the segments in which a residual may be
/// left, with its bound: the rate.
template <int kN>
class ResidualSegments {
 public:
  /// A point of the residual part.
  struct Point {
    double t;     ///< [world], from where the ray enters the medium
    double rate;  ///< Largest residual extinction of any channel here, as bounded [1/m].
    std::span<const double, kN> control;  ///< Minimum of the extinction here [1/m].
  };

  /// Replaces the contents by the segments of a path.
  template <ReferenceMedium Medium>
  void gather(const Medium& medium, const typename Medium::Path& path, WalkStatistics& statistics) {
    pieces_.clear();
    length_ = depth_ = 0;
    std::fill(control_depth_, control_depth_ + kN, 0.0);
    auto segments = medium.segments(path);
    typename Medium::Segment segment;
    while (segments.next(segment)) {
      ++statistics.super_voxel_steps;
      if (!segment.empty) add(medium, segment);
    }
  }

  /// Optical depth of the minima.
  const double (&control_depth() const)[kN] { return control_depth_; }
  /// Length over which there is a residual [world].
  double length() const { return length_; }
  /// Optical depth by the rate: what the residual's is at most.
  double depth() const { return depth_; }

  /// The point before which a given length of the residual part lies.
  Point at_length(double length) const {
    const Piece& piece = find(&Piece::length_before, length);
    return point(piece, piece.begin + (length - piece.length_before));
  }
  /// The point before which a given optical depth by the rate lies.
  Point at_depth(double depth) const {
    const Piece& piece = find(&Piece::depth_before, depth);
    return point(piece, piece.begin + (depth - piece.depth_before) / piece.rate);
  }

 private:
  struct Piece {
    double begin;
    double end;
    double length_before;
    double depth_before;
    double rate;
    std::array<double, kN> control;
  };

  template <ReferenceMedium Medium>
  void add(const Medium& medium, const typename Medium::Segment& segment) {
    const double length = segment.end - segment.begin;
    const auto most = extinction<kN>(medium, segment.maximum);
    const auto least = extinction<kN>(medium, segment.minimum);
    double rate = 0;
    for (int channel = 0; channel < kN; ++channel) {
      control_depth_[channel] += least[channel] * length;
      rate = std::max(rate, most[channel] - least[channel]);
    }
    if (!(rate > 0 && length > 0)) return;
    pieces_.push_back({segment.begin, segment.end, length_, depth_, rate, least});
    length_ += length;
    depth_ += rate * length;
  }

  const Piece& find(double Piece::*before, double value) const {
    const auto after =
        std::upper_bound(pieces_.begin(), pieces_.end(), value,
                         [&](double wanted, const Piece& piece) { return wanted < piece.*before; });
    return after == pieces_.begin() ? *after : *(after - 1);
  }

  static Point point(const Piece& piece, double t) {
    return {std::min(t, piece.end), piece.rate, piece.control};
  }

  std::vector<Piece> pieces_;
  double control_depth_[kN] = {};
  double length_ = 0;
  double depth_ = 0;
};

}  // namespace freepath
