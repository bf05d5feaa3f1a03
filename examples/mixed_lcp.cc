// SPDX-License-Identifier: MIT
// A mixed LCP in matrix form: what a researcher or another engine hands over.

// [program]
#include <cairn/lcp/solver.h>

#include <cstdio>
#include <string>

int main() {
  // A u + C v + a = 0,  C' u + B v + b >= 0,  v >= 0,  and one of the two is 0 in each row:
  // a joint (u) between two bodies, and two contacts (v) of which one carries and one lifts.
  cairn::lcp::MixedLcp problem;
  problem.A = Eigen::MatrixXd{{2}}.sparseView();
  problem.C = Eigen::MatrixXd{{-1, 1}}.sparseView();
  problem.B = Eigen::MatrixXd{{2, 0}, {0, 2}}.sparseView();
  problem.a = Eigen::VectorXd{{1}};
  problem.b = Eigen::VectorXd{{-5, 3}};

  cairn::lcp::Solver solver({.method = cairn::lcp::Method::kPgsSm, .tolerance = 1e-10});
  Eigen::VectorXd u = Eigen::VectorXd::Zero(1), v = Eigen::VectorXd::Zero(2);  // or the last answer
  const cairn::lcp::Report report = solver.Solve(problem, &u, &v);
  if (!report.ok()) return 1;

  std::printf("u = %.3f, v = (%.3f, %.3f), %d factorisation, %s\n", u[0], v[0], v[1],
              report.factorisations, std::string(Describe(report.stop)).c_str());
}
// [/program]
