// SPDX-License-Identifier: MIT
#include "problems/bearings/film.h"

#include <limits>

namespace cairn::problems {

BoxedLcp FilmLcp(const Grid& line, const std::function<double(double x)>& h) {
  const double dx = line.hx();
  // Film between points i and i + 1.
  const auto face = [&](int i) { return h(line.x(i) + dx / 2); };
  const Conductance k = {.east = [&](int i, int) { return face(i) * face(i) * face(i) / dx; },
                         .north = [](int, int) { return 0.0; }};
  BoxedLcp lcp;
  lcp.M = FivePointMatrix(line, k);
  lcp.q.resize(line.size());
  for (int i = 0; i < line.nx; ++i) lcp.q[i] = face(i) - face(i - 1);
  lcp.lo = Eigen::VectorXd::Zero(line.size());
  lcp.hi = Eigen::VectorXd::Constant(line.size(), std::numeric_limits<double>::infinity());
  return lcp;
}

Box PressureBox() {
  return {.lo = Constant(0),
          .hi = Constant(std::numeric_limits<double>::infinity()),
          .boundary = Constant(0)};
}

}  // namespace cairn::problems
