// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

namespace cairn::cli {

/// A call of a library that prints, and ends the program where it should report.
struct GuardedCall {
  int threads = 1;  ///< Of OpenBLAS, if that is the BLAS: our clock sees one thread only.
  std::function<void()> call;
};

/// Makes the call with stdout and stderr closed, and comes back from abort(), which is how failed
/// assertions and Siconos' fatal errors end. What the call had allocated is lost then.
/// @return why it was left; empty if it returned
/// @pre no other thread prints or aborts meanwhile
std::string RunGuarded(const GuardedCall& guarded);

}  // namespace cairn::cli
