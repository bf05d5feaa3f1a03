// SPDX-License-Identifier: MIT
#pragma once

#include "problems/problem.h"

namespace cairn::problems {

/// A membrane over a ball: the u of least energy with u >= psi on (-2, 2)^2, psi = sqrt(1 - r^2)
/// inside r = 0.9 and its tangent cone outside. u is known everywhere: PETSc's SNES tutorial ex9.
/// The matrix is that of the 5-point formula times the square of the mesh width: 4 and -1.
/// A problem takes 88 bytes a point: 64 for M, 24 for q and the bounds. While it is made, M is
/// there up to three times, since Eigen 3.4 copies where it should move: 205 MiB for 1000 x 1000
/// points.
Generator Obstacle();

/// A membrane between two obstacles on the unit square under a load c, u = 0 around: Dembo and
/// Tulowitzki 1983 as in CUTEst. OBSTCLB, between s^3 and s^2 + 0.02 with s = sin(9.2 x) sin(9.3
/// y); or OBSTCLA, above sin(3.2 x) sin(3.3 y) and below 2000. As there, the edges that end on the
/// boundary count half.
Generator TwoSidedObstacle();

/// Elastic-plastic torsion of a square bar: the stress function u, |u| at most the distance to the
/// boundary of the unit square, that minimises integral of 1/2 |grad u|^2 - c u; c grows with the
/// twist. CUTEst's TORSION1 (c = 5), TORSION3 (10) and TORSION5 (20) of More and Toraldo, SIAM J.
/// Optim. 1 (1991). As there, the edges that end on the boundary count half.
Generator Torsion();

/// The pressure p >= 0 in a journal bearing of finite length: minimise
///   integral of 1/2 (1 + e cos x)^3 |grad p|^2 - e sin(x) p   over (0, 2 pi) x (0, 20), p = 0
///   around,
/// in linear finite elements on halved rectangles, as MINPACK-2's dpjbfg (Averick et al., "The
/// MINPACK-2 test problem collection", 1992, b = 10) and CUTEst's JNLBRNG1 and JNLBRNG2.
Generator JournalBearing();

/// That problem on nx points around and ny along the bearing, without its boundary. CUTEst's PT and
/// PY count the boundary: nx = PT - 2.
Problem MakeJournalBearing(int nx, int ny, double eccentricity);

/// The plane slider, -(h^3 p')' + h' >= 0, p >= 0 on (0, 1) with the wedge h = 1 + k (1 - x): its
/// pressure p = k x (1 - x) / ((2 + k) h^2) is positive everywhere, so that no bound is active.
/// Waves on it, h + a sin(2 pi m x), cavitate where they open too fast; then nothing is known.
Generator Slider();

/// The infinitely long journal bearing, -(h^3 p')' + h' >= 0, p >= 0 on (0, 2 pi) with the film
/// h = 1 + e cos t and p = 0 at both ends: Cryer, "The method of Christopherson for solving free
/// boundary problems for infinite journal bearings by means of finite differences", Math. Comp. 25
/// (1971). Its pressure is known in closed form.
Generator InfiniteBearing();

/// The exact pressure of that bearing with Reynolds' condition p = p' = 0 where the film ruptures:
///   p(t) = I2(t) - h(t*) I3(t) for t <= t*, else 0,   I_k(t) = integral of h^-k from 0 to t,
/// in closed form by Sommerfeld's substitution cos g = (e + cos t) / (1 + e cos t).
class ReynoldsPressure {
 public:
  /// @param eccentricity  e, in (0, 1).
  explicit ReynoldsPressure(double eccentricity);

  double eccentricity() const { return e_; }
  double Film(double t) const;                 ///< h(t)
  double operator()(double t) const;           ///< p(t), 0 <= t <= 2 pi.
  double rupture() const { return rupture_; }  ///< t*, in (pi, 2 pi).
  double Peak() const;                         ///< The largest pressure, at 2 pi - t*.

 private:
  /// Where the film ruptures if the gap there is h(t): zero at t*.
  double PressureLeft(double t, double gap) const;

  double e_;
  double rupture_;
};

/// "american-put": the march of an American put on one asset.
Generator AmericanPut();

/// "american-put-step": one step in the middle of such a march, with its solution.
Generator AmericanPutStep();

/// "put-on-min": the march of a put on the cheaper of two assets.
Generator PutOnMin();

/// "put-on-average": the same on their average.
Generator PutOnAverage();

/// "put-on-min-step": one step in the middle of the first march, with its solution.
Generator PutOnMinStep();

}  // namespace cairn::problems
