// SPDX-License-Identifier: MIT
#include "rigid/contact_matrix.h"
#include "cairn/detail/eigen.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

namespace cairn::bench {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// The part of a row that acts on one body: J (6 entries) and M^-1 J'.
struct Arm {
  int body = kWorld;
  Vector6 jacobian = Vector6::Zero(), response = Vector6::Zero();
};
using Arms = std::array<Arm, 2>;

bool Moves(const Body& body) {
  return body.inv_mass * View(body.linear_factor).maxCoeff() > 0 ||
         !View(body.inv_inertia).isZero(0);
}

/// M^-1 times a vector of momenta.
Vector6 Respond(const Body& body, const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
  Vector6 response;
  response << body.inv_mass * View(body.linear_factor).cwiseProduct(linear),
      View(body.inv_inertia) * angular;
  return response;
}

/// kWorld as the body if it cannot move: such a body couples nothing.
Arm MakeArm(std::span<const Body> bodies, int body, const Eigen::Vector3d& linear,
            const Eigen::Vector3d& angular) {
  if (body == kWorld || !Moves(bodies[body])) return {};
  Arm arm{.body = body};
  arm.jacobian << linear, angular;
  arm.response = Respond(bodies[body], linear, angular);
  return arm;
}

Arms MakeArms(std::span<const Body> bodies, const Row& row) {
  return {MakeArm(bodies, row.body_a, row.linear_a, row.angular_a),
          MakeArm(bodies, row.body_b, row.linear_b, row.angular_b)};
}

double Diagonal(const Arms& arms) {
  return arms[0].jacobian.dot(arms[0].response) + arms[1].jacobian.dot(arms[1].response);
}

/// Column i of the lower triangle of J M^-1 J', entries of one column in a dense vector.
class LowerColumn {
 public:
  LowerColumn(const std::vector<Arms>& arms, int bodies)
      : arms_(arms), rows_of_body_(bodies), last_seen_(arms.size(), -1), value_(arms.size()) {
    for (int i = 0; i < static_cast<int>(arms.size()); ++i) {
      for (const Arm& arm : arms[i]) {
        if (arm.body != kWorld) rows_of_body_[arm.body].push_back(i);
      }
    }
  }

  /// Rows >= i that share a body with row i, itself among them, ascending.
  const std::vector<int>& Compute(int i) {
    pattern_.clear();
    Add(i, i, 0);  // compliance has its place even in a row that moves nothing
    for (const Arm& arm : arms_[i]) {
      if (arm.body == kWorld) continue;
      const std::vector<int>& rows = rows_of_body_[arm.body];
      for (auto j = std::lower_bound(rows.begin(), rows.end(), i); j != rows.end(); ++j) {
        for (const Arm& other : arms_[*j]) {
          if (other.body == arm.body) Add(i, *j, arm.jacobian.dot(other.response));
        }
      }
    }
    std::sort(pattern_.begin(), pattern_.end());
    return pattern_;
  }

  double operator[](int j) const { return value_[j]; }

 private:
  void Add(int i, int j, double share) {
    if (last_seen_[j] != i) {
      last_seen_[j] = i;
      value_[j] = 0;
      pattern_.push_back(j);
    }
    value_[j] += share;
  }

  const std::vector<Arms>& arms_;
  std::vector<std::vector<int>> rows_of_body_;
  std::vector<int> last_seen_, pattern_;
  std::vector<double> value_;
};

Eigen::SparseMatrix<double> Assemble(const ContactProblem& problem, const std::vector<Arms>& arms) {
  const int n = static_cast<int>(arms.size());
  LowerColumn column(arms, static_cast<int>(problem.bodies.size()));
  Eigen::SparseMatrix<double> lower(n, n);
  for (int i = 0; i < n; ++i) {
    lower.startVec(i);
    for (const int j : column.Compute(i)) {
      lower.insertBack(j, i) = column[j] + (i == j ? problem.rows[i].compliance : 0);
    }
  }
  lower.finalize();
  // Copied, not computed again: both triangles have the same bits
  Eigen::SparseMatrix<double> full(n, n);
  full = lower.selfadjointView<Eigen::Lower>();
  return full;
}

}  // namespace

Eigen::VectorXd ContactDiagonal(const ContactProblem& problem) {
  Eigen::VectorXd diagonal(problem.rows.size());
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
    diagonal[i] = Diagonal(MakeArms(problem.bodies, problem.rows[i]));
  }
  return diagonal;
}

BoxedLcp ToBoxed(const ContactProblem& problem) {
  std::vector<Vector6> free;
  for (const Body& body : problem.bodies) {
    Vector6 velocity = Respond(body, body.impulse, body.angular_impulse);
    velocity.head<3>() += View(body.velocity.linear);
    velocity.tail<3>() += View(body.velocity.angular);
    free.push_back(velocity);
  }

  const auto n = static_cast<Eigen::Index>(problem.rows.size());
  BoxedLcp boxed{
      .M = {}, .q = Eigen::VectorXd(n), .lo = Eigen::VectorXd(n), .hi = Eigen::VectorXd(n)};
  std::vector<Arms> arms;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Row& row = problem.rows[i];
    assert(row.parent == kNoRow);
    boxed.q[i] = -row.target;
    // Also of bodies that cannot be pushed: kinematic ones move
    if (row.body_a != kWorld) {
      boxed.q[i] += View(row.linear_a).dot(free[row.body_a].head<3>()) +
                    View(row.angular_a).dot(free[row.body_a].tail<3>());
    }
    if (row.body_b != kWorld) {
      boxed.q[i] += View(row.linear_b).dot(free[row.body_b].head<3>()) +
                    View(row.angular_b).dot(free[row.body_b].tail<3>());
    }
    boxed.lo[i] = row.lo;
    boxed.hi[i] = row.hi;
    arms.push_back(MakeArms(problem.bodies, row));
  }
  boxed.M = Assemble(problem, arms);
  return boxed;
}

}  // namespace cairn::bench
