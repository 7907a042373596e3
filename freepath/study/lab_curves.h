#pragma once
/// @file What is exact in a setting of the laboratory.

#include <vector>

#include "freepath/study/lab_settings.h"

namespace freepath {

/// Coefficients along the ray, and what follows from them. Between the faces of voxels all
/// coefficients are constant, so optical depths are sums, and the scattering that is expected
/// within a voxel is (mu_s/mu_t) (T(begin) - T(end)).
class LabCurves {
 public:
  explicit LabCurves(const LabSetting& setting);

  int channels() const { return channels_; }
  /// [1/m] x in [0,1].
  double sigma_a(double x, int channel) const { return piece(x, channel).sigma_a; }
  double sigma_s(double x, int channel) const { return piece(x, channel).sigma_s; }
  double sigma_t(double x, int channel) const { return piece(x, channel).sigma_t(); }
  /// Optical depth from 0 to x.
  double depth(double x, int channel) const;
  double transmittance(double x, int channel) const;
  /// ∫ mu_s T dx: the weight that scatters between two places.
  double scattered(double begin, double end, int channel) const;
  /// The radiance that comes out at x = 0.
  double radiance(int channel) const { return radiance_[channel]; }

 private:
  struct Piece {
    double sigma_a = 0, sigma_s = 0;
    double source = 0;  ///< sigma_a L_e
    double depth = 0;   ///< Optical depth from 0 to where it begins.
    double sigma_t() const { return sigma_a + sigma_s; }
  };
  const Piece& piece(double x, int channel) const;
  double integrate_radiance(const LabSetting& setting, int channel) const;

  int channels_;
  /// Pieces of each channel, one a voxel and a last one at the end.
  std::vector<Piece> pieces_[3];
  double radiance_[3] = {};
};

/// Bounds of the extinction in a super-voxel that the ray passes.
struct LabBounds {
  double begin = 0, end = 0;  ///< [world]
  double majorant[3] = {};    ///< [1/m] of each channel
  double minorant[3] = {};    ///< [1/m] of each channel
};

std::vector<LabBounds> lab_bounds(const LabSetting& setting);

}  // namespace freepath
