// SPDX-License-Identifier: MIT
#pragma once

#include "measure/contact_frame.h"

namespace cairn::bench {

/// The frame after the one in which the second ball touches its wall.
inline constexpr int kImpactFrame = 118;

/// All contacts of the castle at its default size in one frame, counted from 0 as in
/// Scene::BeforeStep(): the rows that Bullet's sequential impulses are given in that frame, and the
/// impulses they find. Bodies are at rest, what they bring along is in the targets of the rows
/// (bullet::GroupRows).
///
/// Bullet makes the frames before, not Cairn: the problem stays the same when Cairn changes. It
/// differs between the two precisions of Bullet.
/// @pre frame >= 0. Takes one step of the world for each frame up to it.
ContactFrame CastleFrame(int frame);

}  // namespace cairn::bench
