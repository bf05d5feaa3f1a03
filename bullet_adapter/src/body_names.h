// SPDX-License-Identifier: MIT
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "cairn/bullet/precision.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// The number that Bullet gives to each body that it makes, and shows to nobody: nothing else tells
/// a body from one that had its address before.
int NumberOf(const btRigidBody& body);

/// By what name the bodies of a world are known from substep to substep: Body::id. The first body
/// at a place of the world has that place, plus one; those that come there after it have others.
/// When an object is removed, Bullet moves the last one to its place: that one takes its name
/// along.
class BodyNames {
 public:
  void BeginSubstep();
  /// Whether the body had this place, at least 0, when it was last entered.
  bool Knows(int place, const btRigidBody& body) const {
    return place < static_cast<int>(places_.size()) && places_[place].number == NumberOf(body) &&
           places_[place].name != 0;
  }
  /// @pre Knows() it
  std::uint64_t of(int place) const { return places_[place].name; }
  /// One that is not known there.
  void Enter(int place, const btRigidBody& body);
  void Forget();

 private:
  struct Place {
    std::uint64_t name = 0;   ///< of the body there, 0 for none
    int number = 0;           ///< its own, which Bullet gave it
    std::uint32_t given = 0;  ///< names that began at the place
  };
  /// The name of a body, its place, and the substep in which it came there.
  struct Named {
    std::uint64_t name;
    int place;
    std::int64_t since;
  };

  std::vector<Place> places_;
  /// Of all that are at a place, or were when this substep began.
  std::unordered_map<int, Named> by_number_;
  std::int64_t substep_ = 0;
  std::vector<int> displaced_;  ///< numbers of those whose place another body has taken since
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
