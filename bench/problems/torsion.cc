// SPDX-License-Identifier: MIT
#include "problems/generators.h"

#include <algorithm>
#include <string>

#include "problems/grid.h"

namespace cairn::problems {
namespace {

constexpr int kMinSize = 2;

double Distance(double x, double y) { return std::min({x, 1 - x, y, 1 - y}); }

Box TorsionBox() {
  return {.lo = [](double x, double y) { return -Distance(x, y); },
          .hi = Distance,
          .boundary = Constant(0)};
}

struct Published {
  double c;
  int size;
  double objective, tolerance;
};

/// Those of size 72 are solutions certified in extended precision. The others are printed in the
/// files of CUTEst, for c = 10 and 20 to more digits than they were converged: 5.8e-9 was seen.
constexpr Published kObjectives[] = {
    {5, 2, -0.51851852, 5e-9},      {5, 8, -0.49234185, 5e-9},      {5, 20, -0.45608771, 5e-9},
    {5, 72, -0.43027580109, 1e-10}, {10, 2, -1.2592592567, 1e-8},   {10, 8, -1.2705380252, 1e-8},
    {10, 20, -1.2422498827, 1e-8},  {20, 2, -2.7407407353, 1e-8},   {20, 8, -2.8971193358, 1e-8},
    {20, 20, -2.8847068155, 1e-8},  {20, 72, -2.86337796896, 1e-10}};

Problem Make(int size, double c) {
  const Grid grid = {.nx = size, .ny = size};
  const Box box = TorsionBox();
  Problem problem;
  problem.name = "torsion-" + std::to_string(size) + "-c" + ShortestText(c);
  problem.source = "More and Toraldo 1991, CUTEst TORSION: elastic-plastic torsion of a square bar";
  problem.lcp.M = FivePointMatrix(grid, Membrane(grid, 0.5));
  problem.lcp.q = Sample(grid, Constant(-c * grid.hx() * grid.hy()));
  problem.lcp.lo = Sample(grid, box.lo);
  problem.lcp.hi = Sample(grid, box.hi);
  for (const Published& known : kObjectives) {
    if (known.c == c && known.size == size) {
      problem.answers.push_back(ObjectiveAnswer(problem.lcp, known.objective, known.tolerance,
                                                "CUTEst TORSION1, TORSION3 and TORSION5"));
    }
  }
  if (const int half = size / 2; half >= kMinSize) {
    problem.coarser = [=] { return Make(half, c); };
    problem.prolong = [=](const Eigen::VectorXd& x) {
      return Prolong({.nx = half, .ny = half}, grid, box, x);
    };
  }
  return problem;
}

}  // namespace

Generator Torsion() {
  return {
      .name = "torsion",
      .help = "Elastic-plastic torsion of a square bar (CUTEst TORSION)",
      .size_help = "grid points per side",
      .size = 72,
      .min_size = kMinSize,
      .max_size = 1000,
      .parameters = {{.name = "c",
                      .help = "load, grows with the twist: 5 is TORSION1, 10 TORSION3, 20 TORSION5",
                      .value = 5,
                      .min = -100,
                      .max = 100}},
      .make = [](int size, const std::vector<double>& values) -> std::unique_ptr<Source> {
        return std::make_unique<SingleProblem>(Make(size, values[0]));
      }};
}

}  // namespace cairn::problems
