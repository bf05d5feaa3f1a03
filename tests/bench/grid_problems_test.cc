// SPDX-License-Identifier: MIT
// Lubrication, obstacle and torsion problems, held against closed forms and publications.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "generated.h"
#include "problems/generators.h"
#include "problems/grid.h"

namespace cairn::problems {
namespace {

using Eigen::VectorXd;

std::vector<Generator> GridGenerators() {
  return {JournalBearing(), InfiniteBearing(), Slider(), Obstacle(), TwoSidedObstacle(), Torsion()};
}

/// Default, lowest and highest value of each parameter in turn.
std::vector<std::vector<double>> ParameterChoices(const Generator& generator) {
  std::vector<double> defaults;
  for (const Parameter& parameter : generator.parameters) defaults.push_back(parameter.value);
  std::vector<std::vector<double>> choices = {defaults};
  for (size_t k = 0; k < defaults.size(); ++k) {
    for (const double value : {generator.parameters[k].min, generator.parameters[k].max}) {
      choices.push_back(defaults);
      choices.back()[k] = value;
    }
  }
  return choices;
}

TEST(GridGenerators, HaveDefaultsInsideTheirRanges) {
  for (const Generator& generator : GridGenerators()) {
    SCOPED_TRACE(generator.name);
    EXPECT_GE(generator.size, generator.min_size);
    EXPECT_LE(generator.size, generator.max_size);
    for (const Parameter& parameter : generator.parameters) {
      EXPECT_GE(parameter.value, parameter.min);
      EXPECT_LE(parameter.value, parameter.max);
      EXPECT_FALSE(parameter.help.empty());
    }
    EXPECT_FALSE(generator.help.empty());
    EXPECT_FALSE(generator.size_help.empty());
  }
}

TEST(GridGenerators, MakeProblemsThatTheSolverAccepts) {
  for (const Generator& generator : GridGenerators()) {
    for (const auto& values : ParameterChoices(generator)) {
      for (const int size : {generator.min_size, generator.min_size + 1, 40}) {
        const Problem problem = Generate(generator, size, values);
        SCOPED_TRACE(problem.name);
        EXPECT_EQ(Validate(problem.lcp).status, lcp::Status::kOk);
        EXPECT_TRUE(problem.lcp.size() == size || problem.lcp.size() == size * size);
        EXPECT_EQ(problem.name.rfind(generator.name + "-" + std::to_string(size), 0), 0u);
        // Exactly, as the energy of a grid of conductances is.
        const Eigen::SparseMatrix<double> transposed = problem.lcp.M.transpose();
        EXPECT_EQ((problem.lcp.M - transposed).norm(), 0);
      }
    }
  }
}

TEST(GridGenerators, NestTheirGridsDownToTheSmallest) {
  for (const Generator& generator : GridGenerators()) {
    for (int size : {generator.min_size, 61, 64}) {
      Problem problem = Generate(generator, size, ParameterChoices(generator).front());
      while (problem.coarser) {
        SCOPED_TRACE(problem.name);
        const Problem coarse = problem.coarser();
        size /= 2;
        EXPECT_EQ(coarse.name.rfind(generator.name + "-" + std::to_string(size), 0), 0u);
        const VectorXd inside = coarse.lcp.lo.cwiseMax(0).cwiseMin(coarse.lcp.hi);
        EXPECT_EQ(problem.prolong(inside).size(), problem.lcp.size());
        problem = coarse;
      }
      EXPECT_GE(size, generator.min_size);
      EXPECT_LT(size / 2, generator.min_size);
    }
  }
}

TEST(JournalBearing, HasThePublishedObjectives) {
  for (const double e : {0.1, 0.5}) {
    for (const int size : {2, 8, 21, 30, 73, 98, 123}) {
      const Problem problem = Generate(JournalBearing(), size, {e});
      ExpectEveryAnswer(problem, SolvedFromCoarse(problem));
    }
  }
  const Problem thin = Generate(JournalBearing(), 73, {0.9});
  ExpectEveryAnswer(thin, SolvedFromCoarse(thin));
  EXPECT_TRUE(Generate(JournalBearing(), 74, {0.1}).answers.empty());
}

// TAO's example jbearing2 prints -0.183437 for 8 by 12 points.
TEST(JournalBearing, HasTheObjectiveOfTaoOnARectangle) {
  const Problem problem = MakeJournalBearing(8, 12, 0.1);
  const Answer objective = ObjectiveAnswer(problem.lcp, -0.183437, 5e-7, "TAO jbearing2");
  EXPECT_NEAR(objective.measure(SolvedFromCoarse(problem)), objective.expected,
              objective.tolerance);
}

TEST(JournalBearing, StartsWithMostOfTheCavityOfTheFineGrid) {
  const Problem fine = Generate(JournalBearing(), 100, {0.1});
  const VectorXd start = fine.prolong(SolvedFromCoarse(fine.coarser()));
  const VectorXd x = Solved(fine, start);
  const auto wrong = ((start.array() <= 0) != (x.array() <= 0)).count();
  // One point at most on each of the 100 lines that cross the front of the film.
  EXPECT_LE(wrong, 100);
  EXPECT_GT((x.array() <= 0).count(), 3000);
}

struct Bearing {
  double eccentricity, rupture, peak;
};

/// By Gauss quadrature.
constexpr Bearing kBearings[] = {{0.1, 4.349748935194, 0.1330603948},
                                 {0.5, 3.834383928530, 0.7458313666},
                                 {0.8, 3.493687736812, 2.5223868772},
                                 {0.9, 3.371951576449, 6.4277238061}};

TEST(ReynoldsPressure, RupturesWhereQuadratureSays) {
  for (const Bearing& known : kBearings) {
    const ReynoldsPressure p(known.eccentricity);
    EXPECT_NEAR(p.rupture(), known.rupture, 5e-13);
    EXPECT_NEAR(p.Peak(), known.peak, 5e-11);
    EXPECT_EQ(p(0), 0);
    EXPECT_EQ(p(2 * std::numbers::pi), 0);
  }
}

// Simpson's rule on 4000 panels, whose error is far below 1e-9 for these films.
TEST(ReynoldsPressure, IsTheIntegralOfItsSlope) {
  for (const Bearing& known : kBearings) {
    const ReynoldsPressure p(known.eccentricity);
    const auto slope = [&](double t) {
      return (p.Film(t) - p.Film(p.rupture())) / std::pow(p.Film(t), 3);
    };
    for (const double t : {1.0, 3.0, std::numbers::pi, 3.3}) {
      const int panels = 4000;
      const double step = t / panels;
      double sum = 0;
      for (int k = 0; k < panels; ++k) {
        sum += slope(k * step) + 4 * slope((k + 0.5) * step) + slope((k + 1) * step);
      }
      EXPECT_NEAR(p(t), sum * step / 6, 1e-9 * known.peak);
    }
  }
}

TEST(InfiniteBearing, HasTheKnownRupturePeakAndPressure) {
  for (const Bearing& known : kBearings) {
    for (const int size : {15, 31, 100, 511}) {
      const Problem problem = Generate(InfiniteBearing(), size, {known.eccentricity});
      ExpectEveryAnswer(problem, SolvedFromCoarse(problem));
    }
  }
}

// The coefficient of dx^2 depends on where the rupture lies between two points, within a factor of
// 2.2 for e = 0.5: over five halvings an order of 2 may look like 2 - log2(2.2) / 5 = 1.77.
TEST(InfiniteBearing, IsOfSecondOrder) {
  const auto error = [](int size) {
    const Problem problem = Generate(InfiniteBearing(), size, {0.5});
    return Measured(problem, "largest error of the pressure", SolvedFromCoarse(problem));
  };
  EXPECT_GT(std::log2(error(31) / error(1023)) / 5, 1.77);
}

TEST(Slider, HasThePressureOfAPlaneWedge) {
  for (const double k : {0.01, 0.5, 1.0, 2.0, 10.0}) {
    for (const int size : {3, 40, 400}) {
      const Problem problem = Generate(Slider(), size, {k, 0, 3});
      ExpectEveryAnswer(problem, SolvedFromCoarse(problem));
    }
  }
}

// Nothing but dx^2 in the error of a smooth solution: the next term is dx^4.
TEST(Slider, IsOfSecondOrder) {
  const auto error = [](int size) {
    const Problem problem = Generate(Slider(), size, {1, 0, 3});
    return Measured(problem, "largest error of the pressure", SolvedFromCoarse(problem));
  };
  EXPECT_NEAR(std::log2(error(31) / error(255)) / 3, 2, 0.01);
}

TEST(Slider, CavitatesOnlyBehindHighWaves) {
  const auto dry = [](double waviness) {
    const Problem problem = Generate(Slider(), 200, {1, waviness, 3});
    EXPECT_EQ(problem.answers.empty(), waviness > 0);
    return (SolvedFromCoarse(problem).array() <= 0).count();
  };
  EXPECT_EQ(dry(0), 0);
  EXPECT_GT(dry(0.9), 0);
}

TEST(Obstacle, HasTheKnownMembraneAndContact) {
  for (const int size : {2, 5, 20, 63, 160}) {
    const Problem problem = Generate(Obstacle(), size, {});
    ExpectEveryAnswer(problem, SolvedFromCoarse(problem));
  }
}

// The coefficient of h^2 is 0.277 at 40 points and never seen above 0.44: over two halvings an
// order of 2 may look like 2 - log2(0.44 / 0.277) / 2 = 1.66.
TEST(Obstacle, IsOfSecondOrder) {
  const auto error = [](int size) {
    const Problem problem = Generate(Obstacle(), size, {});
    return Measured(problem, "largest error", SolvedFromCoarse(problem));
  };
  EXPECT_GT(std::log2(error(40) / error(160)) / 2, 1.66);
}

TEST(Obstacle, LiesOnTheBallAndNowhereBelow) {
  const Problem problem = Generate(Obstacle(), 50, {});
  const VectorXd u = SolvedFromCoarse(problem);
  EXPECT_TRUE((u.array() >= problem.lcp.lo.array()).all());
  const double h = 4.0 / 51, cells = std::numbers::pi * 0.698 * 0.698 / (h * h);
  EXPECT_NEAR(static_cast<double>((u.array() <= problem.lcp.lo.array()).count()) / cells, 1, 0.2);
}

TEST(TwoSidedObstacle, HasThePublishedObjectives) {
  for (const double upper : {0, 1}) {
    for (const int size : {2, 8, 21, 30}) {
      const Problem problem = Generate(TwoSidedObstacle(), size, {upper, 1});
      ExpectEveryAnswer(problem, SolvedFromCoarse(problem));
    }
  }
}

TEST(Torsion, HasThePublishedObjectives) {
  for (const double c : {5, 10, 20}) {
    for (const int size : {2, 8, 20}) {
      const Problem problem = Generate(Torsion(), size, {c});
      ExpectEveryAnswer(problem, SolvedFromCoarse(problem));
    }
  }
}

TEST(Answers, AreMissedByAWrongSolution) {
  const std::vector<Problem> problems = {
      Generate(JournalBearing(), 73, {0.1}),    Generate(InfiniteBearing(), 100, {0.5}),
      Generate(Slider(), 100, {1, 0, 3}),       Generate(Obstacle(), 40, {}),
      Generate(TwoSidedObstacle(), 73, {1, 1}), Generate(Torsion(), 72, {5})};
  for (const Problem& problem : problems) {
    const VectorXd x = SolvedFromCoarse(problem);
    ExpectEveryAnswer(problem, x);
    // One per cent of the largest value at all points, off the bounds.
    const VectorXd wrong = x.array() + 0.01 * x.lpNorm<Eigen::Infinity>();
    for (const Answer& known : problem.answers) {
      EXPECT_GT(std::abs(known.measure(wrong) - known.expected), known.tolerance)
          << problem.name << ", " << known.name;
    }
  }
}

}  // namespace
}  // namespace cairn::problems
