#include "freepath/geometry/refracting_sphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freepath {

namespace {

/// Two angles between which no rays leave; equal where all do.
struct Gap {
  double begin, end;
};

}  // namespace

/// The plane in which rays from a point inside stay that reach a point outside, in units of the
/// radius. Angles are at the centre, from the direction to the point inside on.
class RefractingSphere::Plane {
 public:
  Plane(const RefractingSphere& sphere, const Vec3d& inside, const Vec3d& outside)
      : eta_(sphere.eta_) {
    const Vec3d p = (inside - sphere.center_) / sphere.radius_;
    const Vec3d l = (outside - sphere.center_) / sphere.radius_;
    p_ = p.length();
    l_ = l.length();
    constexpr double kSmall = 1e-12;
    along_ = p_ > kSmall ? p / p_ : l / l_;
    const double height = l.dot(along_);
    const Vec3d off = l - along_ * height;
    const double width = off.length();
    across_ = width > kSmall ? off / width : Vec3d(0);
    angle_ = std::atan2(width, height);
  }

  double angle() const { return angle_; }
  /// View of the outside along the ray that leaves at an angle.
  struct Seen {
    double angle;      ///< Of where it passes the distance of the point outside.
    double slope;      ///< Derivative of that.
    double cosine;     ///< At the sphere, inside.
    double incidence;  ///< Cosine to the direction from the centre at the point outside.
    double sine_over;  ///< Sine of the angle at the point inside over that at the centre.
    double turn;       ///< Derivative of the former angle by the latter.
  };
  Seen seen_at(double phi) const {
    const double c = std::cos(phi);
    const double d2 = 1 + p_ * p_ - 2 * p_ * c;
    const double d = std::sqrt(d2);
    const double sine = p_ * std::sin(phi) / d;
    const double refracted = std::min(eta_ * sine, 1.0);
    const double far = refracted / l_;
    Seen seen{};
    seen.angle = phi + std::asin(refracted) - std::asin(far);
    seen.cosine = (1 - p_ * c) / d;
    seen.incidence = std::sqrt(1 - far * far);
    constexpr double kLeast = 1e-9;  // keeps the slope finite where reflection becomes total
    const double leaving = std::max(std::sqrt(1 - refracted * refracted), kLeast);
    seen.slope =
        1 + eta_ * seen.cosine * (1 / leaving - 1 / (l_ * seen.incidence)) * p_ * (c - p_) / d2;
    seen.sine_over = 1 / d;
    seen.turn = (1 - p_ * c) / d2;
    return seen;
  }

  /// Where the angle of incidence is largest, or reflection total.
  Gap gap() const {
    if (eta_ * p_ < 1) return {std::acos(p_), std::acos(p_)};
    const double incidence = std::asin(1 / eta_);
    const double at_inside = std::asin(std::min(1 / (eta_ * p_), 1.0));
    return {at_inside - incidence, std::numbers::pi - at_inside - incidence};
  }
  /// The range of angles that has the way which is told, if there is one.
  std::optional<Gap> range() const {
    constexpr double kClear = 1e-6;
    if (!(l_ > 1 + kClear)) return std::nullopt;
    const Gap none = gap();
    if (angle_ <= seen_at(none.begin).angle) return Gap{0, none.begin};
    if (angle_ > seen_at(none.end).angle) return Gap{none.end, std::numbers::pi};
    return std::nullopt;
  }

  SphereEntry entry(const RefractingSphere& sphere, double phi) const {
    const Seen seen = seen_at(phi);
    SphereEntry entry;
    entry.normal = along_ * std::cos(phi) + across_ * std::sin(phi);
    entry.position = sphere.center_ + entry.normal * sphere.radius_;
    entry.cosine = seen.cosine;
    const double sine = std::sin(phi) * seen.sine_over;
    constexpr double kNearAxis = 1e-7;
    const double per_angle = std::abs(seen.slope) / seen.turn;
    const double ratio = sine > kNearAxis ? std::sin(angle_) / sine : per_angle;
    const double distance = l_ * sphere.radius_;
    entry.spread = distance * distance * ratio * per_angle * seen.incidence;
    return entry;
  }
  /// Angle of a point, if it is on the side of the point outside.
  std::optional<double> angle_of(const Vec3d& direction) const {
    const double aside = direction.dot(across_);
    constexpr double kRounding = 1e-6;
    if (aside < -kRounding) return std::nullopt;
    return std::atan2(std::max(aside, 0.0), direction.dot(along_));
  }

 private:
  double eta_;
  double p_, l_;  // distances from the centre
  Vec3d along_, across_;
  double angle_;
};

std::optional<SphereEntry> RefractingSphere::find(const Vec3d& inside, const Vec3d& outside) const {
  const Plane plane(*this, inside, outside);
  const std::optional<Gap> range = plane.range();
  if (!range) return std::nullopt;
  // Newton's method, by halves where it would leave the range.
  double low = range->begin;
  double high = range->end;
  double phi = low + (high - low) * 0.5;
  constexpr int kMost = 100;
  constexpr double kNear = 1e-10;
  for (int i = 0; i < kMost; ++i) {
    const auto seen = plane.seen_at(phi);
    const double off = seen.angle - plane.angle();
    if (std::abs(off) < kNear) break;
    (off > 0 ? high : low) = phi;
    const double next = phi - off / seen.slope;
    phi = next > low && next < high ? next : low + (high - low) * 0.5;
  }
  return plane.entry(*this, phi);
}

std::optional<SphereEntry> RefractingSphere::at(const Vec3d& inside, const Vec3d& outside,
                                                const Vec3d& entry) const {
  const Plane plane(*this, inside, outside);
  const std::optional<Gap> range = plane.range();
  if (!range) return std::nullopt;
  const std::optional<double> phi = plane.angle_of((entry - center_) / radius_);
  if (!phi || *phi < range->begin || *phi > range->end) return std::nullopt;
  return plane.entry(*this, *phi);
}

}  // namespace freepath
