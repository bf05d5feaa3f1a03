// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "measure/contact_frame.h"
#include "rigid/condition.h"
#include "rigid/contact_model.h"

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

/// One of the ten problems in the talk about [1] (boxed_lcp.h), which come from a demo of ODE in
/// which a castle is shot at.
struct CastleSize {
  int equations = 0;     ///< n_a
  int inequalities = 0;  ///< n_b
  double condition = 0;  ///< Of J M^-1 J' + E.
};

/// Numbers 1 to 10 of the talk, but for the condition numbers of 7, 8 and 9: these are ours, and
/// rise evenly from 6 to 10.
std::span<const CastleSize> CastleSizes();

/// A problem of such a size.
struct SizedCastle {
  ContactFrame frame;  ///< Ready for ToBoxed().
  /// E = share diag(J M^-1 J'), and the condition number that it leads to with bilateral friction.
  Compliance compliance;
};

/// Cuts the rows out of a frame (NearestRows(): n_b contacts, n_a friction rows) and makes them as
/// well conditioned as the talk's, if that can be: see FindCompliance().
///
/// `compliance` is that of the bilateral model whatever the model is. The pyramid has the same
/// matrix, in another order; contacts alone a part of it, with a condition number no larger.
SizedCastle MakeSizedCastle(const ContactFrame& frame, const CastleSize& size, ContactModel model);

}  // namespace cairn::bench
