// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

namespace cairn::micro {

/// What is between the bodies of a scene.
enum class SceneKind {
  kContact,        ///< Manifolds of four points between movable bodies, with friction.
  kMixedContact,   ///< The same with one to four points.
  kStaticContact,  ///< Manifolds of four points with what does not move.
  kJoint,          ///< Hinges with a motor of limited strength: 5 rows without bounds and 1 with.
};

inline constexpr std::array kSceneKinds = {SceneKind::kContact, SceneKind::kMixedContact,
                                           SceneKind::kStaticContact, SceneKind::kJoint};

/// As it stands in the names of benchmarks.
constexpr std::string_view NameOf(SceneKind kind) {
  switch (kind) {
    case SceneKind::kContact:
      return "contact";
    case SceneKind::kMixedContact:
      return "mixed_contact";
    case SceneKind::kStaticContact:
      return "static_contact";
    case SceneKind::kJoint:
      return "joint";
  }
  return "";
}

}  // namespace cairn::micro
