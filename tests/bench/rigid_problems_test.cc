// SPDX-License-Identifier: MIT
// The castle in matrix form: against dense matrices, Measure() and factorisations of Eigen's.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cairn/detail/eigen.h"
#include "cairn/lcp/solver.h"
#include "cairn/solver.h"
#include "rigid/castle.h"
#include "rigid/condition.h"
#include "rigid/contact_matrix.h"
#include "rigid/contact_model.h"
#include "rigid/envelope_cholesky.h"
#include "rigid/nearest_rows.h"
#include "rigid/rigid_list.h"
#include "tests/core/support/dense.h"
#include "tests/core/support/problems.h"

namespace cairn::bench {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr ContactModel kModels[] = {ContactModel::kNormals, ContactModel::kBilateral,
                                    ContactModel::kPyramid};

/// Contacts and pins in all directions, with everything that a body and a row can have.
ContactFrame RandomFrame(std::uint64_t seed) {
  test::Scene scene = test::RandomPile({.bodies = 12, .contacts = 25, .pins = 4}, seed);
  scene.bodies[3].linear_factor = {1, 0, 0.5};
  scene.bodies[4].inv_mass = 0;  // turns about a fixed point
  View(scene.bodies[5].inv_inertia).setZero();
  ContactFrame frame{.bodies = scene.bodies, .rows = {}, .impulses = {}};
  // Kinematic: moves, and cannot be pushed
  frame.bodies[6].inv_mass = 0;
  View(frame.bodies[6].inv_inertia).setZero();
  test::Random random(seed);
  for (Row& row : scene.rows) row.compliance = random.Uniform(0, 0.1);
  frame.rows = scene.rows;
  for (size_t i = 0; i < frame.rows.size(); ++i) frame.impulses.push_back(random.Uniform(-1, 3));
  return frame;
}

/// Bricks and half of their friction rows. In frame 0 all but the lowest fall alike, and q is 0.
ContactFrame SmallCastle(int contacts) {
  return NearestRows(CastleFrame(1), {.contacts = contacts, .frictions = contacts});
}

/// Shared by the tests of one process: Bullet takes a second to get there.
const ContactFrame& ImpactFrame() {
  static const ContactFrame frame = CastleFrame(kImpactFrame);
  return frame;
}

Sparse RandomMatrix(int n, double diagonal, std::uint64_t seed) {
  test::Random random(seed);
  MatrixXd root = MatrixXd::Zero(n, n);
  for (int k = 0; k < 3 * n; ++k) root(random.Index(n), random.Index(n)) = random.Uniform(-1, 1);
  const MatrixXd dense = root * root.transpose() + diagonal * MatrixXd::Identity(n, n);
  return dense.sparseView();
}

bool PositiveDefinite(const Sparse& matrix) {
  return Eigen::SimplicialLLT<Sparse>(matrix).info() == Eigen::Success;
}

Sparse Shifted(const Sparse& matrix, double factor, double shift) {
  Sparse identity(matrix.rows(), matrix.cols());
  identity.setIdentity();
  return factor * matrix + shift * identity;
}

/// Whether both ends of the spectrum are within the relative `error`, by inertia: A - m I is
/// positive definite exactly if m is below every eigenvalue.
void ExpectEndsOfSpectrum(const Sparse& matrix, const Spectrum& ends, double error) {
  EXPECT_TRUE(PositiveDefinite(Shifted(matrix, 1, -(1 - error) * ends.smallest)));
  EXPECT_FALSE(PositiveDefinite(Shifted(matrix, 1, -(1 + error) * ends.smallest)));
  EXPECT_TRUE(PositiveDefinite(Shifted(matrix, -1, (1 + error) * ends.largest)));
  EXPECT_FALSE(PositiveDefinite(Shifted(matrix, -1, (1 - error) * ends.largest)));
}

TEST(ContactMatrixTest, IsTheDenseProductOfItsFactors) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const ContactModel model : kModels) {
      const ContactFrame frame = ApplyModel(RandomFrame(seed), model);
      const BoxedLcp boxed = ToBoxed(frame.problem());
      const test::Dense dense =
          test::MakeDense({.bodies = frame.bodies, .positions = {}, .rows = frame.rows});
      // Sums of at most 72 products: three roundings in each, and one for each addition.
      const MatrixXd size =
          dense.J.cwiseAbs() * dense.inverse_mass.cwiseAbs() * dense.J.cwiseAbs().transpose();
      const double largest = std::max(size.maxCoeff(), dense.b.cwiseAbs().maxCoeff());
      const double tolerance = 100 * kEpsilon * std::max(1.0, largest);
      EXPECT_LE((MatrixXd(boxed.M) - dense.A).cwiseAbs().maxCoeff(), tolerance);
      EXPECT_LE((boxed.q + dense.b).cwiseAbs().maxCoeff(), tolerance);
      for (size_t i = 0; i < frame.rows.size(); ++i) {
        EXPECT_EQ(boxed.lo[static_cast<Eigen::Index>(i)], frame.rows[i].lo);
        EXPECT_EQ(boxed.hi[static_cast<Eigen::Index>(i)], frame.rows[i].hi);
      }
    }
  }
}

TEST(ContactMatrixTest, IsSymmetricToTheBitAndStoresRowsThatShareABody) {
  const ContactFrame frame = ApplyModel(SmallCastle(200), ContactModel::kBilateral);
  const BoxedLcp boxed = ToBoxed(frame.problem());
  EXPECT_EQ((boxed.M - Sparse(boxed.M.transpose())).norm(), 0);

  const auto moves = [&](int body) { return body >= 0 && frame.bodies[body].inv_mass > 0; };
  const auto share = [&](const Row& a, const Row& b) {
    return (moves(a.body_a) && (a.body_a == b.body_a || a.body_a == b.body_b)) ||
           (moves(a.body_b) && (a.body_b == b.body_a || a.body_b == b.body_b));
  };
  Eigen::Index expected = 0;
  for (const Row& a : frame.rows) {
    for (const Row& b : frame.rows) expected += share(a, b) ? 1 : 0;
  }
  EXPECT_EQ(boxed.M.nonZeros(), expected);
  EXPECT_LT(expected, boxed.M.size()) << "sparse";
}

TEST(ContactMatrixTest, HasTheResidualsOfTheContactProblem) {
  ContactFrame random = ApplyModel(RandomFrame(1), ContactModel::kNormals);
  // a locked axis would change the steps of contacts, and so their residuals
  random.bodies[3].linear_factor = {1, 0.2, 0.5};
  const ContactFrame frames[] = {
      WithCompliance(ApplyModel(SmallCastle(300), ContactModel::kNormals), 1e-3), random};
  for (const ContactFrame& frame : frames) {
    const BoxedLcp boxed = ToBoxed(frame.problem());
    ASSERT_TRUE(Validate(boxed).ok());
    const Report report = Measure(frame.problem(), frame.impulses);
    ASSERT_TRUE(report.ok());
    const LcpResidual residual = Measure(boxed, test::ToVector(frame.impulses));
    EXPECT_GT(residual.max, 1e-6);
    // w is a sum of up to 200 terms, none of which is larger than this
    const double term =
        boxed.M.diagonal().maxCoeff() * test::ToVector(frame.impulses).cwiseAbs().maxCoeff();
    const double tolerance = 200 * kEpsilon * std::max(1.0, term);
    EXPECT_NEAR(residual.max, report.residual_max, tolerance);
    const double root = std::sqrt(frame.rows.size() / boxed.M.diagonal().minCoeff());
    EXPECT_NEAR(residual.energy, report.residual_energy, root * tolerance);
  }
}

TEST(ContactModelTest, BoundsAreThoseOfTheModel) {
  const ContactFrame frame = RandomFrame(2);
  const auto frictions = static_cast<size_t>(std::count_if(
      frame.rows.begin(), frame.rows.end(), [](const Row& row) { return row.parent != kNoRow; }));
  const int joints = 3 * 4;
  ASSERT_EQ(frictions, 2 * 25u);

  EXPECT_EQ(ApplyModel(frame, ContactModel::kNormals).rows.size(), frame.rows.size() - frictions);
  EXPECT_EQ(Equations(ApplyModel(frame, ContactModel::kNormals)), joints);
  EXPECT_EQ(Equations(ApplyModel(frame, ContactModel::kBilateral)), joints + 2 * 25);
  EXPECT_EQ(Equations(ApplyModel(frame, ContactModel::kPyramid)), joints);
  for (const ContactModel model : kModels) {
    const ContactFrame applied = ApplyModel(frame, model);
    ASSERT_EQ(applied.impulses.size(), applied.rows.size());
    const int equations = Equations(applied);
    for (int i = 0; i < static_cast<int>(applied.rows.size()); ++i) {
      EXPECT_EQ(applied.rows[i].parent, kNoRow);
      EXPECT_EQ(i < equations, std::isinf(applied.rows[i].lo)) << "equations first";
    }
  }
}

TEST(ContactModelTest, APyramidIsAsWideAsTheImpulseOfItsParent) {
  ContactFrame frame{.bodies = {test::PointMass(2)}, .rows = {}, .impulses = {3, 1, -1, 9, -4, 9}};
  const Row normal = test::PushRow(0, kWorld, {0, 1, 0});
  Row friction = test::LinearRow(0, kWorld, {1, 0, 0});
  friction.friction = 0.5;
  frame.rows = {normal, friction, friction, friction, normal, friction};
  for (const int i : {1, 2, 3}) frame.rows[i].parent = 0;
  frame.rows[3].lo = -1;  // rolling friction has bounds of its own
  frame.rows[3].hi = 2;
  frame.rows[5].parent = 4;

  const std::vector<Row> rows = ApplyModel(frame, ContactModel::kPyramid).rows;
  const auto bounds = [&](int i) { return std::make_pair(rows[i].lo, rows[i].hi); };
  EXPECT_EQ(bounds(0), std::make_pair(0.0, kInfinity));
  EXPECT_EQ(bounds(1), std::make_pair(-1.5, 1.5));
  EXPECT_EQ(bounds(2), std::make_pair(-1.5, 1.5));
  EXPECT_EQ(bounds(3), std::make_pair(-1.0, 1.5));
  EXPECT_EQ(bounds(5), std::make_pair(0.0, 0.0)) << "a contact that pulls holds nothing";
}

TEST(ContactModelTest, ComplianceIsAShareOfTheDiagonal) {
  const ContactFrame frame = ApplyModel(SmallCastle(100), ContactModel::kBilateral);
  const VectorXd bare = ToBoxed(WithCompliance(frame, 0).problem()).M.diagonal();
  const VectorXd with = ToBoxed(WithCompliance(frame, 0.25).problem()).M.diagonal();
  // One rounding each of the product and of the sum
  EXPECT_LE((with - 1.25 * bare).cwiseQuotient(bare).cwiseAbs().maxCoeff(), 2 * kEpsilon);
}

TEST(NearestRowsTest, TakesContactsAsTheyAreReachedFromTheHeaviestBody) {
  // A row of five balls on the ground, the heaviest is number 1; and two apart from them.
  ContactFrame frame;
  for (const double mass : {1.0, 9.0, 1.0, 1.0, 1.0, 3.0, 1.0}) {
    frame.bodies.push_back(test::PointMass(mass));
  }
  const auto touch = [&](int a, int b) {
    const int normal = static_cast<int>(frame.rows.size());
    frame.rows.push_back(test::PushRow(a, b, {1, 0, 0}));
    Row friction = test::LinearRow(a, b, {0, 1, 0});
    friction.parent = normal;
    frame.rows.push_back(friction);
  };
  const std::pair<int, int> touching[] = {{5, 6}, {3, 4}, {2, 3}, {0, 1}, {1, 2}, {0, kWorld}};
  for (const auto& [a, b] : touching) touch(a, b);
  frame.impulses.resize(frame.rows.size());
  std::iota(frame.impulses.begin(), frame.impulses.end(), 0.0);

  const ContactFrame part = NearestRows(frame, {.contacts = 6, .frictions = 3});
  // Impulses tell which rows they were: first those of 1, then of 0, 2, 3 and of the pair apart
  EXPECT_EQ(part.impulses, (std::vector<double>{6, 8, 10, 4, 2, 0, 7, 9, 11}));
  EXPECT_EQ(part.rows[6].parent, 0);
  EXPECT_EQ(part.rows[8].parent, 2);
  EXPECT_THROW(NearestRows(frame, {.contacts = 7, .frictions = 0}), std::runtime_error);
  EXPECT_THROW(NearestRows(frame, {.contacts = 2, .frictions = 3}), std::runtime_error);
}

TEST(EnvelopeCholeskyTest, SolvesAsADenseFactorisation) {
  for (const int n : {1, 2, 40, 150}) {
    const Sparse matrix = RandomMatrix(n, 0.1, 7);
    const EnvelopeCholesky factor(matrix);
    ASSERT_TRUE(factor.ok());
    const VectorXd b = VectorXd::LinSpaced(n, 1, 2);
    const VectorXd expected = MatrixXd(matrix).llt().solve(b);
    // Eigenvalues lie between 0.1 and some 10: the condition number takes two digits.
    EXPECT_LE((factor.Solve(b) - expected).norm(), 1e3 * n * kEpsilon * expected.norm());
  }
  EXPECT_FALSE(EnvelopeCholesky(Shifted(RandomMatrix(40, 0, 7), 1, -1e-3)).ok());
}

TEST(EnvelopeCholeskyTest, OrdersAShuffledChainIntoABand) {
  constexpr int kLinks = 200;
  std::vector<int> name(kLinks);
  for (int i = 0; i < kLinks; ++i) name[i] = 77 * i % kLinks;  // 77 and 200 have no common factor
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < kLinks; ++i) {
    entries.emplace_back(name[i], name[i], 2);
    if (i + 1 == kLinks || i == 99) continue;  // two chains
    entries.emplace_back(name[i], name[i + 1], -1);
    entries.emplace_back(name[i + 1], name[i], -1);
  }
  Sparse chain(kLinks, kLinks);
  chain.setFromTriplets(entries.begin(), entries.end());
  // A diagonal and one entry beside it, but for the first of each chain
  EXPECT_EQ(EnvelopeCholesky(chain).size(), 2 * kLinks - 2);
  std::vector<int> order = ReverseCuthillMcKee(chain);
  std::sort(order.begin(), order.end());
  for (int i = 0; i < kLinks; ++i) EXPECT_EQ(order[i], i);
}

TEST(ConditionTest, IsThatOfTheDenseMatrix) {
  std::vector<Sparse> matrices = {RandomMatrix(1, 1, 1), RandomMatrix(60, 1e-3, 1),
                                  RandomMatrix(120, 1e-7, 2), RandomMatrix(150, 10, 3)};
  for (const double share : {1.0, 1e-4, 1e-8}) {
    const ContactFrame frame = ApplyModel(SmallCastle(60), ContactModel::kBilateral);
    matrices.push_back(ToBoxed(WithCompliance(frame, share).problem()).M);
  }
  for (const Sparse& matrix : matrices) {
    const VectorXd expected = Eigen::SelfAdjointEigenSolver<MatrixXd>(matrix).eigenvalues();
    const Spectrum ends = ExtremeEigenvalues(matrix);
    const Eigen::Index last = expected.size() - 1;
    EXPECT_NEAR(ends.smallest / expected[0], 1, 2 * kEigenvalueError);
    EXPECT_NEAR(ends.largest / expected[last], 1, 2 * kEigenvalueError);
    ExpectEndsOfSpectrum(matrix, ends, 2 * kEigenvalueError);
  }
}

TEST(ConditionTest, OfASingularMatrixIsInfinite) {
  Sparse matrix = MatrixXd::Ones(3, 3).sparseView();
  EXPECT_EQ(ExtremeEigenvalues(matrix).condition(), kInfinity);
}

// The eigenvalues of [1 1; 1 1] + s I are s and 2 + s: the condition number is c at s = 2 / (c -
// 1).
TEST(ConditionTest, ComplianceOfTwoEqualRowsIsAsByHand) {
  const Sparse matrix = MatrixXd::Ones(2, 2).sparseView();
  for (const double target : {1.5, 58.0, 4.6e4, 1.03e8}) {
    const Compliance found = FindCompliance(matrix, target);
    EXPECT_NEAR(found.condition / target, 1, 2e-3);
    EXPECT_NEAR(found.share * (target - 1) / 2, 1, 2 * (2e-3 + 2 * kEigenvalueError));
  }
}

TEST(ConditionTest, AnEndOfTheRangeAnswersATargetOutOfReach) {
  Sparse identity(5, 5);
  identity.setIdentity();
  const Compliance found = FindCompliance(identity, 58);
  EXPECT_NEAR(found.condition, 1, 2 * kEigenvalueError);
  EXPECT_LT(found.share, 2e-12);
}

TEST(CastleSizesTest, HaveTheCountsOfTheTalk) {
  ASSERT_EQ(CastleSizes().size(), 10u);
  for (const CastleSize& size : CastleSizes()) {
    const RowCount wanted{.contacts = size.inequalities, .frictions = size.equations};
    const ContactFrame rows =
        ApplyModel(NearestRows(ImpactFrame(), wanted), ContactModel::kBilateral);
    EXPECT_EQ(Equations(rows), size.equations);
    EXPECT_EQ(static_cast<int>(rows.rows.size()), size.equations + size.inequalities);
  }
}

TEST(CastleSizesTest, HaveTheConditionNumbersOfTheTalk) {
  for (const int number : {1, 2, 3, 4, 5, 10}) {  // those between are made in the same way
    SCOPED_TRACE(number);
    const CastleSize& size = CastleSizes()[number - 1];
    const SizedCastle castle = MakeSizedCastle(ImpactFrame(), size, ContactModel::kBilateral);
    const Sparse matrix = ToBoxed(castle.frame.problem()).M;
    const Spectrum ends = ExtremeEigenvalues(matrix);
    EXPECT_NEAR(ends.condition() / size.condition, 1, 0.01);
    EXPECT_NEAR(castle.compliance.condition / size.condition, 1, 0.01);
    ExpectEndsOfSpectrum(matrix, ends, 2 * kEigenvalueError);
  }
}

TEST(CastleSizesTest, EveryModelHasTheSameComplianceAndNoLargerConditionNumber) {
  const CastleSize& size = CastleSizes()[1];
  const SizedCastle bilateral = MakeSizedCastle(ImpactFrame(), size, ContactModel::kBilateral);
  for (const ContactModel model : kModels) {
    const SizedCastle castle = MakeSizedCastle(ImpactFrame(), size, model);
    EXPECT_EQ(castle.compliance.share, bilateral.compliance.share);
    const double condition = ExtremeEigenvalues(ToBoxed(castle.frame.problem()).M).condition();
    const double relative = condition / bilateral.compliance.condition;
    EXPECT_LE(relative, 1 + 4 * kEigenvalueError);
    EXPECT_GE(relative, model == ContactModel::kNormals ? 0 : 1 - 4 * kEigenvalueError);
  }
}

TEST(CastleSizesTest, EveryModelIsSolved) {
  for (const ContactModel model : kModels) {
    SCOPED_TRACE(static_cast<int>(model));
    const SizedCastle castle = MakeSizedCastle(ImpactFrame(), CastleSizes()[1], model);
    const BoxedLcp lcp = ToBoxed(castle.frame.problem());
    ASSERT_TRUE(Validate(lcp).ok());
    lcp::Settings settings;
    settings.tolerance = 1e-6;
    VectorXd x = VectorXd::Zero(lcp.size());
    const lcp::Report report = lcp::Solver(settings).Solve(lcp, &x);
    ASSERT_TRUE(report.ok());
    const LcpResidual residual = Measure(lcp, x);
    EXPECT_LE(residual.relative, settings.tolerance);
    EXPECT_EQ(residual.violation, 0);
    EXPECT_GT(x.norm(), 0);
  }
}

TEST(RigidGeneratorsTest, MakeTheSameBitsEachTime) {
  for (const problems::Generator& generator : RigidGenerators()) {
    SCOPED_TRACE(generator.name);
    std::vector<double> values;
    for (const problems::Parameter& parameter : generator.parameters) {
      values.push_back(parameter.value);
    }
    const int size = generator.min_size;
    const auto a = generator.make(size, values), b = generator.make(size, values);
    const BoxedLcp &p = a->current().lcp, &q = b->current().lcp;
    EXPECT_EQ(a->current().name, b->current().name);
    EXPECT_EQ(p.q, q.q);
    EXPECT_EQ(p.hi, q.hi);
    EXPECT_EQ(p.M.nonZeros(), q.M.nonZeros());
    EXPECT_EQ((p.M - q.M).norm(), 0);
  }
}

TEST(RigidGeneratorsTest, TheParameterChoosesTheModel) {
  const problems::Generator generator = RigidGenerators()[1];
  ASSERT_EQ(generator.name, "castle-frame");
  const auto contacts =
      static_cast<Eigen::Index>(ApplyModel(CastleFrame(0), ContactModel::kNormals).rows.size());
  const struct {
    std::string name;
    Eigen::Index equations, rows;
  } expected[] = {{"normals", 0, contacts},
                  {"bilateral", 2 * contacts, 3 * contacts},
                  {"pyramid", 0, 3 * contacts}};
  for (int model = 0; model < 3; ++model) {
    const auto source = generator.make(0, {static_cast<double>(model), 0.5});
    const problems::Problem& problem = source->current();
    EXPECT_EQ(problem.name, "castle-frame-0-" + expected[model].name);
    EXPECT_EQ(problem.lcp.size(), expected[model].rows);
    EXPECT_EQ(problem.lcp.lo.array().isInf().count(), expected[model].equations);
  }
}

}  // namespace
}  // namespace cairn::bench
