// SPDX-License-Identifier: MIT
#include "convert.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "cairn/strict.h"
#include "same_layout.h"

namespace cairn::c {
namespace {

// what is read where it lies: one layout in both languages
CAIRN_SAME_SIZE(CairnContactPoint, ContactPoint);
CAIRN_SAME_FIELD(CairnContactPoint, armA, ContactPoint, arm_a);
CAIRN_SAME_FIELD(CairnContactPoint, armB, ContactPoint, arm_b);
CAIRN_SAME_FIELD(CairnContactPoint, normal, ContactPoint, normal);
CAIRN_SAME_FIELD(CairnContactPoint, tangent, ContactPoint, tangent);
CAIRN_SAME_FIELD(CairnContactPoint, bias, ContactPoint, bias);
CAIRN_SAME_FIELD(CairnContactPoint, restitution, ContactPoint, restitution);
CAIRN_SAME_FIELD(CairnContactPoint, friction, ContactPoint, friction);
CAIRN_SAME_FIELD(CairnContactPoint, compliance, ContactPoint, compliance);
CAIRN_SAME_SIZE(CairnContactImpulse, ContactImpulse);
CAIRN_SAME_FIELD(CairnContactImpulse, tangential, ContactImpulse, tangential);
CAIRN_SAME_FIELD(CairnContactImpulse, heading, ContactImpulse, heading);
CAIRN_SAME_FIELD(CairnContactImpulse, direction, ContactImpulse, direction);
CAIRN_SAME_SIZE(CairnContactTwist, ContactTwist);
CAIRN_SAME_FIELD(CairnContactTwist, rolling, ContactTwist, rolling);
CAIRN_SAME_FIELD(CairnContactTwist, mostSpinning, ContactTwist, most_spinning);
CAIRN_SAME_FIELD(CairnContactTwist, mostRolling, ContactTwist, most_rolling);
CAIRN_SAME_SIZE(CairnTwistImpulse, TwistImpulse);
CAIRN_SAME_FIELD(CairnTwistImpulse, rolling, TwistImpulse, rolling);
CAIRN_SAME_SIZE(CairnManifold, Manifold);
CAIRN_SAME_FIELD(CairnManifold, bodyB, Manifold, body_b);
CAIRN_SAME_FIELD(CairnManifold, firstPoint, Manifold, first_point);
CAIRN_SAME_FIELD(CairnManifold, points, Manifold, points);
CAIRN_SAME_FIELD(CairnManifold, tangents, Manifold, tangents);
CAIRN_SAME_FIELD(CairnManifold, soft, Manifold, soft);
CAIRN_SAME_FIELD(CairnManifold, twists, Manifold, twists);
CAIRN_SAME_FIELD(CairnManifold, speeds, Manifold, speeds);
CAIRN_SAME_FIELD(CairnManifold, sweepLimit, Manifold, host.max_sweeps);
CAIRN_SAME_SIZE(CairnJointRow, JointRow);
CAIRN_SAME_FIELD(CairnJointRow, target, JointRow, target);
CAIRN_SAME_FIELD(CairnJointRow, angularA, JointRow, angular_a);
CAIRN_SAME_FIELD(CairnJointRow, compliance, JointRow, compliance);
CAIRN_SAME_FIELD(CairnJointRow, linearB, JointRow, linear_b);
CAIRN_SAME_FIELD(CairnJointRow, lo, JointRow, lo);
CAIRN_SAME_FIELD(CairnJointRow, angularB, JointRow, angular_b);
CAIRN_SAME_FIELD(CairnJointRow, hi, JointRow, hi);
CAIRN_SAME_SIZE(CairnJoint, Joint);
CAIRN_SAME_FIELD(CairnJoint, bodyB, Joint, body_b);
CAIRN_SAME_FIELD(CairnJoint, firstRow, Joint, first_row);
CAIRN_SAME_FIELD(CairnJoint, rows, Joint, rows);
CAIRN_SAME_FIELD(CairnJoint, bounded, Joint, bounded);
CAIRN_SAME_FIELD(CairnJoint, angular, Joint, angular);
CAIRN_SAME_FIELD(CairnJoint, errors, Joint, errors);
CAIRN_SAME_FIELD(CairnJoint, damping, Joint, damping);
CAIRN_SAME_FIELD(CairnJoint, soft, Joint, soft);
CAIRN_SAME_FIELD(CairnJoint, opposite, Joint, opposite);
CAIRN_SAME_FIELD(CairnJoint, sweepLimit, Joint, host.max_sweeps);
static_assert(CAIRN_WORLD == kWorld);

// enums are the same numbers
static_assert(int{cairnBadSettings} == static_cast<int>(Status::kBadSettings));
static_assert(int{cairnNotFinite} == static_cast<int>(Status::kNotFinite));
static_assert(int{cairnBadParent} == static_cast<int>(Status::kBadParent));
static_assert(int{cairnOverflow} == static_cast<int>(Status::kOverflow));
static_assert(int{cairnPgsSm} == static_cast<int>(Method::kPgsSm));
static_assert(int{cairnReference} == static_cast<int>(Path::kReference));
static_assert(int{cairnBrokeDown} == static_cast<int>(StopReason::kBrokeDown));
static_assert(int{cairnWorkSpent} == static_cast<int>(StopReason::kWorkSpent));
static_assert(int{cairnWork} == static_cast<int>(Budget::Kind::kWork));

Budget ToBudget(CairnBudgetKind kind, std::int64_t amount) {
  if (kind == cairnTime) return Budget::Time(std::chrono::nanoseconds(amount));
  return kind == cairnWork ? Budget::Work(amount) : Budget::Unlimited();
}

}  // namespace

Settings ToSettings(const CairnSettings& from) {
  Settings settings;
  settings.method = static_cast<Method>(from.method);
  settings.path = static_cast<Path>(from.path);
  settings.k_gs = from.kGs;
  settings.k_sm = from.kSm;
  settings.steps = from.steps;
  settings.relax = from.relax;
  settings.max_sweeps = from.maxSweeps;
  settings.geometric_stiffness = from.geometricStiffness;
  settings.substeps = from.substeps;
  settings.tolerance = from.tolerance;
  settings.tuning.quiet_speed = from.quietSpeed;
  settings.tuning.units_per_metre = from.unitsPerMetre;
  settings.budget = ToBudget(from.budgetKind, from.budget);
  settings.tuning.min_sweeps = from.minSweeps;
  settings.threads = from.threads;
  return settings;
}

CairnStatus ToStatus(Status status) { return static_cast<CairnStatus>(status); }

CairnReport ToReport(const Report& from) {
  const auto correction = [](const Correction& c) -> CairnCorrection { return {c.asked, c.done}; };
  return {.status = ToStatus(from.status),
          .badBody = from.bad_body,
          .badManifold = from.bad_manifold,
          .badJoint = from.bad_joint,
          .stop = static_cast<CairnStop>(from.stop),
          .path = static_cast<CairnPath>(from.path),
          .residualMax = from.residual_max,
          .residualAngular = from.residual_angular,
          .sweeps = from.sweeps,
          .factorisations = from.factorisations,
          .stepsAccepted = from.steps_accepted,
          .stepsRestored = from.steps_restored,
          .guarded = from.guarded,
          .islandCount = static_cast<std::int32_t>(from.islands.size()),
          .work = from.work,
          .elapsed = from.elapsed.count(),
          .depth = correction(from.depth),
          .gap = correction(from.gap),
          .angle = correction(from.angle)};
}

CairnIsland ToIsland(const IslandReport& from) {
  return {.firstBody = from.first_body,
          .bodies = from.bodies,
          .rows = from.rows,
          .quiet = from.quiet,
          .speed = from.speed,
          .spin = from.spin,
          .sweeps = from.sweeps,
          .factorisations = from.factorisations,
          .stepsAccepted = from.steps_accepted,
          .stepsRestored = from.steps_restored,
          .stop = static_cast<CairnStop>(from.stop),
          .guarded = from.guards.any(),
          .residualBefore = from.residual_before.max,
          .residual = from.residual.max,
          .residualAngular = from.residual.max_angular,
          .strain = from.strain,
          .strainedBody = from.strained_body,
          .enoughSubsteps = from.enough_substeps};
}

detail::Heap::Owner HeapOf(const CairnMemory& memory) {
  if (memory.allocate == nullptr) return detail::Heap::Owner(static_cast<Memory*>(nullptr));
  return detail::Heap::Owner(detail::MemorySource{memory.allocate, memory.free, memory.context});
}

template <class BodyOfC>
void CopyBodies(std::span<const BodyOfC> from, Array<Body>* to) {
  to->resize(from.size());
  const auto vector = [](const auto* v) { return Vector3(v[0], v[1], v[2]); };
  for (size_t i = 0; i < from.size(); ++i) {
    const BodyOfC& body = from[i];
    Body& result = (*to)[i];
    result.inv_mass = body.invMass;
    // symmetric, but for rounding: rows are as good as columns
    for (int k = 0; k < 9; ++k) result.inv_inertia(k / 3, k % 3) = body.invInertia[k];
    result.linear_factor = vector(body.linearFactor);
    result.velocity = {vector(body.velocity.linear), vector(body.velocity.angular)};
    result.impulse = vector(body.impulse);
    result.angular_impulse = vector(body.angularImpulse);
    result.strain = body.strain;
    result.id = body.id;
  }
}
template void CopyBodies(std::span<const CairnBody> from, Array<Body>* to);
template void CopyBodies(std::span<const CairnBodyD> from, Array<Body>* to);

template <class VelocityOfC>
void CopyVelocities(std::span<const Velocity> from, VelocityOfC* to) {
  using Number = std::remove_extent_t<decltype(to->linear)>;
  for (const Velocity& velocity : from) {
    for (int k = 0; k < 3; ++k) {
      to->linear[k] = static_cast<Number>(velocity.linear[k]);
      to->angular[k] = static_cast<Number>(velocity.angular[k]);
    }
    ++to;
  }
}
template void CopyVelocities(std::span<const Velocity> from, CairnVelocity* to);
template void CopyVelocities(std::span<const Velocity> from, CairnVelocityD* to);

std::string Describe(const Misfit& misfit) {
  const std::string count = std::string(misfit.counted) + " is " + std::to_string(misfit.count);
  if (misfit.array == nullptr) return count + ", must be at least 0";
  return std::string(misfit.array) + " is null, where " + count;
}

template <class BodyOfC>
CairnStatus Look(const CairnProblem& from, const BodyOfC* bodies, const CairnSolution& solution,
                 const void* velocities, Array<Body>* copies, View* view, Misfit* misfit) {
  struct Counted {
    const char* name;
    std::int32_t count;
    const char* array;
    const void* at;
  };
  const Counted all[] = {
      {"bodyCount", from.bodyCount, "bodies", bodies},
      {"manifoldCount", from.manifoldCount, "manifolds", from.manifolds},
      {"pointCount", from.pointCount, "points", from.points},
      {"twistCount", from.twistCount, "twists", from.twists},
      {"jointCount", from.jointCount, "joints", from.joints},
      {"jointRowCount", from.jointRowCount, "jointRows", from.jointRows},
      {"bodyCount", from.bodyCount, "velocities", velocities},
      {"pointCount", from.pointCount, "points of the solution", solution.points},
      {"twistCount", from.twistCount, "twists of the solution", solution.twists},
      {"jointRowCount", from.jointRowCount, "jointRows of the solution", solution.jointRows}};
  for (const Counted& c : all) {
    if (c.count >= 0) continue;
    *misfit = {.array = nullptr, .counted = c.name, .count = c.count};
    return cairnWrongSize;
  }
  for (const Counted& c : all) {
    if (c.count == 0 || c.at != nullptr) continue;
    *misfit = {.array = c.array, .counted = c.name, .count = c.count};
    return cairnNullPointer;
  }
  CopyBodies(std::span(bodies, static_cast<size_t>(from.bodyCount)), copies);
  view->problem = {.bodies = *copies,
                   .manifolds = Over<const Manifold>(from.manifolds, from.manifoldCount),
                   .points = Over<const ContactPoint>(from.points, from.pointCount),
                   .contact_law = {.bounce_speed = from.bounceSpeed},
                   .twists = Over<const ContactTwist>(from.twists, from.twistCount),
                   .joints = Over<const Joint>(from.joints, from.jointCount),
                   .joint_rows = Over<const JointRow>(from.jointRows, from.jointRowCount),
                   .time_step = from.timeStep};
  view->impulses = {.points = Over<ContactImpulse>(solution.points, from.pointCount),
                    .twists = Over<TwistImpulse>(solution.twists, from.twistCount),
                    .joint_rows = Over<float>(solution.jointRows, from.jointRowCount)};
  return cairnOk;
}

template CairnStatus Look(const CairnProblem&, const CairnBody*, const CairnSolution&, const void*,
                          Array<Body>*, View*, Misfit*);
template CairnStatus Look(const CairnProblem&, const CairnBodyD*, const CairnSolution&, const void*,
                          Array<Body>*, View*, Misfit*);

std::size_t PutText(std::string_view text, char* to, std::size_t size) {
  if (to != nullptr && size > 0) {
    const std::size_t copied = std::min(text.size(), size - 1);
    std::memcpy(to, text.data(), copied);
    to[copied] = '\0';
  }
  return text.size();
}

void AppendFindings(const ContactProblem& problem, const Impulses& impulses, std::string* text) {
  for (const Finding& finding : ValidateStrictly(problem, impulses)) {
    text->append(Describe(finding)).append("\n");
  }
}

}  // namespace cairn::c
