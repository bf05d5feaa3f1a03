// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"
#include "cairn/settings.h"
#include "problem/islands.h"
#include "problem/whitening.h"

namespace cairn {

using Vector6 = std::array<double, 6>;

/// A row of one island.
struct PackedRow {
  Vector6 g_a, g_b;
  int a, b;           ///< bodies of the island, counted from 1; 0 is everything that does not move
  double target;      ///< b - J (velocity without constraints)
  double compliance;  ///< E
  double diagonal;    ///< d = |G|^2 + E, and LockedSide::extra
  double step;        ///< relaxation / d, or 0 for a row that nothing can satisfy
  double lo, hi;
  double friction;
  int parent;  ///< row of this island, or kNoRow
  int max_sweeps;
  bool angular;  ///< the row only turns: its velocities are [rad/s]
};

/// The constant part of one island.
struct PackedIsland {
  Array<PackedRow> rows;
  int bodies = 0;   ///< movable ones
  double mass = 0;  ///< of them [kg]
  /// Of each: what u changes it by, and how it moves without impulses as rows see it.
  struct Motion {
    Eigen::Vector3d free, whitening;
    double mass = 0;
  };
  Array<Motion> motions = {};
};

/// What iterations write. Always consistent: u = G' x, up to the rounding of increments.
struct IslandState {
  Array<double> x;
  Array<Vector6> u;  ///< bodies + 1; the first belongs to what does not move and stays 0
};

/// False: a row of a joint.
inline bool HasBounds(const PackedRow& row) {
  return row.parent != kNoRow || row.lo != -kInfinity || row.hi != kInfinity;
}

struct Bounds {
  double lo, hi;
};

/// The bounds of a row, for friction from the present impulse of its parent.
inline Bounds BoundsOf(const PackedRow& row, const Array<double>& x) {
  if (row.parent == kNoRow) return {row.lo, row.hi};
  const double most = x[row.parent] > 0 ? row.friction * x[row.parent] : 0;
  return {-most > row.lo ? -most : row.lo, most < row.hi ? most : row.hi};
}

inline double Clamp(double value, Bounds bounds) {
  const double low = value < bounds.lo ? bounds.lo : value;
  return low > bounds.hi ? bounds.hi : low;
}

inline double Dot(const Vector6& g, const Vector6& u) {
  double sum = 0;
  for (int k = 0; k < 6; ++k) sum += g[k] * u[k];
  return sum;
}

inline void AddScaled(const Vector6& g, double scale, Vector6* u) {
  for (int k = 0; k < 6; ++k) (*u)[k] += g[k] * scale;
}

/// G u of one row.
inline double RelativeVelocity(const PackedRow& row, const Array<Vector6>& u) {
  return Dot(row.g_a, u[row.a]) + Dot(row.g_b, u[row.b]);
}

/// w = G u + E x - target of one row.
inline double RelativeVelocity(const PackedRow& row, const Array<Vector6>& u, double x) {
  return RelativeVelocity(row, u) + row.compliance * x - row.target;
}

/// Between the caller's bodies and rows and whitened islands. One copy in, one copy out.
class Packer {
 public:
  /// @pre the problem passed Validate()
  Packer(const ContactProblem& problem, const Settings& settings);
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;

  PackedIsland Pack(const Island& island) const;

  /// x from the caller's impulses, brought inside the bounds, and the u that belongs to it.
  static IslandState Start(const PackedIsland& packed, const Island& island,
                           std::span<const double> impulses);

  /// The first body whose velocity without constraints is not finite, -1 if there is none.
  int FirstNotFinite() const;
  /// Whether those below are finite.
  bool HasFiniteVelocities(const Island& island, const IslandState& state) const;
  /// Velocity of every body without constraints.
  void WriteFreeVelocities(std::span<Velocity> velocities) const;
  /// Velocities of the bodies of one island.
  void WriteVelocities(const Island& island, const IslandState& state,
                       std::span<Velocity> velocities) const;

 private:
  PackedRow PackRow(const Row& row) const;
  Velocity VelocityOf(int body, const Vector6& u) const;
  /// Adds to the diagonal of the row.
  Vector6 WhitenRow(int body, const Eigen::Vector3d& linear, const Eigen::Vector3d& angular,
                    double* diagonal) const;

  ContactProblem problem_;
  double omega_;
  bool leaves_locked_;  ///< not where sweeps are Bullet's, whose short steps do
  Array<WhitenedBody> bodies_;
  mutable Array<int> local_;  ///< scratch: problem row or body -> island row or body
  mutable Array<int> local_row_;
};

/// u = G' x, from scratch.
void RecomputeVelocities(const PackedIsland& island, IslandState* state);

}  // namespace cairn
