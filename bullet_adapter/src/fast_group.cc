// SPDX-License-Identifier: MIT
#include "fast_group.h"

#include <utility>

#include "cairn/detail/prefetch.h"
#include "write_back.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

void PrefetchObject(const btCollisionObject& object) {
  const auto* const begin = reinterpret_cast<const char*>(&object);
  Prefetch(begin + 64);   // where it is
  Prefetch(begin + 192);  // its friction, and its index in the world
}

/// Manifolds lie all over the memory, and most of a large world are empty: how many points they
/// have is asked for some ahead, their points and bodies a little ahead.
void PrefetchBehind(std::span<btPersistentManifold* const> manifolds, size_t i) {
  constexpr size_t kFar = 32, kNear = 8;
  if (i + kFar < manifolds.size()) {
    // the number of points is a little before it, maybe in another line
    Prefetch(&manifolds[i + kFar]->m_companionIdA - 4, 5 * sizeof(int));
  }
  if (i + kNear >= manifolds.size()) return;
  const btPersistentManifold& near = *manifolds[i + kNear];
  if (near.getNumContacts() == 0) return;
  PrefetchObject(*near.getBody0());
  PrefetchObject(*near.getBody1());
  Prefetch(&near.getContactPoint(0), near.getNumContacts() * sizeof(btManifoldPoint));
}

}  // namespace

void FastGroup::Read(const Group& group, const btContactSolverInfo& info, SweepLimits limits,
                     const Options& options, int substeps) {
  pushes_.Clear();
  time_step_ = info.m_timeStep;
  substeps_ = substeps;
  // the tension of a world says nothing of another one; its info is its own
  if (std::exchange(world_, &info) != &info || !options.geometric_stiffness) stiffness_.Reset();
  bodies_.Begin(group.bodies, info);
  if (options.geometric_stiffness)
    bodies_.Stiffen(&stiffness_, info.m_timeStep / btScalar(substeps));

  const bool warm = (info.m_solverMode & SOLVER_USE_WARMSTARTING) != 0;
  const btScalar factor = warm ? info.m_warmstartingFactor : btScalar(0);
  joint_memory_.Begin(group.joints, options.warm_start_joints ? factor : btScalar(0), &group_);
  joint_builder_.Append(group.joints, info, limits, options.contacts);

  const ContactStart start{factor, options.warm_start_friction ? factor : btScalar(0),
                           &twist_memory_};
  ReadContacts(group.manifolds, info, limits, options.contacts, start);
  velocities_.assign(bodies_.size(), Velocity{});
}

void FastGroup::ReadContacts(std::span<btPersistentManifold* const> manifolds,
                             const btContactSolverInfo& info, SweepLimits limits, ContactForm form,
                             const ContactStart& start) {
  twist_memory_.Begin();
  contacts_.Begin(info, limits, start);
  const ContactLaw law(info, limits);
  ContactRowBuilder builder(law, bodies_, &group_, &pushes_);
  ManifoldInput input;
  for (size_t i = 0; i < manifolds.size(); ++i) {
    PrefetchBehind(manifolds, i);
    btPersistentManifold* const manifold = manifolds[i];
    const bool taken =
        form == ContactForm::kManifolds && contacts_.Append(manifold, &bodies_, &pushes_);
    if (taken) continue;
    ReadManifold(manifold, info, start, &bodies_, &input);
    builder.Append(input);
  }
  contacts_.End();
  FindMotions();
}

void FastGroup::FindMotions() {
  const bool wanted =
      substeps_ > 1 || !contacts_.manifolds().empty() || !group_.compact_joints.empty();
  motions_.resize(wanted ? bodies_.size() : 0);
  const auto put = [](const btVector3& from, float* to) {
    for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
  };
  for (size_t i = 0; i < motions_.size(); ++i) {
    const Motion& motion = bodies_.motion(static_cast<int>(i));
    put(motion.velocity + motion.external_velocity, motions_[i].free_velocity);
    put(motion.spin + motion.external_spin, motions_[i].free_spin);
    put(motion.velocity, motions_[i].start_velocity);
    put(motion.spin, motions_[i].start_spin);
  }
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
          .time_step = static_cast<double>(time_step_)};
}

void FastGroup::Learn(const btContactSolverInfo& info, const Report& report) {
  stiffness_.Learn(info.m_timeStep, problem(), impulses(), report);
}

bool FastGroup::FitsBullet() const { return bullet::FitsBullet(group_, bodies_, velocities_); }

void FastGroup::Write(const btContactSolverInfo& info, std::span<const Velocity> means) {
  pushes_.Solve(info, bodies_.size());
  WriteContacts(group_, info);
  contacts_.Write();
  WriteJoints(group_, info);
  if (!means.empty()) MoveBodies(bodies_, {velocities_, means, substeps_}, info);
  WriteBodies(bodies_, velocities_, pushes_, info);
  joint_memory_.Keep(group_);
  twist_memory_.Keep(group_);
  contacts_.Keep(&twist_memory_);
}

void FastGroup::Forget() {
  joint_memory_.Forget();
  twist_memory_.Forget();
  stiffness_.Reset();
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
