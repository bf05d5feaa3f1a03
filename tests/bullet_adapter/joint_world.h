// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <string_view>
#include <vector>

#include "scenes/world.h"

namespace cairn::test {

/// A kind of joint, with limits, motors or springs.
struct JointKind {
  std::string_view name;
  std::function<std::unique_ptr<btTypedConstraint>(btRigidBody*, btRigidBody*)> make;
};

/// For messages of tests.
inline void PrintTo(const JointKind& kind, std::ostream* out) { *out << kind.name; }

/// Every kind that Bullet ships, in the forms that give rows of their own.
const std::vector<JointKind>& JointKinds();

/// A short chain of unlike boxes on joints of that kind, hung from a static one, with spin, torque
/// and locked axes: nothing about it is symmetric.
void BuildJointWorld(const JointKind& kind, bench::World* world);

}  // namespace cairn::test
