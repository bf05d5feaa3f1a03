// SPDX-License-Identifier: MIT
#include "problems/generators.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "problems/bearings/film.h"
#include "problems/grid.h"

namespace cairn::problems {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kMinSize = 15;

Grid Line(int size) { return {.nx = size, .ny = 1, .lx = 2 * kPi}; }

}  // namespace

ReynoldsPressure::ReynoldsPressure(double eccentricity) : e_(eccentricity), rupture_(0) {
  // The pressure left at t falls on (pi, 2 pi) from plus to minus: d/dt = -h'(t) I3(t) < 0. Halving
  // an interval of length pi 60 times leaves less than rounding.
  double below = kPi, above = 2 * kPi;
  for (int k = 0; k < 60; ++k) {
    const double middle = (below + above) / 2;
    (PressureLeft(middle, Film(middle)) > 0 ? below : above) = middle;
  }
  rupture_ = below;
}

double ReynoldsPressure::Film(double t) const { return 1 + e_ * std::cos(t); }

double ReynoldsPressure::PressureLeft(double t, double gap) const {
  const double root = std::sqrt(1 - e_ * e_);
  // g runs from 0 to 2 pi with t.
  double g = std::atan2(root * std::sin(t), e_ + std::cos(t));
  if (t > kPi && g <= 0) g += 2 * kPi;
  const double i2 = (g - e_ * std::sin(g)) / (root * root * root);
  const double i3 = (g * (1 + e_ * e_ / 2) - 2 * e_ * std::sin(g) + e_ * e_ / 4 * std::sin(2 * g)) /
                    (root * root * root * root * root);
  return i2 - gap * i3;
}

double ReynoldsPressure::operator()(double t) const {
  return t < rupture_ ? PressureLeft(t, Film(rupture_)) : 0;
}

double ReynoldsPressure::Peak() const { return (*this)(2 * kPi - rupture_); }

namespace {

/// What second order leaves, over the square of the cell width: the largest that was seen is 0.0187
/// for t* and 0.24 of the peak for pressures, each over 1 - e, for 0.01 <= e <= 0.95 and 15 to 900
/// points.
constexpr double kRuptureError = 0.025, kPressureError = 0.3;

/// What flows through the first face flows through all of them up to the rupture, where no pressure
/// drives it: h(t*).
double Rupture(const ReynoldsPressure& exact, double dx, const Eigen::VectorXd& x) {
  const double h = exact.Film(dx / 2);
  const double flow = h - h * h * h * x[0] / dx;
  const double cosine = (flow - 1) / exact.eccentricity();
  return 2 * kPi - std::acos(std::clamp(cosine, -1.0, 1.0));
}

std::vector<Answer> Answers(const ReynoldsPressure& exact, const Grid& line) {
  const double dx = line.hx(), scale = dx * dx / (1 - exact.eccentricity());
  const double pressure_error = kPressureError * scale * exact.Peak();
  const std::string source = "Sommerfeld's integrals with Reynolds' condition, closed form";
  return {{.name = "free boundary",
           .source = source,
           .expected = exact.rupture(),
           .tolerance = kRuptureError * scale,
           .measure = [=](const Eigen::VectorXd& x) { return Rupture(exact, dx, x); }},
          {.name = "largest pressure",
           .source = source,
           .expected = exact.Peak(),
           .tolerance = pressure_error,
           .measure = [](const Eigen::VectorXd& x) { return x.maxCoeff(); }},
          {.name = "largest error of the pressure",
           .source = source,
           .expected = 0,
           .tolerance = pressure_error,
           .measure = [=](const Eigen::VectorXd& x) {
             return (x - Sample(line, [&](double t, double) { return exact(t); }))
                 .lpNorm<Eigen::Infinity>();
           }}};
}

Problem Make(int size, double e) {
  const ReynoldsPressure exact(e);
  const Grid line = Line(size);
  Problem problem;
  problem.name = "infinite-bearing-" + std::to_string(size) + "-e" + ShortestText(e);
  problem.source = "Cryer, Math. Comp. 25 (1971): the infinite journal bearing";
  problem.lcp = FilmLcp(line, [&](double t) { return exact.Film(t); });
  problem.answers = Answers(exact, line);
  if (const int half = size / 2; half >= kMinSize) {
    problem.coarser = [=] { return Make(half, e); };
    problem.prolong = [=](const Eigen::VectorXd& x) {
      return Prolong(Line(half), line, PressureBox(), x);
    };
  }
  return problem;
}

}  // namespace

Generator InfiniteBearing() {
  return {.name = "infinite-bearing",
          .help = "Pressure in an infinitely long journal bearing with cavitation (1-D)",
          .size_help = "grid points around the journal",
          .size = 1000,
          .min_size = kMinSize,
          .max_size = 100000,
          .parameters = {{.name = "eccentricity",
                          .help = "of the journal, 0 is centred, 1 touches",
                          .value = 0.5,
                          .min = 0.01,
                          .max = 0.95}},
          .make = [](int size, const std::vector<double>& values) -> std::unique_ptr<Source> {
            return std::make_unique<SingleProblem>(Make(size, values[0]));
          }};
}

}  // namespace cairn::problems
