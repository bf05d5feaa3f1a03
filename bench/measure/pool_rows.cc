// SPDX-License-Identifier: MIT
#include "measure/pool_rows.h"

#include <cmath>

#include "cairn/detail/eigen.h"
#include "measure/row_velocities.h"

namespace cairn::bench {
namespace {

using Pool = PoolRow::Pool;

class Converter {
 public:
  Converter(const ContactProblem& problem, std::span<const double> impulses, int first_contact)
      : problem_(problem),
        free_(FreeVelocities(problem.bodies)),
        world_(static_cast<int>(problem.bodies.size())),
        number_in_pool_(problem.rows.size()) {
    std::vector<char> is_contact(problem.rows.size());
    for (size_t i = 0; i < problem.rows.size(); ++i) {
      const Row& row = problem.rows[i];
      is_contact[i] = row.parent == kNoRow && static_cast<int>(i) >= first_contact;
      if (row.parent != kNoRow) is_contact[row.parent] = true;
    }
    for (const Body& body : problem.bodies) AddBody(body);
    result_.bodies.emplace_back();
    for (int i = 0; i < static_cast<int>(problem.rows.size()); ++i) {
      AddRow(i, is_contact[i] ? Pool::kContact : Pool::kJoint, impulses[i]);
    }
  }

  PoolProblem Take() { return std::move(result_); }

 private:
  void AddBody(const Body& body) {
    const Eigen::Vector3d inv_mass = body.inv_mass * View(body.linear_factor);
    const bool moves = !inv_mass.isZero(0) || !View(body.inv_inertia).isZero(0);
    result_.bodies.push_back({.moves = moves, .inv_mass = inv_mass});
  }

  Eigen::Vector3d Response(int body, const Eigen::Vector3d& angular) const {
    if (body == kWorld) return Eigen::Vector3d::Zero();
    return View(problem_.bodies[body].inv_inertia) * angular;
  }
  /// Its part of J M^-1 J'.
  double Diagonal(int body, const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) const {
    if (body == kWorld) return 0;
    const Velocity response = Respond(problem_.bodies[body], linear, angular);
    return linear.dot(View(response.linear)) + angular.dot(View(response.angular));
  }

  void AddRow(int index, Pool pool, double impulse) {
    const Row& row = problem_.rows[index];
    PoolRow& to = result_.rows.emplace_back();
    to.pool = row.parent == kNoRow ? pool : std::isinf(row.hi) ? Pool::kFriction : Pool::kTwist;
    to.body_a = row.body_a == kWorld ? world_ : row.body_a;
    to.body_b = row.body_b == kWorld ? world_ : row.body_b;
    to.linear_a = row.linear_a;
    to.angular_a = row.angular_a;
    to.linear_b = row.linear_b;
    to.angular_b = row.angular_b;
    to.response_a = Response(row.body_a, row.angular_a);
    to.response_b = Response(row.body_b, row.angular_b);
    const double diagonal = row.compliance + Diagonal(row.body_a, row.linear_a, row.angular_a) +
                            Diagonal(row.body_b, row.linear_b, row.angular_b);
    to.step = diagonal > 0 ? row.relaxation / diagonal : 0;
    to.target = row.target - RowSpeed(row, free_);
    to.compliance = row.compliance;
    to.lo = row.lo;
    to.hi = row.hi;
    to.friction = row.friction;
    to.contact = row.parent == kNoRow ? 0 : number_in_pool_[row.parent];
    to.impulse = impulse;
    number_in_pool_[index] = counts_[static_cast<int>(to.pool)]++;
    Judge(index, row, to.pool);
  }

  void Judge(int index, const Row& row, Pool pool) {
    const char* why = nullptr;
    if (pool == Pool::kContact && !std::isinf(row.hi)) why = "a contact has an upper bound";
    if (pool == Pool::kFriction && !std::isinf(row.lo)) why = "friction has a lower bound only";
    // Bullet bounds these by the coefficient, and by the coefficient times the normal impulse
    const bool as_bullets = row.hi == row.friction && row.lo == -row.friction;
    if (pool == Pool::kTwist && !as_bullets) {
      why = "the bounds of a row that follows a contact are not its coefficient";
    }
    if (why == nullptr || !result_.refusal.empty()) return;
    result_.refusal.append("row ").append(std::to_string(index)).append(": ").append(why);
    result_.refusal.append(", which Bullet does not have");
  }

  const ContactProblem& problem_;
  std::vector<Velocity> free_;
  int world_;
  std::vector<int> number_in_pool_;
  int counts_[4] = {};
  PoolProblem result_;
};

}  // namespace

PoolProblem ToPools(const ContactProblem& problem, std::span<const double> impulses,
                    int first_contact) {
  return Converter(problem, impulses, first_contact).Take();
}

}  // namespace cairn::bench
