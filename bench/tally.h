#pragma once
/// @file What a variant of the benchmark did to its rays.

namespace freepath::bench {

/// Sums over rays, with the squares that a test for equal means needs.
struct Tally {
  double rays = 0;
  double collisions = 0;  ///< Tentative collisions.
  double collisions_squared = 0;
  double weight = 0;  ///< 1 for a ray that escaped, or the transmittance along it.
  double weight_squared = 0;

  void add_ray(double ray_collisions, double ray_weight) {
    rays += 1;
    collisions += ray_collisions;
    collisions_squared += ray_collisions * ray_collisions;
    weight += ray_weight;
    weight_squared += ray_weight * ray_weight;
  }
  void merge(const Tally& other) {
    rays += other.rays;
    collisions += other.collisions;
    collisions_squared += other.collisions_squared;
    weight += other.weight;
    weight_squared += other.weight_squared;
  }
};

}  // namespace freepath::bench
