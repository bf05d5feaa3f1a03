// SPDX-License-Identifier: MIT
#pragma once

#include "measure/contact_frame.h"

namespace cairn::bench {

/// What becomes of friction, whose law (bounds that follow another impulse) a matrix cannot say.
/// Rows without a parent, contacts and joints, keep their bounds in all three.
enum class ContactModel {
  kNormals,    ///< No friction.
  kBilateral,  ///< Friction never slips: two equations for each contact, as in the paper.
  kPyramid,  ///< Slips beyond friction times the impulse its parent has in ContactFrame::impulses.
};

/// The same frame with that model: no row has a parent any more. Equations come first (rows without
/// bounds, u of a MixedLcp), the rest after them, both in the order they had.
ContactFrame ApplyModel(const ContactFrame& frame, ContactModel model);

/// The same frame with compliance `share` times J_i M^-1 J_i' in every row, instead of what it had.
ContactFrame WithCompliance(const ContactFrame& frame, double share);

/// Rows without bounds.
int Equations(const ContactFrame& frame);

}  // namespace cairn::bench
