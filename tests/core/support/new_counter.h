// SPDX-License-Identifier: MIT
#pragma once

namespace cairn::test {

/// Calls of operator new so far, on all threads. A program that links new_counter.cc gets an
/// operator new that counts.
long NewCalls();

}  // namespace cairn::test
