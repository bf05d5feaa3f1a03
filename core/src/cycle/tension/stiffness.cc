// SPDX-License-Identifier: MIT
#include "cairn/detail/stiffness.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "cairn/detail/eigen.h"
#include "cycle/tension/joint_arms.h"
#include "problem/body_name.h"
#include "problem/islands.h"
#include "simd/flush_denormals.h"
#include "simd/principal_axes.h"
#include "simd/raised_inertia.h"

namespace cairn {
namespace {

/// h^2 k / I up to which nothing is raised; the integrator is stable up to 4.
constexpr double kThreshold = 2;
/// Of what was needed, what is still held a step later: tension flips from step to step.
constexpr double kHold = 0.9;
/// Of spin, damped on axes that are raised without end; without it they gain a little energy.
constexpr double kDamping = 0.02;
/// A body that turns this far in a step [rad] is no longer pulled as the tension of the last one
/// says. From there on its spin is damped down to the momentum that it has without raised inertia.
constexpr double kFarTurn = 0.2;
/// Bodies that are this much below the threshold are not remembered.
constexpr double kRemember = 0.5;
/// So many bodies that are asleep are remembered; those that were removed are among them.
constexpr size_t kMostAbsent = 1 << 14;
/// What the mean of tensions that sweeps alone left keeps of itself in a step.
constexpr double kKeep = 0.9;
/// Body::strain from which on joints take back less of their errors. From 4 on chains under heavy
/// loads lose 3 % of their energy in 10 s and gape twice as far, from 16 on they gain 2 %.
constexpr double kSlowed = 8;
/// Moments of inertia that are this close have no axes of their own.
constexpr double kSameMoment = 1e-3;
/// Arms of joints whose squares across a line are this much less than along it lie on it.
constexpr double kOnLine = 1e-3;

/// No stiffness about an axis is larger.
double Most(const Eigen::Matrix3d& stiffness) { return 2 * stiffness.norm(); }

/// At least the length of a vector.
float Sum(const float (&vector)[3]) {
  return std::abs(vector[0]) + std::abs(vector[1]) + std::abs(vector[2]);
}

struct Kernels {
  simd::PrincipalAxesKernel find_axes;
  simd::RaiseKernel raise;
};

/// Chosen once for all: bits do not depend on it.
const Kernels& ChosenKernels() {
  static const Kernels kKernels = {simd::PrincipalAxesKernelFor(simd::ChosenTarget()),
                                   simd::RaiseKernelFor(simd::ChosenTarget())};
  return kKernels;
}

/// The lower half of a matrix, column by column, to and from a lane.
void PutHalf(const Matrix3& matrix, size_t lane, double (*to)[simd::kLanes]) {
  for (int column = 0, k = 0; column < 3; ++column) {
    for (int row = column; row < 3; ++row) to[k++][lane] = matrix(row, column);
  }
}
Matrix3 WholeOf(const double (*half)[simd::kLanes], size_t lane) {
  Matrix3 whole;
  for (int column = 0, k = 0; column < 3; ++column) {
    for (int row = column; row < 3; ++row) {
      whole(row, column) = whole(column, row) = half[k++][lane];
    }
  }
  return whole;
}

}  // namespace

Matrix3 GeometricStiffness::Symmetric::Whole() const {
  Matrix3 whole;
  View(whole) << xx, yx, zx, yx, yy, zy, zx, zy, zz;
  return whole;
}

double ShareOfErp(double strain) { return strain > kSlowed ? std::sqrt(kSlowed / strain) : 1; }

std::span<const GeometricStiffness::Raised> GeometricStiffness::RaiseInertia(
    double time_step, std::span<Body> bodies, std::span<const char> jointed) {
  if (!absent_.empty()) Recall(bodies, jointed);
  raised_.clear();
  raised_.reserve(memories_.size());
  FindStrained(time_step, bodies, jointed);
  if (strained_.empty()) return raised_;
  const simd::FlushDenormals flush;
  simd::PrincipalAxes axes;
  simd::RaisedInertia lanes;
  const simd::RaiseRules rules = {time_step, kThreshold, kHold, kSameMoment, kOnLine};
  for (size_t from = 0; from < strained_.size(); from += simd::kLanes) {
    const size_t count = std::min<size_t>(simd::kLanes, strained_.size() - from);
    const std::span<const Strained> some(&strained_[from], count);
    for (size_t l = 0; l < count; ++l) {
      const Memory& memory = *some[l].memory;
      PutHalf(bodies[some[l].body].inv_inertia, l, axes.matrix);
      PutHalf(memory.stiffness, l, lanes.stiffness);
      PutHalf(memory.arms, l, lanes.arms);
      for (int k = 0; k < 3; ++k) {
        lanes.held[k][l] = memory.held[k];
        lanes.kept[k][l] = memory.kept[k];
      }
    }
    ChosenKernels().find_axes(&axes);
    ChosenKernels().raise(rules, axes, &lanes);
    for (size_t l = 0; l < count; ++l) {
      TakeRaised(lanes, l, some[l], bodies);
    }
  }
  return raised_;
}

void GeometricStiffness::FindStrained(double time_step, std::span<Body> bodies,
                                      std::span<const char> jointed) {
  strained_.clear();
  strained_.reserve(memories_.size());
  for (int i = 0; i < static_cast<int>(bodies.size()); ++i) {
    Body& body = bodies[i];
    body.strain = 0;
    if (memories_.empty() || (!jointed.empty() && jointed[i] == 0) || !CanMove(body)) continue;
    Memory* const memory = Find(body, i);
    if (memory == nullptr || memory->inv_mass != body.inv_mass) continue;
    // no axis has more: |row i of K|_1 / I_i <= sqrt(3) |K I^-1|
    const double most = 2 * (View(memory->stiffness) * View(body.inv_inertia)).norm();
    memory->held_ratio *= kHold;
    body.strain = time_step * time_step * std::max(most, memory->held_ratio);
    if (body.strain <= kThreshold) {
      View(memory->held) *= kHold;
      memory->kept = {1, 1, 1};
    } else {
      strained_.push_back({i, memory});
    }
  }
}

void GeometricStiffness::TakeRaised(const simd::RaisedInertia& lanes, size_t lane,
                                    const Strained& strained, std::span<Body> bodies) {
  const Matrix3 inv_inertia = WholeOf(lanes.inv_inertia, lane);
  // the inertia was not: the solver will say so
  if (!std::isfinite(View(inv_inertia).sum())) return;
  Body& body = bodies[strained.body];
  Memory& memory = *strained.memory;
  for (int k = 0; k < 3; ++k) {
    memory.held[k] = lanes.held[k][lane];
    memory.kept[k] = lanes.kept[k][lane];
  }
  memory.held_ratio = lanes.held_ratio[lane];
  body.strain = lanes.strain[lane];
  if (body.strain <= kThreshold) return;
  body.inv_inertia = inv_inertia;
  raised_.push_back({strained.body, WholeOf(lanes.response, lane), WholeOf(lanes.carried, lane)});
}

Vector3 GeometricStiffness::Raised::Damp(double time_step, const Vector3& spin) const {
  const Eigen::Vector3d all = View(spin), w = View(carried) * all, lent = w - View(response) * w;
  const double turn = time_step / kFarTurn;
  const double share = std::min(1.0, kDamping + turn * turn * lent.squaredNorm());
  return w - share * lent - all;
}

void GeometricStiffness::Apply(double time_step, std::span<Body> bodies,
                               std::span<const char> jointed) {
  for (const Raised& raised : RaiseInertia(time_step, bodies, jointed)) {
    Vector3& spin = bodies[raised.body].velocity.angular;
    View(spin) += View(raised.Damp(time_step, spin));
  }
}

GeometricStiffness::Memory* GeometricStiffness::Find(const Body& body, int place) {
  const std::uint64_t key = BodyNameOf(body, place);
  const auto at = static_cast<size_t>(place);
  if (at >= key_at_.size() || key_at_[at] != key) return FindMoved(key);
  return memory_at_[at] < 0 ? nullptr : &memories_[memory_at_[at]];
}

GeometricStiffness::Memory* GeometricStiffness::FindMoved(std::uint64_t key) {
  if (by_key_.size() != memories_.size()) {
    by_key_.resize(memories_.size());
    std::iota(by_key_.begin(), by_key_.end(), 0);
    std::sort(by_key_.begin(), by_key_.end(), [this](int a, int b) {
      return std::pair(memories_[a].key, a) < std::pair(memories_[b].key, b);
    });
  }
  const auto found = std::lower_bound(
      by_key_.begin(), by_key_.end(), key,
      [this](int memory, std::uint64_t wanted) { return memories_[memory].key < wanted; });
  return found != by_key_.end() && memories_[*found].key == key ? &memories_[*found] : nullptr;
}

GeometricStiffness::Memory* GeometricStiffness::FindAbsent(std::uint64_t key) {
  const auto found = std::lower_bound(
      absent_.begin(), absent_.end(), key,
      [](const Memory& memory, std::uint64_t wanted) { return memory.key < wanted; });
  return found == absent_.end() || found->key != key ? nullptr : &*found;
}

void GeometricStiffness::Recall(std::span<const Body> bodies, std::span<const char> jointed) {
  key_at_.resize(bodies.size(), kNobody);
  memory_at_.resize(bodies.size(), -1);
  bool some = false;
  for (size_t i = 0; i < bodies.size(); ++i) {
    if ((!jointed.empty() && jointed[i] == 0) || !CanMove(bodies[i])) continue;
    const std::uint64_t key = BodyNameOf(bodies[i], static_cast<int>(i));
    if (key_at_[i] == key) continue;
    Memory* const found = FindAbsent(key);
    if (found == nullptr) continue;
    found->seen = some = true;
    if (found->inv_mass != bodies[i].inv_mass) continue;
    key_at_[i] = key;
    memory_at_[i] = static_cast<int>(memories_.size());
    memories_.push_back(*found);
  }
  if (some) std::erase_if(absent_, [](const Memory& memory) { return memory.seen; });
}

void GeometricStiffness::KeepAbsent() {
  const auto absent = [](const Memory& memory) { return memory.absent; };
  if (std::none_of(memories_.begin(), memories_.end(), absent)) return;
  for (const Memory& memory : memories_) {
    // a body that was back without joints
    Memory* const before = memory.absent ? FindAbsent(memory.key) : nullptr;
    if (before != nullptr) before->seen = true;
  }
  std::erase_if(absent_, [](const Memory& memory) { return memory.seen; });
  std::copy_if(memories_.begin(), memories_.end(), std::back_inserter(absent_), absent);
  if (absent_.size() > kMostAbsent) return absent_.clear();
  std::sort(absent_.begin(), absent_.end(),
            [](const Memory& a, const Memory& b) { return a.key < b.key; });
  for (Memory& memory : absent_) memory.seen = false;
}

void GeometricStiffness::NotePlaces(std::span<const Body> bodies) {
  by_key_.clear();
  key_at_.resize(bodies.size());
  memory_at_.assign(bodies.size(), -1);
  for (size_t i = 0; i < bodies.size(); ++i) {
    // engines may leave bodies that are asleep where they are, without mass
    key_at_[i] = CanMove(bodies[i]) ? BodyNameOf(bodies[i], static_cast<int>(i)) : kNobody;
  }
  for (size_t m = 0; m < memories_.size(); ++m) {
    memory_at_[memories_[m].place] = static_cast<int>(m);
  }
}

void GeometricStiffness::Add(int body, const Vector3& r, const Vector3& f) {
  if (place_[body] < 0) {
    place_[body] = static_cast<int>(pulled_.size());
    pulled_.push_back(body);
    sums_.emplace_back();
  }
  // (f . r) 1 - (r f' + f r') / 2, which is symmetric
  Symmetric& sum = sums_[place_[body]].stiffness;
  const double xx = r[0] * f[0], yy = r[1] * f[1], zz = r[2] * f[2];
  const double along = xx + yy + zz;
  sum.xx += along - xx;
  sum.yy += along - yy;
  sum.zz += along - zz;
  sum.yx -= 0.5 * (r[1] * f[0] + f[1] * r[0]);
  sum.zx -= 0.5 * (r[2] * f[0] + f[2] * r[0]);
  sum.zy -= 0.5 * (r[2] * f[1] + f[2] * r[1]);

  Symmetric& arms = sums_[place_[body]].arms;
  const double force = f[0] * f[0] + f[1] * f[1] + f[2] * f[2];
  const double rx = force * r[0], ry = force * r[1], rz = force * r[2];
  arms.xx += ry * r[1] + rz * r[2];
  arms.yy += rx * r[0] + rz * r[2];
  arms.zz += rx * r[0] + ry * r[1];
  arms.yx -= ry * r[0];
  arms.zx -= rz * r[0];
  arms.zy -= rz * r[1];
}

void GeometricStiffness::FindAnchored(const ContactProblem& problem, const Report& report) {
  anchored_islands_.assign(report.islands.size(), 0);
  const auto moves = [&](int body) { return body != kWorld && problem.bodies[body].inv_mass > 0; };
  const auto look = [&](const auto& between) {
    if (moves(between.body_a) == moves(between.body_b)) return;
    const int body = moves(between.body_a) ? between.body_a : between.body_b;
    if (report.island_of[body] >= 0) anchored_islands_[report.island_of[body]] = 1;
  };
  for (const Joint& joint : problem.joints) look(joint);
  for (const Row& row : problem.rows) look(row);
  for (const Manifold& manifold : problem.manifolds) look(manifold);

  anchored_.assign(problem.bodies.size(), 0);
  for (size_t i = 0; i < problem.bodies.size(); ++i) {
    const int island = report.island_of[i];
    // what cannot move belongs to no island
    anchored_[i] = island >= 0 ? anchored_islands_[island] : 0;
    if (anchored_[i] == 0) pull_[i] = 0;
  }
}

void GeometricStiffness::FindJointed(const ContactProblem& problem) {
  jointed_.assign(problem.bodies.size(), 0);
  const auto mark = [this](const auto& between) {
    // kWorld, and bodies that are not there, are past the end
    for (const int body : {between.body_a, between.body_b}) {
      if (static_cast<size_t>(body) < jointed_.size()) jointed_[body] = 1;
    }
  };
  for (const Joint& joint : problem.joints) mark(joint);
  for (const Row& row : problem.rows) {
    if (row.parent == kNoRow && IsTwoSided(row.lo, row.hi)) mark(row);
  }
}

void GeometricStiffness::FindPulled(double time_step, const ContactProblem& problem,
                                    const Impulses& impulses) {
  const size_t bodies = problem.bodies.size();
  pull_.assign(bodies, 0);
  known_.assign(bodies, nullptr);
  for (size_t i = 0; i < bodies && !memories_.empty(); ++i) {
    if (CanMove(problem.bodies[i])) known_[i] = Find(problem.bodies[i], static_cast<int>(i));
  }
  const auto asks = [this](int body) { return body != kWorld && known_[body] == nullptr; };
  for (const Joint& joint : problem.joints) {
    if (!asks(joint.body_a) && !asks(joint.body_b)) continue;
    // no triple of its rows has a longer arm or a larger impulse
    float arm_a = 0, arm_b = 0, impulse = 0;
    for (int i = 0; i < joint.rows; ++i) {
      const int k = joint.first_row + i;
      if (joint.is_angular(i) || !IsTwoSided(joint, &problem.joint_rows[joint.first_row], i))
        continue;
      const JointRow& row = problem.joint_rows[k];
      const float linear_a = Sum(row.linear_a);
      const float linear_b = joint.opposite ? linear_a : Sum(row.linear_b);
      arm_a += linear_a * Sum(row.angular_a);
      arm_b += linear_b * Sum(row.angular_b);
      impulse += std::abs(impulses.joint_rows[k]) * std::max(linear_a, linear_b);
    }
    const double half = 0.5 * static_cast<double>(impulse);
    if (joint.body_a != kWorld) pull_[joint.body_a] += half * static_cast<double>(arm_a);
    if (joint.body_b != kWorld) pull_[joint.body_b] += half * static_cast<double>(arm_b);
  }
  for (size_t i = 0; i < bodies; ++i) {
    if (known_[i] != nullptr) {
      pull_[i] = 1;
    } else if (pull_[i] != 0) {
      // Most() of a sum of |f| |r| is at most six times that; not a number: looked at
      const double ratio = time_step * 6 * pull_[i] * View(problem.bodies[i].inv_inertia).trace();
      pull_[i] = ratio < kRemember ? 0 : 1;
    }
  }
}

void GeometricStiffness::AddJoints(double time_step, const ContactProblem& problem,
                                   const Impulses& impulses) {
  for (const Joint& joint : problem.joints) {
    if (!IsPulled(joint.body_a) && !IsPulled(joint.body_b)) continue;
    const JointRow* const of_joint = &problem.joint_rows[joint.first_row];
    for (int row = 0, count = 0; row + 2 <= joint.rows; row += count) {
      if (joint.is_angular(row)) {
        count = 1;
        continue;
      }
      const float* const impulse = &impulses.joint_rows[joint.first_row + row];
      const bool at_point = row + 3 <= joint.rows && PullAlike(joint, of_joint, row, 3);
      if (at_point && AreWorldAxes(joint, of_joint, row)) {
        count = 3;
        AddAlongWorldAxes(time_step, joint, of_joint + row, impulse);
        continue;
      }
      const bool along_axes = at_point && ThreeAreAxes(joint, of_joint, row);
      const bool in_plane = !along_axes && PullInPlane(joint, of_joint, row, problem.bodies);
      count = along_axes ? 3 : in_plane ? 2 : 1;
      if (count == 1) continue;
      const RowTriple rows = ReadTriple(joint, of_joint, row, count);
      Eigen::Vector3d lambda = Eigen::Vector3d::Zero();
      for (int k = 0; k < count; ++k) lambda[k] = impulse[k];
      const auto add = [&](int body, const Eigen::Matrix3d& linear,
                           const Eigen::Matrix3d& angular) {
        if (!IsPulled(body)) return;
        const Eigen::Vector3d arm = in_plane ? ArmInPlane(linear, angular) : ArmOf(linear, angular);
        Add(body, arm, linear * lambda / time_step);
      };
      add(joint.body_a, rows.linear_a, rows.angular_a);
      add(joint.body_b, rows.linear_b, rows.angular_b);
    }
  }
}

void GeometricStiffness::AddAlongWorldAxes(double time_step, const Joint& joint,
                                           const JointRow* rows, const float* impulse) {
  const Eigen::Vector3d force = Eigen::Vector3d(impulse[0], impulse[1], impulse[2]) / time_step;
  if (IsPulled(joint.body_a)) {
    Add(joint.body_a, ArmOfWorldAxes(rows[0].angular_a, rows[1].angular_a, rows[2].angular_a),
        force);
  }
  if (IsPulled(joint.body_b)) {
    // its arm is the opposite of that, and its force: their products are the same
    Add(joint.body_b, ArmOfWorldAxes(rows[0].angular_b, rows[1].angular_b, rows[2].angular_b),
        force);
  }
}

void GeometricStiffness::AddRows(double time_step, const ContactProblem& problem,
                                 const Impulses& impulses) {
  const auto joins = [](const Row& row, const Row& first) {
    return row.parent == kNoRow && IsTwoSided(row.lo, row.hi) && row.body_a == first.body_a &&
           row.body_b == first.body_b;
  };
  for (size_t i = 0; i + 3 <= problem.rows.size();) {
    const Row* const rows = &problem.rows[i];
    Eigen::Matrix3d linear_a, angular_a, linear_b, angular_b;
    bool joint = true;
    for (int k = 0; k < 3 && joint; ++k) {
      joint = joins(rows[k], rows[0]);
      linear_a.col(k) = View(rows[k].linear_a);
      angular_a.col(k) = View(rows[k].angular_a);
      linear_b.col(k) = View(rows[k].linear_b);
      angular_b.col(k) = View(rows[k].angular_b);
    }
    if (!joint ||
        !AreAxes([&](int k) { return (rows[0].body_a != kWorld ? linear_a : linear_b).col(k); })) {
      ++i;
      continue;
    }
    const Eigen::Vector3d lambda(impulses.rows[i], impulses.rows[i + 1], impulses.rows[i + 2]);
    const auto add = [&](int body, const Eigen::Matrix3d& linear, const Eigen::Matrix3d& angular) {
      if (IsAnchored(body)) Add(body, ArmOf(linear, angular), linear * lambda / time_step);
    };
    add(rows[0].body_a, linear_a, angular_a);
    add(rows[0].body_b, linear_b, angular_b);
    i += 3;
  }
}

void GeometricStiffness::Learn(double time_step, const ContactProblem& problem,
                               const Impulses& impulses, const Report& report) {
  const size_t bodies = problem.bodies.size();
  const bool jointed = !problem.joints.empty() || !problem.rows.empty();
  if ((memories_.empty() && !jointed) || !report.ok() || !(time_step > 0) ||
      report.island_of.size() != bodies) {
    return;
  }
  // what is known is pointed at from here on
  if (!memories_.empty()) memories_.reserve(bodies);
  FindPulled(time_step, problem, impulses);
  const auto pulls = [](double pull) { return pull != 0; };
  if (memories_.empty() && problem.rows.empty() &&
      std::none_of(pull_.begin(), pull_.end(), pulls)) {
    return;
  }
  stepped_.assign(bodies, 0);
  for (size_t i = 0; i < bodies; ++i) {
    const int island = report.island_of[i];
    stepped_[i] = island >= 0 && report.islands[island].steps_accepted > 0 ? 1 : 0;
  }
  FindAnchored(problem, report);
  memories_.reserve(bodies);
  by_key_.reserve(bodies);
  pulled_.reserve(bodies);
  sums_.reserve(bodies);
  pulled_.clear();
  sums_.clear();
  place_.assign(bodies, -1);
  FindJointed(problem);
  AddJoints(time_step, problem, impulses);
  AddRows(time_step, problem, impulses);
  Remember(time_step, problem.bodies);
}

void GeometricStiffness::Remember(double time_step, std::span<const Body> bodies) {
  const double step2 = time_step * time_step;
  fresh_.clear();
  fresh_.reserve(pulled_.size());
  for (Memory& memory : memories_) {
    memory.seen = false;
    memory.absent = true;
  }
  for (size_t i = 0; i < bodies.size() && !memories_.empty(); ++i) {
    if (known_[i] == nullptr) continue;
    Memory& memory = *known_[i];
    memory.absent = false;
    memory.place = static_cast<int>(i);
    memory.seen = memory.inv_mass == bodies[i].inv_mass && jointed_[i] != 0;
    const double keep = stepped_[i] != 0 ? 0 : kKeep;
    View(memory.stiffness) *= keep;
    View(memory.arms) *= keep;
  }
  for (size_t p = 0; p < pulled_.size(); ++p) {
    const Body& body = bodies[pulled_[p]];
    const double inv_inertia = View(body.inv_inertia).trace();
    Memory* memory = known_[pulled_[p]];
    const bool known = memory != nullptr && memory->inv_mass == body.inv_mass;
    const Matrix3 sum = sums_[p].stiffness.Whole(), arms = sums_[p].arms.Whole();
    if (!known && step2 * Most(sum) * inv_inertia < kRemember) continue;
    if (!known) {
      if (memory == nullptr) memory = &fresh_.emplace_back();
      // one that is known may have been lowered
      *memory = {.key = BodyNameOf(body, pulled_[p]),
                 .place = pulled_[p],
                 .inv_mass = body.inv_mass,
                 .inv_inertia = inv_inertia};
    }
    memory->absent = false;
    const double newest = stepped_[pulled_[p]] != 0 ? 1 : 1 - kKeep;
    View(memory->stiffness) += newest * View(sum);
    View(memory->arms) += newest * View(arms);
    memory->seen = true;
  }
  KeepAbsent();
  std::erase_if(memories_, [step2](const Memory& memory) {
    const double most = std::max(Most(memory.stiffness) * memory.inv_inertia, memory.held_ratio);
    return !memory.seen || step2 * most < kRemember / 2;
  });
  memories_.insert(memories_.end(), fresh_.begin(), fresh_.end());
  NotePlaces(bodies);
}

}  // namespace cairn
