// SPDX-License-Identifier: MIT
#pragma once

#include "measure/contact_frame.h"

namespace cairn::bench {

/// How many rows of a kind.
struct RowCount {
  int contacts = 0;   ///< Normal rows, lo = 0 and hi = infinity.
  int frictions = 0;  ///< Rows with a parent.
};

/// The part of a frame around its heaviest body (of the castle: a ball): contacts in the order in
/// which a breadth-first walk from body to body comes to them, and of these contacts, in the same
/// order, the first friction rows. A walk that ends too early goes on from the heaviest body left.
/// Bodies keep their numbers; joints are left out.
///
/// The rows left over go on pushing nobody: what they would carry is missing. That changes the
/// solution, not the kind of problem.
/// @throws std::runtime_error if the frame does not have as many rows.
ContactFrame NearestRows(const ContactFrame& frame, const RowCount& wanted);

}  // namespace cairn::bench
