// SPDX-License-Identifier: MIT
#include "cairn/lcp/problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cairn::lcp {
namespace {

/// Nothing is small relative to what overflowed.
double Relative(double value, double scale) {
  if (!std::isfinite(scale)) return std::numeric_limits<double>::infinity();
  return scale > 0 ? value / scale : value;
}

}  // namespace

LcpResidual Measure(const BoxedLcp& problem, const Eigen::VectorXd& x) {
  const Eigen::VectorXd diagonal = problem.M.diagonal();
  const Eigen::VectorXd mx = problem.M * x;
  LcpResidual residual;
  double energy2 = 0, natural2 = 0, q_energy2 = 0;
  for (Eigen::Index i = 0; i < problem.size(); ++i) {
    const double d = diagonal[i], q = problem.q[i], w = mx[i] + q;
    const double lo = problem.lo[i], hi = problem.hi[i];

    // x - clamp(x - w, lo, hi) in which a small w beside a large x is not lost
    const double below = x[i] - lo, above = x[i] - hi;
    const double e = d * std::abs(std::clamp(w / d, above, below));
    residual.max = std::max(residual.max, e);
    energy2 += e * e / d;
    q_energy2 += q * q / d;
    const double natural = std::clamp(w, above, below);
    natural2 += natural * natural;

    residual.violation = std::max({residual.violation, lo - x[i], x[i] - hi});
    const double room = w > 0 ? x[i] - lo : hi - x[i];
    residual.complementarity +=
        std::abs(w) * (std::isfinite(room) ? std::abs(room) : std::abs(w) / d);
  }
  residual.energy = std::sqrt(energy2);
  residual.relative = Relative(residual.energy, std::sqrt(q_energy2));
  residual.natural = Relative(std::sqrt(natural2), problem.q.norm());
  residual.objective = x.dot(0.5 * mx + problem.q);
  return residual;
}

}  // namespace cairn::lcp
