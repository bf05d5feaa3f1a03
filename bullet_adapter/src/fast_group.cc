// SPDX-License-Identifier: MIT
#include "fast_group.h"

#include "write_back.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

void FastGroup::Read(const Group& group, const btContactSolverInfo& info, SweepLimits limits,
                     const Options& options) {
  group_.Clear();
  pushes_.Clear();
  bodies_.Begin(group.bodies, info);

  const bool warm = (info.m_solverMode & SOLVER_USE_WARMSTARTING) != 0;
  const btScalar factor = warm ? info.m_warmstartingFactor : btScalar(0);
  joint_memory_.Begin(group.joints, options.warm_start_joints ? factor : btScalar(0));
  joint_builder_.Append(group.joints, info, limits);

  twist_memory_.Begin();
  const ContactStart start{factor, options.warm_start_friction ? factor : btScalar(0),
                           &twist_memory_};
  const ContactLaw law(info, limits);
  ContactRowBuilder builder(law, bodies_, &group_, &pushes_);
  ManifoldInput input;
  for (btPersistentManifold* manifold : group.manifolds) {
    ReadManifold(manifold, info, start, &bodies_, &input);
    builder.Append(input);
  }
  velocities_.assign(bodies_.size(), Velocity{});
}

void FastGroup::Write(const btContactSolverInfo& info) {
  pushes_.Solve(info, bodies_.size());
  WriteContacts(group_, info);
  WriteJoints(group_, info);
  WriteBodies(bodies_, velocities_, pushes_, info);
  joint_memory_.Keep(group_);
  twist_memory_.Keep(group_);
}

void FastGroup::Forget() {
  joint_memory_.Forget();
  twist_memory_.Forget();
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
