// SPDX-License-Identifier: MIT
#include "problems/generators.h"

#include <cmath>
#include <numbers>

#include "problems/bearings/film.h"
#include "problems/grid.h"

namespace cairn::problems {
namespace {

constexpr int kMinSize = 3;

struct Shape {
  double k = 0;         ///< Gap at the entry less gap at the exit, over gap at the exit.
  double waviness = 0;  ///< Amplitude of the waves, < 1.
  double waves = 0;     ///< Their number.

  double Film(double x) const {
    return 1 + k * (1 - x) + waviness * std::sin(2 * std::numbers::pi * waves * x);
  }
};

Grid Line(int size) { return {.nx = size, .ny = 1}; }

/// Exact for the plane slider.
double PlanePressure(double k, double x) {
  const double h = 1 + k * (1 - x);
  return k * x * (1 - x) / ((2 + k) * h * h);
}

std::vector<Answer> PlaneAnswers(double k, const Grid& line) {
  // Second order: over peak k^2 dx^2 / (1 + k), the largest errors seen are 0.75, 0.85, 1.6 and 2.6
  // for k = 0.1, 1, 5 and 10.
  const double dx = line.hx(), peak = k / (4 * (1 + k) * (2 + k));
  const double tolerance = (0.8 + 0.2 * k) * peak * k * k * dx * dx / (1 + k);
  return {{.name = "largest error of the pressure",
           .source = "p = k x (1 - x) / ((2 + k) h^2), closed form",
           .expected = 0,
           .tolerance = tolerance,
           .measure = [=](const Eigen::VectorXd& x) {
             return (x -
                     Sample(line, [k](double place, double) { return PlanePressure(k, place); }))
                 .lpNorm<Eigen::Infinity>();
           }}};
}

Problem Make(int size, const Shape& shape) {
  const Grid line = Line(size);
  Problem problem;
  problem.name = "slider-" + std::to_string(size) + "-k" + ShortestText(shape.k);
  if (shape.waviness > 0) {
    problem.name += "-a" + ShortestText(shape.waviness) + "-m" + ShortestText(shape.waves);
  } else {
    problem.answers = PlaneAnswers(shape.k, line);
  }
  problem.source = "Reynolds' equation for a slider with cavitation";
  problem.lcp = FilmLcp(line, [&](double x) { return shape.Film(x); });
  if (const int half = size / 2; half >= kMinSize) {
    problem.coarser = [=] { return Make(half, shape); };
    problem.prolong = [=](const Eigen::VectorXd& x) {
      return Prolong(Line(half), line, PressureBox(), x);
    };
  }
  return problem;
}

}  // namespace

Generator Slider() {
  return {.name = "slider",
          .help = "Pressure under a slider, plane or wavy with cavitation (1-D)",
          .size_help = "grid points along the slider",
          .size = 1000,
          .min_size = kMinSize,
          .max_size = 100000,
          .parameters = {{.name = "k",
                          .help = "slope: by how much the gap shrinks, in gaps at the exit",
                          .value = 1,
                          .min = 0.01,
                          .max = 10},
                         {.name = "waviness",
                          .help = "amplitude of waves, in gaps at the exit; 0 is plane",
                          .value = 0,
                          .min = 0,
                          .max = 0.9},
                         {.name = "waves",
                          .help = "their number; without effect on a plane slider",
                          .value = 3,
                          .min = 1,
                          .max = 50}},
          .make = [](int size, const std::vector<double>& values) -> std::unique_ptr<Source> {
            return std::make_unique<SingleProblem>(
                Make(size, {.k = values[0], .waviness = values[1], .waves = values[2]}));
          }};
}

}  // namespace cairn::problems
