// SPDX-License-Identifier: MIT
// A program that links watched_new.cc gets an operator new that counts, and fails when told to.
#pragma once

namespace cairn::test {

/// Calls of operator new so far, on all threads.
long NewCalls();
/// Of these, calls from within a Solve(), where a Solver takes its memory from elsewhere.
long NewCallsPastMemory();
/// From now on lets so many calls of operator new succeed, on all threads, and the next one fail; a
/// negative number lets all succeed.
void FailNewAfter(long calls);

}  // namespace cairn::test
