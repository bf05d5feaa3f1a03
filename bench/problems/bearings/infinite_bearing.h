// SPDX-License-Identifier: MIT
#pragma once

#include "problems/problem.h"

namespace cairn::problems {

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

}  // namespace cairn::problems
