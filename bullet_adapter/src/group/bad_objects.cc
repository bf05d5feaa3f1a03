// SPDX-License-Identifier: MIT
#include "group/bad_objects.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "body_names.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

template <class Thing>
void SortAddresses(std::vector<const Thing*>* things) {
  std::sort(things->begin(), things->end(), std::less<const Thing*>());
}

template <class Thing>
bool Holds(const std::vector<const Thing*>& things, const Thing* thing) {
  return std::binary_search(things.begin(), things.end(), thing, std::less<const Thing*>());
}

std::string Count(size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

bool IsFinite(const btVector3& vector) {
  return std::isfinite(vector.x()) && std::isfinite(vector.y()) && std::isfinite(vector.z());
}

bool IsFinite(const btMatrix3x3& matrix) {
  return IsFinite(matrix[0]) && IsFinite(matrix[1]) && IsFinite(matrix[2]);
}

bool IsFinite(const btRigidBody& rigid) {
  const btTransform& pose = rigid.getWorldTransform();
  return IsFinite(pose.getOrigin()) && IsFinite(pose.getBasis()) &&
         IsFinite(rigid.getLinearVelocity()) && IsFinite(rigid.getAngularVelocity()) &&
         IsFinite(rigid.getTotalForce()) && IsFinite(rigid.getTotalTorque()) &&
         IsFinite(rigid.getInvInertiaTensorWorld()) && std::isfinite(rigid.getInvMass());
}

}  // namespace

bool BadObjects::CutThoseOfLast(const Group& group) {
  bad_ = {};
  if (last_.empty()) return false;
  for (const btCollisionObject* const body : group.bodies) {
    const btRigidBody* const rigid = btRigidBody::upcast(body);
    const bool was_bad =
        rigid != nullptr && std::find(last_.begin(), last_.end(), NumberOf(*rigid)) != last_.end();
    if (was_bad && !IsFinite(*rigid)) bad_.bodies.push_back(body);
  }
  Sort(group);
  return !bad_.bodies.empty();
}

bool BadObjects::Cut(const Group& group, const BadThings& more, const std::string& why) {
  if (more.bodies.empty() && more.joints.empty()) return false;
  complaint_ = why + "; left out: ";
  if (more.bodies.empty()) {
    complaint_ += Count(more.joints.size(), "joint", "joints");
  } else {
    complaint_ += Count(more.bodies.size(), "body", "bodies") + ", with index " +
                  std::to_string(more.bodies.front()->getWorldArrayIndex()) + " in its world" +
                  (more.bodies.size() > 1 ? " the first" : "");
  }
  bad_.bodies.insert(bad_.bodies.end(), more.bodies.begin(), more.bodies.end());
  bad_.joints = more.joints;
  Sort(group);
  return true;
}

bool BadObjects::IsBad(const btCollisionObject& body) const { return Holds(bad_.bodies, &body); }

void BadObjects::Sort(const Group& group) {
  SortAddresses(&bad_.bodies);
  SortAddresses(&bad_.joints);
  last_.clear();
  for (const btCollisionObject* const body : bad_.bodies) {
    const btRigidBody* const rigid = btRigidBody::upcast(body);
    if (rigid != nullptr) last_.push_back(NumberOf(*rigid));
  }
  units_per_metre_ = group.units_per_metre;
  others_.Clear();
  for (btCollisionObject* const body : group.bodies) {
    if (!IsBad(*body)) others_.bodies.push_back(body);
  }
  for (btPersistentManifold* const manifold : group.manifolds) {
    if (IsBad(*manifold->getBody0()) || IsBad(*manifold->getBody1())) continue;
    others_.manifolds.push_back(manifold);
  }
  for (btTypedConstraint* const joint : group.joints) {
    const btCollisionObject &a = joint->getRigidBodyA(), &b = joint->getRigidBodyB();
    const bool bad =
        IsBad(a) || IsBad(b) || Holds(bad_.joints, static_cast<const btTypedConstraint*>(joint));
    if (!bad) others_.joints.push_back(joint);
  }
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
