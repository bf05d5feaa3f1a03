// SPDX-License-Identifier: MIT
#include "reference/pack.h"

#include <algorithm>

#include "problem/locked_axes.h"
#include "problem/relaxation.h"

namespace cairn {

Packer::Packer(const ContactProblem& problem, const Settings& settings)
    : problem_(problem),
      omega_(OmegaOf(settings)),
      leaves_locked_(settings.tuning.lifted_friction != detail::LiftedFriction::kHold),
      bodies_(problem.bodies.size()),
      local_(problem.bodies.size(), 0),
      local_row_(problem.rows.size(), kNoRow) {
  for (size_t i = 0; i < bodies_.size(); ++i) Whiten(problem.bodies[i], &bodies_[i]);
}

Vector6 Packer::WhitenRow(int body, const Eigen::Vector3d& linear, const Eigen::Vector3d& angular,
                          double* diagonal) const {
  Vector6 g{};
  if (body == kWorld) return g;
  Eigen::Map<Eigen::Vector3d>(g.data()) = bodies_[body].linear.cwiseProduct(linear);
  Eigen::Map<Eigen::Vector3d>(g.data() + 3) = bodies_[body].angular.transpose() * angular;
  const Body& of = problem_.bodies[body];
  if (leaves_locked_ && HasLockedAxes(of)) {
    const LockedSide side = LookAtLocked(of, linear.squaredNorm(), angular.squaredNorm(),
                                         std::span<const double, 6>(g));
    if (side.alone) g = {};
    *diagonal += side.extra;
  }
  *diagonal += Dot(g, g);
  return g;
}

PackedRow Packer::PackRow(const Row& row) const {
  PackedRow packed;
  packed.diagonal = 0;
  packed.g_a = WhitenRow(row.body_a, row.linear_a, row.angular_a, &packed.diagonal);
  packed.g_b = WhitenRow(row.body_b, row.linear_b, row.angular_b, &packed.diagonal);
  packed.a = row.body_a == kWorld ? 0 : local_[row.body_a];
  packed.b = row.body_b == kWorld ? 0 : local_[row.body_b];

  packed.target = row.target;
  const auto subtract = [&](int body, const Eigen::Vector3d& j_v, const Eigen::Vector3d& j_w) {
    if (body == kWorld) return;
    packed.target -=
        j_v.dot(View(bodies_[body].free.linear)) + j_w.dot(View(bodies_[body].free.angular));
  };
  subtract(row.body_a, row.linear_a, row.angular_a);
  subtract(row.body_b, row.linear_b, row.angular_b);

  packed.compliance = row.compliance;
  packed.diagonal += row.compliance;
  packed.step = packed.diagonal > 0 ? omega_ * row.relaxation / packed.diagonal : 0;
  packed.lo = row.lo;
  packed.hi = row.hi;
  packed.friction = row.friction;
  packed.parent = row.parent == kNoRow ? kNoRow : local_row_[row.parent];
  packed.max_sweeps = row.host.max_sweeps;
  packed.angular = View(row.linear_a).isZero(0) && View(row.linear_b).isZero(0);
  return packed;
}

PackedIsland Packer::Pack(const Island& island) const {
  PackedIsland packed;
  packed.bodies = static_cast<int>(island.bodies.size());
  for (int i = 0; i < packed.bodies; ++i) {
    local_[island.bodies[i]] = i + 1;
    const double inv_mass = problem_.bodies[island.bodies[i]].inv_mass;
    const double mass = inv_mass > 0 ? 1 / inv_mass : 0;
    packed.mass += mass;
    const WhitenedBody& whitened = bodies_[island.bodies[i]];
    packed.motions.push_back(
        {SeenFreeVelocity(problem_, whitened, island.bodies[i]), whitened.linear, mass});
  }
  for (int i = 0; i < static_cast<int>(island.rows.size()); ++i) local_row_[island.rows[i]] = i;

  packed.rows.reserve(island.rows.size());
  for (int row : island.rows) packed.rows.push_back(PackRow(problem_.rows[row]));
  return packed;
}

IslandState Packer::Start(const PackedIsland& packed, const Island& island,
                          std::span<const double> impulses) {
  IslandState state;
  state.x.resize(packed.rows.size());
  for (size_t i = 0; i < packed.rows.size(); ++i) {
    state.x[i] = Clamp(impulses[island.rows[i]], BoundsOf(packed.rows[i], state.x));
  }
  state.u.resize(packed.bodies + 1);
  RecomputeVelocities(packed, &state);
  return state;
}

namespace {

bool IsFinite(const Velocity& velocity) {
  return View(velocity.linear).allFinite() && View(velocity.angular).allFinite();
}

}  // namespace

Velocity Packer::VelocityOf(int body, const Vector6& u) const {
  return Unwhiten(bodies_[body], Eigen::Map<const Eigen::Vector3d>(u.data()),
                  Eigen::Map<const Eigen::Vector3d>(u.data() + 3));
}

int Packer::FirstNotFinite() const {
  const auto bad = std::find_if_not(bodies_.begin(), bodies_.end(),
                                    [](const WhitenedBody& body) { return IsFinite(body.free); });
  return bad == bodies_.end() ? -1 : static_cast<int>(bad - bodies_.begin());
}

bool Packer::HasFiniteVelocities(const Island& island, const IslandState& state) const {
  bool finite = true;
  for (size_t i = 0; i < island.bodies.size(); ++i) {
    finite = finite && IsFinite(VelocityOf(island.bodies[i], state.u[i + 1]));
  }
  return finite;
}

void Packer::WriteFreeVelocities(std::span<Velocity> velocities) const {
  for (size_t i = 0; i < bodies_.size(); ++i) velocities[i] = bodies_[i].free;
}

void Packer::WriteVelocities(const Island& island, const IslandState& state,
                             std::span<Velocity> velocities) const {
  for (size_t i = 0; i < island.bodies.size(); ++i) {
    velocities[island.bodies[i]] = VelocityOf(island.bodies[i], state.u[i + 1]);
  }
}

void RecomputeVelocities(const PackedIsland& island, IslandState* state) {
  for (Vector6& u : state->u) u.fill(0);
  for (size_t i = 0; i < island.rows.size(); ++i) {
    const PackedRow& row = island.rows[i];
    AddScaled(row.g_a, state->x[i], &state->u[row.a]);
    AddScaled(row.g_b, state->x[i], &state->u[row.b]);
  }
}

}  // namespace cairn
