// SPDX-License-Identifier: MIT
// Options as marches of complementarity problems: prices, orders, single steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "cairn/lcp/solver.h"
#include "problems/generators.h"
#include "problems/options/option_oracles.h"

namespace cairn::problems {
namespace {

using Values = std::vector<double>;
using NamedValues = std::vector<std::pair<const char*, double>>;

Values With(const Generator& generator, const NamedValues& changes) {
  Values values;
  for (const Parameter& parameter : generator.parameters) values.push_back(parameter.value);
  for (const auto& [name, value] : changes) {
    size_t i = 0;
    while (i < values.size() && generator.parameters[i].name != name) ++i;
    if (i == values.size()) {
      ADD_FAILURE() << generator.name << " has no parameter " << name;
    } else {
      values[i] = value;
    }
  }
  return values;
}

struct Priced {
  double price = 0, expected = 0, tolerance = 0;

  double error() const { return price - expected; }
};

/// The price at the end of a march that `solve_step` is asked to solve.
template <class SolveStep>
Priced MarchWith(const SolveStep& solve_step, const Generator& generator, int size,
                 const Values& values) {
  const std::unique_ptr<Source> source = generator.make(size, values);
  Eigen::VectorXd y;
  int steps = 0;
  do {
    EXPECT_TRUE(source->current().answers.empty() || steps + 1 == source->steps());
    y = solve_step(source->current());
    ++steps;
  } while (source->Advance(y));
  EXPECT_EQ(steps, source->steps());
  if (source->current().answers.size() != 1) {
    ADD_FAILURE() << generator.name << " has no price";
    return {};
  }
  const Answer& answer = source->current().answers[0];
  return {answer.measure(y), answer.expected, answer.tolerance};
}

Eigen::VectorXd Eliminate(const Problem& step) { return BrennanSchwartz(step.lcp); }

Priced PutPrice(int size, const NamedValues& changes) {
  const Generator generator = AmericanPut();
  return MarchWith(Eliminate, generator, size, With(generator, changes));
}

Priced PairPrice(const Generator& generator, int size, const NamedValues& changes) {
  return MarchWith(RelaxToRounding, generator, size, With(generator, changes));
}

Priced PriceOfCairn(const Generator& generator, int size, const NamedValues& changes) {
  lcp::Solver solver({.method = lcp::Method::kPgsSm, .tolerance = 1e-9});
  const auto solve_step = [&solver](const Problem& step) {
    Eigen::VectorXd y = step.start;
    const lcp::Report report = solver.Solve(step.lcp, &y);
    EXPECT_TRUE(report.ok()) << Describe(report.status);
    EXPECT_EQ(report.stop, lcp::StopReason::kConverged);
    return y;
  };
  return MarchWith(solve_step, generator, size, With(generator, changes));
}

double Order(double coarse_error, double fine_error) {
  return std::log2(std::abs(coarse_error / fine_error));
}

/// The order seen on three grids, each of half the spacing of the one before.
double Order(double coarse, double middle, double fine) {
  return Order(middle - coarse, fine - middle);
}

/// Small problems of every kind, at the first and the last step and at the ends of all parameters.
class OptionGenerators : public testing::TestWithParam<Generator> {
 public:
  /// Combination `bits` of the ends of the parameters; few steps.
  static Values Corner(const Generator& generator, unsigned bits) {
    Values values;
    for (const Parameter& parameter : generator.parameters) {
      const bool high = bits & 1;
      values.push_back(high ? parameter.max : parameter.min);
      if (parameter.name == "steps") values.back() = high ? 9 : 4;
      bits >>= 1;
    }
    return values;
  }
};

void ExpectMMatrix(const Eigen::SparseMatrix<double>& M) {
  const Eigen::SparseMatrix<double> transposed = M.transpose();
  EXPECT_EQ((M - transposed).norm(), 0);
  for (Eigen::Index i = 0; i < M.outerSize(); ++i) {
    double diagonal = 0, rest = 0;
    for (Eigen::SparseMatrix<double>::InnerIterator entry(M, i); entry; ++entry) {
      if (entry.row() == i) {
        diagonal = entry.value();
      } else {
        EXPECT_LT(entry.value(), 0);
        rest -= entry.value();
      }
    }
    EXPECT_GT(diagonal, rest) << "row " << i;
  }
}

TEST_P(OptionGenerators, MakeSymmetricMMatrices) {
  const std::unique_ptr<Source> source =
      GetParam().make(GetParam().min_size, With(GetParam(), {{"steps", 5}}));
  do {
    ExpectMMatrix(source->current().lcp.M);
  } while (source->Advance(source->current().start));
}

TEST_P(OptionGenerators, MakeProblemsThatPassValidationAtTheEndsOfAllParameters) {
  const unsigned corners = 1u << GetParam().parameters.size();
  // An odd stride reaches both ends of every parameter.
  for (unsigned bits = 0; bits < corners; bits += corners / 32 + 1) {
    const std::unique_ptr<Source> source =
        GetParam().make(GetParam().min_size, Corner(GetParam(), bits));
    do {
      const Problem& step = source->current();
      ASSERT_TRUE(Validate(step.lcp).ok()) << GetParam().name << ", " << bits;
      ASSERT_EQ(step.start.size(), step.lcp.size());
      ASSERT_TRUE((step.start.array() >= step.lcp.lo.array()).all());
      if (step.answers.empty()) continue;
      ASSERT_TRUE(std::isfinite(step.answers[0].measure(step.start)));
    } while (source->Advance(source->current().start));
  }
}

INSTANTIATE_TEST_SUITE_P(All, OptionGenerators,
                         testing::Values(AmericanPut(), AmericanPutStep(), PutOnMin(),
                                         PutOnAverage(), PutOnMinStep()),
                         [](const auto& instance) {
                           std::string name = instance.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(BrennanSchwartz, SolvesEveryStepToRounding) {
  const Generator generator = AmericanPut();
  for (const double rate : {0.01, 0.05, 0.2}) {
    const std::unique_ptr<Source> source =
        generator.make(400, With(generator, {{"rate", rate}, {"steps", 50}, {"spot", 90}}));
    Eigen::VectorXd y;
    do {
      y = BrennanSchwartz(source->current().lcp);
      const LcpResidual residual = Measure(source->current().lcp, y);
      EXPECT_LE(residual.relative, 1e-14);  // alpha 20 times rounding; 1e-15 was seen
      EXPECT_EQ(residual.violation, 0);
    } while (source->Advance(y));
  }
}

TEST(RelaxToRounding, AgreesWithBrennanAndSchwartz) {
  const Generator generator = AmericanPutStep();
  Problem step = generator.make(200, With(generator, {}))->current();
  const Eigen::VectorXd relaxed = RelaxToRounding(step);
  // condition number times rounding
  EXPECT_LE((relaxed - step.solution).lpNorm<Eigen::Infinity>(),
            1e-12 * step.solution.lpNorm<Eigen::Infinity>());
}

void ExpectSolved(const Problem& step) {
  // alpha 600 times rounding; 6e-14 was seen
  EXPECT_LE(Measure(step.lcp, step.solution).relative, 3e-13) << step.name;
  EXPECT_EQ((step.lcp.M * step.solution + step.lcp.q - step.slack).norm(), 0) << step.name;
  const auto active = (step.solution.array() == 0).count();
  // Both kinds of rows, so that there is something to find out.
  EXPECT_GT(active, step.lcp.size() / 50) << step.name;
  EXPECT_LT(active, step.lcp.size() * 49 / 50) << step.name;
}

TEST(OptionSteps, ComeWithTheirSolution) {
  const Generator one = AmericanPutStep(), two = PutOnMinStep();
  ExpectSolved(one.make(4000, With(one, {}))->current());
  ExpectSolved(two.make(100, With(two, {}))->current());
}

// alpha = dtau / h^2 is up to 1000 in practice.
TEST(OptionSteps, AreLarge) {
  const Generator one = AmericanPutStep();
  EXPECT_GT(one.make(4000, With(one, {}))->current().lcp.M.coeff(0, 0), 500);
}

struct QuotedPut {
  double spot, strike, rate, dividend, sigma, maturity;
};

// One of each source of prices.
TEST(AmericanPut, HasItsPublishedPrices) {
  for (const QuotedPut& put :
       {QuotedPut{100, 100, 0.05, 0.05, 0.25, 1}, QuotedPut{36, 40, 0.06, 0, 0.4, 1},
        QuotedPut{38, 40, 0.06, 0, 0.2, 2}, QuotedPut{44, 40, 0.06, 0, 0.4, 1},
        QuotedPut{40, 35, 0.0488, 0, 0.4, 0.5833}, QuotedPut{90, 100, 0.05, 0, 0.2, 1},
        QuotedPut{110, 100, 0.05, 0, 0.2, 1}}) {
    for (const auto& [size, steps] : {std::pair{50, 4}, {101, 1000}, {2000, 1000}}) {
      const Priced priced = PutPrice(size, {{"spot", put.spot},
                                            {"strike", put.strike},
                                            {"rate", put.rate},
                                            {"dividend", put.dividend},
                                            {"sigma", put.sigma},
                                            {"maturity", put.maturity},
                                            {"steps", double(steps)}});
      EXPECT_NEAR(priced.price, priced.expected, priced.tolerance)
          << put.spot << ", " << put.sigma << ", " << size;
    }
  }
}

// The price that this scheme is known to give on 8000 x 4000, to the digits that are known of it.
TEST(AmericanPut, Costs9569438OnTheFineGrid) {
  EXPECT_NEAR(PutPrice(8000, {{"steps", 4000}}).price, 9.569438, 5e-7);
}

TEST(AmericanPut, ConvergesWithOrderTwoInSpace) {
  const auto price = [](int size) { return PutPrice(size, {{"steps", 500}}).price; };
  EXPECT_NEAR(Order(price(250), price(500), price(1000)), 2, 0.1);
  EXPECT_NEAR(Order(price(500), price(1000), price(2000)), 2, 0.1);
}

TEST(AmericanPut, ConvergesWithOrderThreeHalvesInTime) {
  const auto price = [](int steps) { return PutPrice(2000, {{"steps", double(steps)}}).price; };
  EXPECT_NEAR(Order(price(50), price(100), price(200)), 1.5, 0.15);
}

TEST(AmericanPut, HasNoAnswerThatNobodyKnows) {
  const Generator generator = AmericanPut();
  const std::unique_ptr<Source> source =
      generator.make(50, With(generator, {{"spot", 101}, {"steps", 4}}));
  while (source->Advance(source->current().start)) {
  }
  EXPECT_TRUE(source->current().answers.empty());
}

// Measured: 2.08 here, 2.02 and 1.99 up to 400 points.
TEST(PutOnMin, ConvergesToStulzWithOrderTwo) {
  const auto error = [](int size) {
    return PairPrice(PutOnMin(), size, {{"exercise", 0}, {"steps", size / 2.0}}).error();
  };
  EXPECT_NEAR(Order(error(50), error(100)), 2, 0.2);
}

// Measured: 2.13 here, 2.04 and 1.98 up to 400 points.
TEST(PutOnAverage, ConvergesToItsIntegralWithOrderTwo) {
  const auto error = [](int size) {
    return PairPrice(PutOnAverage(), size, {{"exercise", 0}, {"steps", size / 2.0}}).error();
  };
  EXPECT_NEAR(Order(error(50), error(100)), 2, 0.2);
}

TEST(EuropeanPairs, KeepTheirErrorBoundsWithAnyParameters) {
  std::mt19937 random(3);
  for (int i = 0; i < 60; ++i) {
    const Generator generator = i % 2 == 0 ? PutOnMin() : PutOnAverage();
    Values values;
    for (const Parameter& parameter : generator.parameters) {
      std::uniform_real_distribution<double> any(parameter.min, parameter.max);
      // a third of them at the ends
      values.push_back(i % 3 > 0                  ? any(random)
                       : i & (1 << values.size()) ? parameter.max
                                                  : parameter.min);
      if (parameter.name.starts_with("s") && parameter.max == 1000) values.back() = 100;
      if (parameter.name == "steps") values.back() = 4 + i;
      if (parameter.name == "exercise") values.back() = 0;
    }
    const Priced priced = MarchWith(RelaxToRounding, generator, 50, values);
    EXPECT_NEAR(priced.price, priced.expected, priced.tolerance) << generator.name << ", " << i;
  }
}

// Measured order: 1.8 for these grids, 1.9 for finer ones. Space alone, as 100 steps of the
// quadratic time grid are off by less than 1e-4.
TEST(PutOnMin, ConvergesWithOrderNearTwoIfAmerican) {
  const auto price = [](int size) { return PairPrice(PutOnMin(), size, {}); };
  const Priced coarse = price(50), middle = price(100), fine = price(200);
  EXPECT_NEAR(Order(coarse.price, middle.price, fine.price), 1.9, 0.2);
  EXPECT_NEAR(Order(coarse.error(), middle.error()), 1.9, 0.2);
  EXPECT_NEAR(Order(middle.error(), fine.error()), 1.9, 0.2);
  for (const Priced& priced : {coarse, middle, fine}) {
    EXPECT_NEAR(priced.price, priced.expected, priced.tolerance);
  }
}

TEST(PutOnAverage, ConvergesWithOrderNearTwoIfAmerican) {
  const auto price = [](int size) { return PairPrice(PutOnAverage(), size, {}); };
  const Priced coarse = price(50), fine = price(100);
  EXPECT_NEAR(Order(coarse.error(), fine.error()), 1.9, 0.2);
  EXPECT_NEAR(fine.price, fine.expected, fine.tolerance);
}

TEST(CairnSolver, PricesTheAmericanPut) {
  const Priced cairn = PriceOfCairn(AmericanPut(), 500, {{"steps", 100}});
  EXPECT_NEAR(cairn.price, cairn.expected, cairn.tolerance);
  EXPECT_NEAR(cairn.price, PutPrice(500, {{"steps", 100}}).price, 1e-7);
}

TEST(CairnSolver, PricesBothPutsOnTwoAssets) {
  for (const Generator& generator : {PutOnMin(), PutOnAverage()}) {
    for (const double exercise : {0, 1}) {
      const NamedValues changes = {{"exercise", exercise}, {"steps", 20}};
      const Priced cairn = PriceOfCairn(generator, 60, changes);
      EXPECT_NEAR(cairn.price, cairn.expected, cairn.tolerance);
      EXPECT_NEAR(cairn.price, PairPrice(generator, 60, changes).price, 1e-7);
    }
  }
}

}  // namespace
}  // namespace cairn::problems
