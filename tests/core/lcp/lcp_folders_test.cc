// SPDX-License-Identifier: MIT
// Problems of other people with certified solutions, where they are present: open/ in
// CAIRN_PROBLEMS or in ../shared/problems beside the repository.
#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "problems/problem_folder.h"
#include "tests/core/support/lcp_problems.h"

namespace cairn::lcp {
namespace {

namespace fs = std::filesystem;
using Eigen::VectorXd;

fs::path OpenProblems() {
  const char* set = std::getenv("CAIRN_PROBLEMS");
  return (set != nullptr ? fs::path(set) : fs::path(CAIRN_SOURCE_DIR) / "../shared/problems") /
         "open";
}

/// Those in matrix form that have a certified solution.
std::vector<fs::path> Folders() {
  std::vector<fs::path> folders;
  if (!fs::is_directory(OpenProblems())) return folders;
  for (const fs::path& folder : problems::ProblemFoldersIn(OpenProblems())) {
    if (problems::ReadKind(folder) != "friction") folders.push_back(folder);
  }
  return folders;
}

class CertifiedProblem : public testing::TestWithParam<fs::path> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(CertifiedProblem);

// Both x and the certified solution are as near to the law as their residuals say, which bounds how
// far their w can be apart (lcp_problems.h), also where the matrix is singular and x not unique.
TEST_P(CertifiedProblem, HasItsCertifiedSlack) {
  const problems::Problem problem = problems::ReadProblemFolder(GetParam());
  const VectorXd certified = problems::ReadVector(GetParam() / "solution.mtx");
  const LcpResidual truth = Measure(problem.lcp, certified);
  // certified in long double: at most 1e-10 there, and rounding of double on top
  ASSERT_LE(truth.energy, 1e-10 * test::EnergyOfW(problem.lcp, problem.lcp.q) +
                              test::RoundingOfW(problem.lcp, certified));
  const double most = test::MostOfScaledSpectrum(problem.lcp);

  for (const Method method : {Method::kPgsSm, Method::kInteriorPoint}) {
    SCOPED_TRACE(static_cast<int>(method));
    Settings settings = test::Until(method, 1e-9);
    settings.max_sweeps = 1000;
    const test::LcpSolution s = test::Solve(settings, problem.lcp);
    ASSERT_TRUE(s.report.ok());
    EXPECT_TRUE(test::InsideBox(problem.lcp, s.x));
    const LcpResidual reached = Measure(problem.lcp, s.x);
    EXPECT_LE(reached.relative, 1e-8);
    EXPECT_EQ(s.report.residual_relative, reached.relative);

    const double rounding =
        test::RoundingOfW(problem.lcp, s.x) + test::RoundingOfW(problem.lcp, certified);
    const double residuals = reached.energy + truth.energy + rounding;
    const double x_apart = test::EnergyOfX(problem.lcp, s.x - certified);
    const VectorXd w = problem.lcp.M * s.x + problem.lcp.q;
    EXPECT_LE(test::EnergyOfW(problem.lcp, w - problem.slack),
              test::MostApartInW(most, residuals, x_apart) + rounding);
  }
}

std::string NameOf(const testing::TestParamInfo<fs::path>& info) {
  std::string name = info.param.filename().string();
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Open, CertifiedProblem, testing::ValuesIn(Folders()), NameOf);

// gtest has no test to skip where there are no parameters.
TEST(CertifiedProblems, ArePresent) {
  if (Folders().empty()) GTEST_SKIP() << OpenProblems() << " is not there; set CAIRN_PROBLEMS";
  EXPECT_GE(Folders().size(), 50u);
}

}  // namespace
}  // namespace cairn::lcp
