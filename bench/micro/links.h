// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "micro/scene_kind.h"

namespace cairn::micro {

/// Two bodies that touch or hang together.
struct Link {
  int a, b;    ///< Bodies, counted from 1. b is 0 if that is what does not move.
  int axis;    ///< From one to the other.
  int layout;  ///< Which rows, see RowScene::layouts.
};

struct LinkedBodies {
  /// In the order of blocks: 16 that start at a multiple of 16 share no body and have one layout.
  std::vector<Link> links;
  /// Where the bodies are. They are counted in the order in which the links name them.
  std::vector<Eigen::Vector3i> cells;
};

/// The first @p count links of a large pile that fit into full blocks: boxes side by side and on
/// top of one another, up to three links a box; each box in a corner of its own, three links a box;
/// or chains of sixteen links. @pre count is a multiple of 16
LinkedBodies MakeLinks(SceneKind kind, int count);

}  // namespace cairn::micro
