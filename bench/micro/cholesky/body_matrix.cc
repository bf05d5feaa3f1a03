// SPDX-License-Identifier: MIT
#include "micro/cholesky/body_matrix.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "cairn/detail/eigen.h"
#include "run/scene_run.h"

namespace cairn::micro {
namespace {

/// Frames before the one that is looked at: piles have landed, stacks carry themselves.
constexpr int kFrames = 120;
constexpr double kContactEps = 3e-3, kJointEps = 1e-4;

/// R with M^-1 = R R'.
Block6 RootOf(const Body& body) {
  Block6 root = Block6::Zero();
  root.diagonal().head<3>() = (body.inv_mass * View(body.linear_factor)).cwiseSqrt();
  root.bottomRightCorner<3, 3>() = View(body.inv_inertia).llt().matrixL();
  return root;
}

class Assembly {
 public:
  explicit Assembly(const bench::ContactFrame& frame) : frame_(frame) {
    for (const Body& body : frame.bodies) {
      const bool moves = body.inv_mass > 0;
      index_.push_back(moves ? matrix_.bodies++ : -1);
      roots_.push_back(moves ? RootOf(body) : Block6::Zero());
    }
    for (const Row& row : frame.rows) {
      if (Moving(row.body_a) < 0 || Moving(row.body_b) < 0) continue;
      matrix_.pairs.push_back(PairOf(row));
    }
    std::ranges::sort(matrix_.pairs);
    matrix_.pairs.erase(std::ranges::unique(matrix_.pairs).begin(), matrix_.pairs.end());
    matrix_.diagonals.assign(matrix_.bodies, Block6::Identity());
    matrix_.uppers.assign(matrix_.pairs.size(), Block6::Zero());
    for (size_t i = 0; i < frame.rows.size(); ++i) Add(frame.rows[i], frame.impulses[i]);
  }

  BodyMatrix Take() { return std::move(matrix_); }

 private:
  int Moving(int body) const { return body == kWorld ? -1 : index_[body]; }
  std::pair<int, int> PairOf(const Row& row) const {
    return std::minmax({Moving(row.body_a), Moving(row.body_b)});
  }

  bool IsFree(const Row& row, double x) const {
    if (row.parent == kNoRow) return x > row.lo && x < row.hi;
    const double most = row.friction * std::max(0.0, frame_.impulses[row.parent]);
    return most > 0 && std::abs(x) < most;
  }

  void Add(const Row& row, double x) {
    const int a = Moving(row.body_a), b = Moving(row.body_b);
    Vector6 j_a, j_b, g_a = Vector6::Zero(), g_b = Vector6::Zero();
    j_a << View(row.linear_a), View(row.angular_a);
    j_b << View(row.linear_b), View(row.angular_b);
    if (a >= 0) g_a = roots_[row.body_a].transpose() * j_a;
    if (b >= 0) g_b = roots_[row.body_b].transpose() * j_b;
    if (a >= 0 || b >= 0) matrix_.all_rows.push_back({a, b, g_a, g_b});
    if (!IsFree(row, x)) return;
    const bool joint = row.parent == kNoRow && std::isinf(row.lo);
    const double diagonal = g_a.squaredNorm() + g_b.squaredNorm() + row.compliance;
    const double weight = 1 / (row.compliance + (joint ? kJointEps : kContactEps) * diagonal);
    if (!std::isfinite(weight)) return;

    ++matrix_.rows;
    if (a >= 0) matrix_.diagonals[a] += weight * g_a * g_a.transpose();
    if (b >= 0) matrix_.diagonals[b] += weight * g_b * g_b.transpose();
    if (a < 0 || b < 0) return;
    const auto pair = std::ranges::lower_bound(matrix_.pairs, PairOf(row));
    Block6& upper = matrix_.uppers[pair - matrix_.pairs.begin()];
    if (a < b) {
      upper += weight * g_a * g_b.transpose();
    } else {
      upper += weight * g_b * g_a.transpose();
    }
  }

  const bench::ContactFrame& frame_;
  std::vector<int> index_;     ///< of each body, among those that move
  std::vector<Block6> roots_;  ///< of each body
  BodyMatrix matrix_;
};

}  // namespace

BodyMatrix MakeBodyMatrix(const std::string& scene) {
  const cli::SceneChoice choice = cli::ParseScene(scene);
  cli::StateRun run(choice);
  run.Skip(choice.FirstFrame(kFrames));
  bench::ContactFrame frame = run.Record();
  BodyMatrix matrix = Assembly(frame).Take();
  matrix.frame = std::move(frame);
  return matrix;
}

}  // namespace cairn::micro
