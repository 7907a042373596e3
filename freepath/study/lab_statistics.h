#pragma once
/// @file Moments of what weighted paths contribute, and tests of them.

#include <cstddef>
#include <cstdint>
#include <span>

#include "freepath/base/moments.h"

namespace freepath {

/// Power sums of contributions; a path that contributes nothing need not be added.
struct LabMoments : Moments {
  double cubes = 0, fourths = 0;

  void add(double value) {
    Moments::add(value);
    const double square = value * value;
    cubes += square * value;
    fourths += square * square;
  }
  void merge(const LabMoments& other) {
    Moments::merge(other);
    cubes += other.cubes;
    fourths += other.fourths;
  }
  /// Whether the mean over so many paths is as good as normal: its skewness is below 0.05 and its
  /// excess below 0.01 (the next terms of Edgeworth's series).
  bool has_normal_mean(uint64_t paths) const;
};

/// Whether a comparison with what is exact counts.
enum class LabStanding {
  kTested,
  kRare,   ///< Too few contributions for a mean that is normal.
  kHeavy,  ///< The weights spread so widely that no mean over so many paths is normal.
};

/// An estimate against what is exact.
struct LabCheck {
  double estimate = 0;
  double standard_error = 0;
  double exact = 0;
  double z = 0;  ///< Standard errors from the exact value; of a distribution, see p.
  double p = 1;  ///< Probability of a distance at least as large by chance.
  LabStanding standing = LabStanding::kTested;
};

/// The mean over paths against its exact value.
LabCheck check_mean(const LabMoments& moments, uint64_t paths, double exact);

/// Sums of weights in bins, of which a path adds to one at most, against what is expected of each:
/// Hotelling's form n dᵀ C⁻¹ d of the distances d of the means. C = D - m mᵀ, m the exact means and
/// D the diagonal of the mean squares (in proportion to m, as the weights seen have it), is
/// inverted by Sherman and Morrison's formula. With weights of 1 it is Pearson's test. Neighbours
/// are merged until each bin expects enough; z is that of a normal deviate as unlikely.
LabCheck check_distribution(std::span<const LabMoments> bins, std::span<const double> exact,
                            uint64_t paths);

/// P(|Z| ≥ |z|) of the standard normal distribution.
double normal_two_sided_p(double z);

}  // namespace freepath
