// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace cairn::cli {

/// Exit codes of the tool.
enum ExitCode {
  kFine = 0,
  kCheckFailed = 1,  ///< A solver of Cairn failed.
  kUsage = 2,        ///< The command line was not understood.
  kBadInput = 3,     ///< A file or program named by the user cannot be used.
};

/// The user asked for something that cannot be done. What() is for the user: one sentence that says
/// what is wrong and, where there is a way, how to put it right.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace cairn::cli
