// SPDX-License-Identifier: MIT
#include "fast_group.h"

#include <algorithm>
#include <utility>

#include "cairn/detail/bad_input.h"
#include "cairn/detail/spans.h"
#include "cairn/detail/start.h"
#include "contacts/prefetch_manifold.h"
#include "write_back.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

/// What the world says, but of friction what options do.
btContactSolverInfo ForContacts(const btContactSolverInfo& info, const Options& options) {
  btContactSolverInfo result = info;
  const bool by_user = (info.m_solverMode & SOLVER_ENABLE_FRICTION_DIRECTION_CACHING) != 0;
  if (options.two_friction_directions && !by_user) {
    result.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  }
  return result;
}

}  // namespace

void FastGroup::Read(const Group& group, const btContactSolverInfo& info, SweepLimits limits,
                     const Options& options, int substeps, detail::Threads* threads) {
  threads_ = threads;
  pushes_.Clear();
  // what is known of a world says nothing of another one; its info is its own
  if (std::exchange(world_, &info) != &info) Reset();
  steps_before_ = steps_;
  steps_.last = info.m_timeStep;
  substeps_ = substeps;
  if (!options.geometric_stiffness) stiffness_.Reset();
  bodies_.Begin(group.bodies, info, threads_);
  if (options.geometric_stiffness) {
    const SpanClock clock(threads_->recorder(), 0, {SpanKind::kTension});
    bodies_.Stiffen(group.joints, info.m_timeStep / btScalar(substeps), &stiffness_);
  }

  const bool warm = (info.m_solverMode & SOLVER_USE_WARMSTARTING) != 0;
  const btScalar factor = warm ? info.m_warmstartingFactor : btScalar(0);
  joint_memory_.Begin(group.joints, options.warm_start_joints ? factor : btScalar(0), steps_.last,
                      group.units_per_metre, &group_);
  joint_builder_.Append(group.joints, info, limits, options.contacts);

  const double longer =
      ShareOfStart(static_cast<double>(steps_before_.last), static_cast<double>(steps_.last));
  const btScalar of_contact = factor * static_cast<btScalar>(longer);
  const ContactStart start{of_contact, options.warm_start_friction ? of_contact : btScalar(0),
                           &twist_memory_};
  twist_memory_.Begin();
  const ContactSoftness softness(info, options, steps_.resting.Next(info.m_timeStep));
  const btContactSolverInfo of_contacts = ForContacts(info, options);
  const FrictionBounds bounds =
      options.two_friction_directions ? FrictionBounds::kOfSlide : FrictionBounds::kApart;
  contacts_.Begin(of_contacts, limits, bounds, softness, start);
  const bool all = options.contacts == ContactForm::kManifolds && threads_->several() &&
                   contacts_.AppendAll(group.manifolds, &bodies_, &pushes_, threads_);
  if (!all)
    ReadContacts(group.manifolds, of_contacts, limits, bounds, options.contacts, softness, start);
  contacts_.End();
  FindMotions();
}

void FastGroup::ReadContacts(std::span<btPersistentManifold* const> manifolds,
                             const btContactSolverInfo& info, SweepLimits limits,
                             FrictionBounds bounds, ContactForm form,
                             const ContactSoftness& softness, const ContactStart& start) {
  const ContactTerms terms(info, limits);
  ContactRowBuilder builder(terms, bodies_, &group_, &pushes_);
  ManifoldInput input;
  for (size_t i = 0; i < manifolds.size(); ++i) {
    PrefetchAhead(manifolds, i, PrefetchPoints::kYes);
    btPersistentManifold* const manifold = manifolds[i];
    const bool taken =
        form == ContactForm::kManifolds && contacts_.Append(manifold, &bodies_, &pushes_);
    if (taken) continue;
    ReadManifold(manifold, info, bounds, softness, start, &bodies_, &input);
    builder.Append(input);
  }
}

void FastGroup::FindMotions() {
  constexpr int kBodiesOfPart = 512;
  const bool wanted =
      substeps_ > 1 || !contacts_.manifolds().empty() || !group_.compact_joints.empty();
  velocities_.resize(bodies_.size());
  motions_.resize(wanted ? bodies_.size() : 0);
  const auto put = [](const btVector3& from, float* to) {
    for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
  };
  const auto find = [&](int first, int count) {
    for (int i = first; i < first + count; ++i) {
      velocities_[i] = {};
      if (!wanted) continue;
      const Motion& motion = bodies_.motion(i);
      put(motion.velocity + motion.external_velocity, motions_[i].free_velocity);
      put(motion.spin + motion.external_spin, motions_[i].free_spin);
      put(motion.velocity, motions_[i].start_velocity);
      put(motion.spin, motions_[i].start_spin);
    }
  };
  threads_->For(bodies_.size(), kBodiesOfPart, find, {SpanKind::kRead});
}

int FastGroup::rows() const {
  // a normal and two directions of friction
  return static_cast<int>(3 * contacts_.points().size() + group_.rows.size() +
                          group_.joint_rows.size());
}

ContactProblem FastGroup::problem() const {
  return {.bodies = bodies_.bodies(),
          .rows = group_.rows,
          .manifolds = contacts_.manifolds(),
          .points = contacts_.points(),
          .contact_law = contacts_.law(),
          .motions = motions_,
          .twists = contacts_.twists(),
          .joints = group_.compact_joints,
          .joint_rows = group_.joint_rows,
          .joint_errors = group_.joint_errors,
          .time_step = static_cast<double>(steps_.last)};
}

void FastGroup::Learn(const btContactSolverInfo& info, const Report& report) {
  stiffness_.Learn(info.m_timeStep, problem(), impulses(), report);
}

bool FastGroup::FitsBullet() const {
  return bullet::FitsBullet(group_, bodies_, velocities_, threads_);
}

void FastGroup::Write(const btContactSolverInfo& info, std::span<const Velocity> means) {
  pushes_.Solve(info, bodies_.size());
  WriteContacts(group_, info);
  contacts_.Write(threads_);
  WriteJoints(group_, info);
  if (!means.empty()) MoveBodies(bodies_, {velocities_, means, substeps_}, info);
  WriteBodies(bodies_, velocities_, pushes_, info, threads_);
  joint_memory_.Keep(group_);
  twist_memory_.Keep(group_);
  contacts_.Keep(&twist_memory_);
}

BadThings FastGroup::FindBad() {
  const BadInput bad = FindBadInput(problem(), impulses());
  const auto holds = [](const std::vector<int>& places, int first, int count) {
    const auto found = std::lower_bound(places.begin(), places.end(), first);
    return found != places.end() && *found < first + count;
  };
  BadThings things;
  for (const int body : bad.bodies) things.bodies.push_back(&bodies_.rigid(body));
  int compact = 0;
  for (const JointRows& joint : group_.joints) {
    const bool is_bad = joint.written_out ? holds(bad.rows, joint.first_row, joint.rows)
                                          : holds(bad.joints, compact++, 1);
    if (is_bad) things.joints.push_back(joint.joint);
  }
  for (const PointRows& point : group_.points) {
    const bool is_bad = holds(bad.rows, point.normal_row, 1) ||
                        holds(bad.rows, point.friction_row, point.frictions) ||
                        holds(bad.rows, point.twist_row, point.twists);
    if (is_bad) things.points.push_back(point.point);
  }
  for (const int i : bad.manifolds) {
    const Manifold& manifold = contacts_.manifolds()[i];
    const auto points = contacts_.sources().subspan(manifold.first_point, manifold.points);
    things.points.insert(things.points.end(), points.begin(), points.end());
  }
  return things;
}

void FastGroup::Unread() {
  steps_ = steps_before_;
  joint_memory_.Unread(&group_);
}

void FastGroup::Rest() {
  joint_memory_.Keep(group_);
  twist_memory_.Forget();
}

void FastGroup::Forget() {
  steps_ = {};
  joint_memory_.Forget();
  twist_memory_.Forget();
  stiffness_.Reset();
}

void FastGroup::Reset() {
  Forget();
  bodies_.Forget();
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
