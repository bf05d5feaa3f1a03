// SPDX-License-Identifier: MIT
// Problems in matrix form made of bytes.
#include <algorithm>
#include <cmath>

#include "cairn/contact_problem.h"
#include "cairn/lcp/solver.h"
#include "tests/fuzz/contact_game.h"

namespace cairn::test {
namespace {

using lcp::BoxedLcp;
using lcp::MixedLcp;
using lcp::Report;
using lcp::Settings;
using lcp::Solver;
using lcp::Status;

using Matrix = Eigen::SparseMatrix<double>;

constexpr int kMostUnknowns = 9;

class MatrixMaker {
 public:
  explicit MatrixMaker(Choices* choices) : choices_(*choices), numbers_(choices) {}

  Settings MakeSettings() {
    Settings settings;
    settings.method = lcp::Method(choices_.Below(5));
    settings.order = lcp::SweepOrder(choices_.Below(5));
    settings.k_gs = 1 + choices_.Below(6);
    settings.k_sm = choices_.Below(4);
    settings.max_sweeps = choices_.Below(40);
    constexpr double kTolerances[] = {1e-9, 0, 1e-3, 1e-15};
    settings.tolerance = kTolerances[choices_.Below(4)];
    if (choices_.OneIn(3)) settings.budget = Budget::Work(choices_.Byte());
    settings.min_sweeps = choices_.Below(3);
    settings.threads = 1 + choices_.Below(2);
    settings.omega = 0.5 + choices_.Byte() / 200.0;
    settings.always_solve = choices_.Below(2) == 1;
    if (choices_.OneIn(8)) settings.active_tolerance = numbers_.Positive();
    return settings;
  }

  /// B' B and something on the diagonal, and entries that are stored for nothing, or on one side.
  Matrix MakeMatrix(int n) {
    Eigen::MatrixXd root = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) root(i, j) = choices_.OneIn(3) ? numbers_.Real() : 0;
    }
    Eigen::MatrixXd dense = root.transpose() * root;
    for (int i = 0; i < n; ++i) dense(i, i) += choices_.OneIn(8) ? numbers_.Real() : 1;
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const bool stored = dense(i, j) != 0 || choices_.OneIn(8);
        if (stored) entries.emplace_back(i, j, dense(i, j));
      }
    }
    Matrix matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    if (choices_.OneIn(8)) matrix.uncompress();
    return matrix;
  }

  Eigen::VectorXd MakeVector(int n) {
    Eigen::VectorXd vector(n);
    for (double& number : vector) number = numbers_.Real();
    return vector;
  }

  BoxedLcp MakeBoxed() {
    const int n = choices_.Below(kMostUnknowns);
    BoxedLcp problem;
    problem.M = MakeMatrix(n);
    problem.q = MakeVector(n);
    const Eigen::VectorXd first = MakeVector(n), second = MakeVector(n);
    problem.lo = first.cwiseMin(second);
    problem.hi = first.cwiseMax(second);
    for (int i = 0; i < n; ++i) {
      if (choices_.OneIn(3)) problem.lo[i] = -kInfinity;
      if (choices_.OneIn(2)) problem.hi[i] = kInfinity;
    }
    if (n > 0 && choices_.OneIn(32)) problem.lo.conservativeResize(n - 1);
    return problem;
  }

  MixedLcp MakeMixed() {
    const int n_a = choices_.Below(4), n_b = choices_.Below(4);
    const Matrix whole = MakeMatrix(n_a + n_b);
    MixedLcp problem;
    problem.A = whole.topLeftCorner(n_a, n_a);
    problem.B = whole.bottomRightCorner(n_b, n_b);
    problem.C = whole.topRightCorner(n_a, n_b);
    problem.a = MakeVector(n_a);
    problem.b = MakeVector(n_b);
    return problem;
  }

 private:
  Choices& choices_;
  Numbers numbers_;
};

/// To the bit, or both are no numbers.
bool SameBits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (a.size() != b.size()) return false;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (a[i] != b[i] && !(std::isnan(a[i]) && std::isnan(b[i]))) return false;
  }
  return true;
}

std::string Check(const BoxedLcp& problem, const Eigen::VectorXd& start, const Eigen::VectorXd& x,
                  const Report& report) {
  const Status judged = Validate(problem).status;
  const bool usable = report.ok() || report.status == Status::kNotPositiveDefinite;
  if (judged != Status::kOk && usable) return "solved what Validate() refuses";
  if (!usable) return SameBits(x, start) ? "" : "refused, and x touched";
  if (!x.allFinite()) return "ok, and not finite";
  if ((x.array() < problem.lo.array()).any() || (x.array() > problem.hi.array()).any()) {
    return "x is outside its box";
  }
  const lcp::LcpResidual measured = Measure(problem, x);
  const bool same = report.residual_relative == measured.relative &&
                    report.residual_max == measured.max && std::isfinite(measured.relative);
  return same ? "" : "the residual is not what Measure() says";
}

}  // namespace

std::string SolveMatrix(std::span<const std::uint8_t> bytes) {
  Choices choices(bytes);
  MatrixMaker maker(&choices);
  Solver solver(maker.MakeSettings());
  for (int problem = 0; problem < 3 && !(problem > 0 && choices.empty()); ++problem) {
    if (choices.OneIn(4)) {
      const MixedLcp mixed = maker.MakeMixed();
      Eigen::VectorXd u = maker.MakeVector(static_cast<int>(mixed.a.size()));
      Eigen::VectorXd v = maker.MakeVector(static_cast<int>(mixed.b.size()));
      Eigen::VectorXd start(u.size() + v.size()), x(start.size());
      start << u, v;
      const Report report = solver.Solve(mixed, &u, &v);
      x << u, v;
      if (std::string broken = Check(ToBoxed(mixed), start, x, report); !broken.empty()) {
        return broken + " (mixed)";
      }
      continue;
    }
    const BoxedLcp boxed = maker.MakeBoxed();
    const Eigen::VectorXd start = maker.MakeVector(static_cast<int>(boxed.size()));
    Eigen::VectorXd x = start;
    const Report report = solver.Solve(boxed, &x);
    if (std::string broken = Check(boxed, start, x, report); !broken.empty()) return broken;
    solver.settings() = maker.MakeSettings();
  }
  return "";
}

}  // namespace cairn::test
