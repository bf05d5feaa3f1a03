// SPDX-License-Identifier: MIT
#pragma once

namespace cairn::test {

/// From now on lets so many calls of operator new succeed, on all threads, and the next one fail; a
/// negative number lets all succeed. A program that links failing_new.cc gets such an operator new.
void FailNewAfter(long calls);
/// Calls since FailNewAfter().
long NewCallsSince();

}  // namespace cairn::test
