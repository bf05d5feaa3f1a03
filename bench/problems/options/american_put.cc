// SPDX-License-Identifier: MIT
// The American put in the variables of Wilmott, Dewynne and Howison: x = ln(S / K),
// tau = sigma^2 (T - t) / 2, k1 = 2 r / sigma^2, k2 = 2 (r - q) / sigma^2 and
//   V = K exp(-(k2 - 1) x / 2 - ((k2 - 1)^2 / 4 + k1) tau) u(x, tau),   u_tau = u_xx,
// with the obstacle exp((k2 - 1) x / 2 + ((k2 - 1)^2 / 4 + k1) tau) max(1 - e^x, 0).
#include "problems/generators.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "problems/options/option_formulas.h"
#include "problems/options/option_march.h"
#include "problems/options/option_oracles.h"

namespace cairn::problems {
namespace {

/// The parameters of the generators, in their order.
struct PutCase {
  double spot, strike, rate, dividend, sigma, maturity;

  bool operator==(const PutCase&) const = default;
};

struct KnownPrice {
  PutCase put;
  double price, rounding;
  const char* source;
};

constexpr const char* kAlo =
    "Andersen, Lake, Offengenden, J. Comput. Finance 20 (2016), table 2, and the European price";
constexpr const char* kFine = "finite differences, 6000 to 8000 points";
constexpr const char* kClassic = "the 27 American puts of Geske and Johnson, by finite differences";

constexpr KnownPrice Fine(double spot, double sigma, double maturity, double price) {
  return {{spot, 40, 0.06, 0, sigma, maturity}, price, 1e-4, kFine};
}

constexpr KnownPrice Classic(double sigma, double strike, double maturity, double price) {
  return {{40, strike, 0.0488, 0, sigma, maturity}, price, 1e-4, kClassic};
}

constexpr std::array kKnownPrices = {
    KnownPrice{{100, 100, 0.05, 0.05, 0.25, 1}, 9.569445299, 1e-9, kAlo},
    Fine(36, 0.2, 1, 4.4867),
    Fine(36, 0.2, 2, 4.8483),
    Fine(36, 0.4, 1, 7.1090),
    Fine(36, 0.4, 2, 8.5142),
    Fine(38, 0.2, 1, 3.2572),
    Fine(38, 0.2, 2, 3.7514),
    Fine(38, 0.4, 1, 6.1546),
    Fine(38, 0.4, 2, 7.6749),
    Fine(40, 0.2, 1, 2.3196),
    Fine(40, 0.2, 2, 2.8899),
    Fine(40, 0.4, 1, 5.3183),
    Fine(40, 0.4, 2, 6.9234),
    Fine(42, 0.2, 1, 1.6211),
    Fine(42, 0.2, 2, 2.2167),
    Fine(42, 0.4, 1, 4.5881),
    Fine(42, 0.4, 2, 6.2502),
    Fine(44, 0.2, 1, 1.1130),
    Fine(44, 0.2, 2, 1.6933),
    Fine(44, 0.4, 1, 3.9528),
    Fine(44, 0.4, 2, 5.6467),
    Classic(0.2, 45, 0.5833, 5.2670),
    Classic(0.3, 40, 0.3333, 2.4825),
    Classic(0.4, 35, 0.5833, 2.1549),
    Classic(0.4, 45, 0.5833, 7.3830),
    KnownPrice{{100, 100, 0.05, 0, 0.2, 1}, 6.0904, 1e-4, kFine},
    KnownPrice{{90, 100, 0.05, 0, 0.2, 1}, 11.4927, 1e-4, kFine},
    KnownPrice{{110, 100, 0.05, 0, 0.2, 1}, 2.9865, 1e-4, kFine},
};

/// Nodes x = (i - left) h of the log price, i = 0..intervals, the first and last on the boundary;
/// the strike is node `left`.
struct LogGrid {
  int intervals, left;
  double h;

  double x(int i) const { return (i - left) * h; }
};

/// Six standard deviations and a half to each side of strike and spot, and the spot on a node as
/// well, unless it is closer to the strike than a node.
LogGrid MakeGrid(const PutCase& put, int intervals) {
  const double apart = std::abs(std::log(put.spot / put.strike));
  const double half = 6 * put.sigma * std::sqrt(put.maturity) + 0.5 + apart;
  const double h = 2 * half / intervals, nodes_apart = std::floor(apart / h);
  return {intervals, intervals / 2, nodes_apart > 0 ? apart / nodes_apart : h};
}

class PutModel {
 public:
  PutModel(const PutCase& put, int intervals)
      : put_(put),
        grid_(MakeGrid(put, intervals)),
        k1_(2 * put.rate / (put.sigma * put.sigma)),
        k2_(2 * (put.rate - put.dividend) / (put.sigma * put.sigma)) {}

  OptionModel Make(int steps) const {
    OptionModel model;
    model.name = "american-put-" + std::to_string(grid_.intervals);
    model.source = "Black-Scholes equation as a heat equation, Crank-Nicolson";
    model.A = Matrix();
    model.end = End();
    model.steps = steps;
    model.growth = Growth();
    model.payoff = Eigen::VectorXd(Size());
    for (int i = 0; i < Size(); ++i) {
      const double x = grid_.x(i + 1);
      model.payoff[i] = Scale(x, 0) * std::max(1 - std::exp(x), 0.0);
    }
    model.initial = model.payoff;
    model.boundary = [self = *this](double tau) { return self.Boundary(tau); };
    model.answers = Answers(steps);
    return model;
  }

 private:
  int Size() const { return grid_.intervals - 1; }
  double End() const { return put_.sigma * put_.sigma * put_.maturity / 2; }
  double Growth() const { return (k2_ - 1) * (k2_ - 1) / 4 + k1_; }
  /// u over V / K.
  double Scale(double x, double tau) const { return std::exp((k2_ - 1) * x / 2 + Growth() * tau); }

  Eigen::SparseMatrix<double> Matrix() const {
    const double entry = 1 / (grid_.h * grid_.h);
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < Size(); ++i) {
      entries.emplace_back(i, i, 2 * entry);
      if (i > 0) {
        entries.emplace_back(i, i - 1, -entry);
        entries.emplace_back(i - 1, i, -entry);
      }
    }
    Eigen::SparseMatrix<double> A(Size(), Size());
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
  }

  /// Cheap assets are sold for the strike, at once or at maturity; dear ones never.
  Eigen::VectorXd Boundary(double tau) const {
    const double x = grid_.x(0), years = 2 * tau / (put_.sigma * put_.sigma);
    const double wait = std::exp(-put_.rate * years) - std::exp(x - put_.dividend * years);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(Size());
    b[0] = Scale(x, tau) * std::max(1 - std::exp(x), wait) / (grid_.h * grid_.h);
    return b;
  }

  /// From the cubic through four nodes around the spot: on a node, the value there.
  double Price(const Eigen::VectorXd& u) const {
    const double x = std::log(put_.spot / put_.strike);
    const int first = static_cast<int>(std::floor(x / grid_.h + 1e-6)) + grid_.left - 1;
    double price = 0;
    for (int i = first; i < first + 4; ++i) {
      double weight = 1;
      for (int j = first; j < first + 4; ++j) {
        if (j != i) weight *= (x - grid_.x(j)) / (grid_.x(i) - grid_.x(j));
      }
      price += weight * u[i - 1];
    }
    return put_.strike * price / Scale(x, End());
  }

  /// Most that Price() may be off. Over all known prices, 11 grids from 50 intervals and 4 steps to
  /// 6000 intervals and 250 steps had at most 0.055 strikes times the two terms in brackets. The
  /// order in time is 3/2 because the exercise boundary starts like sqrt(tau).
  double ErrorBound(int steps) const {
    const double deviation = put_.sigma * std::sqrt(put_.maturity);
    return 0.1 * put_.strike * (grid_.h * grid_.h / deviation + deviation / std::pow(steps, 1.5));
  }

  std::vector<Answer> Answers(int steps) const {
    const auto known = std::find_if(kKnownPrices.begin(), kKnownPrices.end(),
                                    [&](const KnownPrice& price) { return price.put == put_; });
    if (known == kKnownPrices.end()) return {};
    return {{.name = "price",
             .source = known->source,
             .expected = known->price,
             .tolerance = ErrorBound(steps) + known->rounding,
             .measure = [self = *this](const Eigen::VectorXd& u) { return self.Price(u); }}};
  }

  PutCase put_;
  LogGrid grid_;
  double k1_, k2_;
};

constexpr size_t kSteps = 6;  // of the parameters

std::vector<Parameter> Parameters(int steps) {
  return {{"spot", "price of the asset today", 100, 10, 1000},
          {"strike", "what the put sells it for", 100, 10, 1000},
          {"rate", "risk-free interest per year", 0.05, 0, 0.2},
          {"dividend", "dividends per year, of the price", 0.05, 0, 0.2},
          {"sigma", "volatility per year", 0.25, 0.1, 1},
          {"maturity", "years", 1, 0.05, 5},
          {"steps", "time steps", double(steps), 4, 20000}};
}

OptionMarch MakeMarch(int size, const std::vector<double>& values) {
  const PutCase put = {values[0], values[1], values[2], values[3], values[4], values[5]};
  return OptionMarch(PutModel(put, size).Make(static_cast<int>(values[kSteps])));
}

}  // namespace

Generator AmericanPut() {
  return {.name = "american-put",
          .help = "An American put, one complementarity problem for each time step",
          .size_help = "intervals of the log price",
          .size = 4000,
          .min_size = 50,
          .max_size = 100000,
          .parameters = Parameters(2000),
          .make = [](int size, const std::vector<double>& values) -> std::unique_ptr<Source> {
            return std::make_unique<OptionMarch>(MakeMarch(size, values));
          }};
}

Generator AmericanPutStep() {
  return {.name = "american-put-step",
          .help = "One large time step in the middle of an American put, with its solution",
          .size_help = "intervals of the log price",
          .size = 4000,
          .min_size = 50,
          .max_size = 100000,
          .parameters = Parameters(50),
          .make = [](int size, const std::vector<double>& values) -> std::unique_ptr<Source> {
            return std::make_unique<SingleProblem>(
                MiddleStep(MakeMarch(size, values), "american-put-step-" + std::to_string(size),
                           [](const Problem& step) { return BrennanSchwartz(step.lcp); }));
          }};
}

}  // namespace cairn::problems
