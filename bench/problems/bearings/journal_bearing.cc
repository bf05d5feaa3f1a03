// SPDX-License-Identifier: MIT
#include "problems/generators.h"

#include <cmath>
#include <numbers>
#include <string>

#include "problems/bearings/film.h"
#include "problems/grid.h"

namespace cairn::problems {
namespace {

constexpr int kMinSize = 2;
constexpr double kLength = 20;  // 2 b

Grid Mesh(int nx, int ny) {
  return {.nx = nx, .ny = ny, .lx = 2 * std::numbers::pi, .ly = kLength};
}

constexpr double kEightDigits = 5e-9, kFiveDigits = 5e-5;

struct Published {
  int size;
  double eccentricity, objective, tolerance;
};

/// CUTEst prints five digits, for JNLBRNG2 (e = 0.5) of a tenth of the objective. Where there are
/// more here, they come from an independent solution by active sets, and agree with those of
/// CUTEst.
constexpr Published kObjectives[] = {
    {2, 0.1, -0.22473501, kEightDigits},   {8, 0.1, -0.17896187, kEightDigits},
    {21, 0.1, -0.18004557, kEightDigits},  {30, 0.1, -0.18030154, kEightDigits},
    {73, 0.1, -0.18054846, kEightDigits},  {98, 0.1, -0.18057327, kEightDigits},
    {123, 0.1, -0.18058476, kEightDigits}, {400, 0.1, -0.18060341, kEightDigits},
    {2, 0.5, -4.7640, kFiveDigits},        {8, 0.5, -3.9528, kFiveDigits},
    {21, 0.5, -4.1024, kFiveDigits},       {30, 0.5, -4.1249, kFiveDigits},
    {73, 0.5, -4.14655582, kEightDigits},  {98, 0.5, -4.1487, kFiveDigits},
    {123, 0.5, -4.14961122, kEightDigits}, {73, 0.9, -20.34582263, kEightDigits}};

std::vector<Answer> Answers(const BoxedLcp& lcp, int size, double e) {
  std::vector<Answer> answers;
  for (const Published& known : kObjectives) {
    if (known.size == size && known.eccentricity == e) {
      answers.push_back(ObjectiveAnswer(lcp, known.objective, known.tolerance,
                                        known.tolerance > kEightDigits
                                            ? "CUTEst JNLBRNG2"
                                            : "independent solution by active sets"));
    }
  }
  if (size == 400 && e == 0.1) {
    answers.push_back({.name = "cavitated points",
                       .source = "independent solution by active sets",
                       .expected = 51558,
                       .tolerance = 0,
                       .measure = [](const Eigen::VectorXd& x) {
                         return static_cast<double>((x.array() <= 0).count());
                       }});
  }
  return answers;
}

}  // namespace

Problem MakeJournalBearing(int nx, int ny, double eccentricity) {
  const Grid mesh = Mesh(nx, ny);
  // The film of a triangle is the mean over its vertices: two at one x, one at a neighbour.
  const auto p = [&](int i) { return std::pow(1 + eccentricity * std::cos(mesh.x(i)), 3); };
  const double slender = mesh.hy() / mesh.hx();
  const Conductance k = {
      .east = [&](int i, int) { return slender * (p(i) + p(i + 1)) / 2; },
      .north = [&](int i, int) { return (4 * p(i) + p(i - 1) + p(i + 1)) / (6 * slender); }};
  Problem problem;
  problem.name = "journal-bearing-" + std::to_string(nx);
  if (nx != ny) problem.name.append("x").append(std::to_string(ny));
  problem.name.append("-e").append(ShortestText(eccentricity));
  problem.source = "MINPACK-2 dpjbfg, b = 10: the journal bearing";
  problem.lcp.M = FivePointMatrix(mesh, k);
  const double load = eccentricity * mesh.hx() * mesh.hy();
  problem.lcp.q = Sample(mesh, [load](double x, double) { return -load * std::sin(x); });
  problem.lcp.lo = Sample(mesh, PressureBox().lo);
  problem.lcp.hi = Sample(mesh, PressureBox().hi);
  if (nx == ny) problem.answers = Answers(problem.lcp, nx, eccentricity);
  if (nx / 2 >= kMinSize && ny / 2 >= kMinSize) {
    problem.coarser = [=] { return MakeJournalBearing(nx / 2, ny / 2, eccentricity); };
    problem.prolong = [=](const Eigen::VectorXd& x) {
      return Prolong(Mesh(nx / 2, ny / 2), mesh, PressureBox(), x);
    };
  }
  return problem;
}

Generator JournalBearing() {
  return {.name = "journal-bearing",
          .help = "Pressure in a journal bearing of finite length with cavitation",
          .size_help = "grid points per side",
          .size = 100,
          .min_size = kMinSize,
          .max_size = 400,
          .parameters = {{.name = "eccentricity",
                          .help = "of the journal, 0 is centred, 1 touches",
                          .value = 0.1,
                          .min = 0.01,
                          .max = 0.95}},
          .make = [](int size, const std::vector<double>& values) -> std::unique_ptr<Source> {
            return std::make_unique<SingleProblem>(MakeJournalBearing(size, size, values[0]));
          }};
}

}  // namespace cairn::problems
