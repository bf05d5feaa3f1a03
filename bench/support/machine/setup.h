// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "simd/target.h"

namespace cairn::cli {

/// How a run uses the machine.
struct Setup {
  int threads = 1;            ///< That Cairn may use.
  std::string simd;           ///< The target that Cairn was told to use; empty: the best.
  std::optional<int> pinned;  ///< The core that everything stays on.
};

/// A setup as typed; empty texts are not asked for. @throws Failure (kUsage)
Setup ParseSetup(const std::string& threads, const std::string& simd, const std::string& core);

/// Makes it so for this process, and warns as WarnOfTarget() does where no target is asked for.
/// @throws Failure (kUsage) for a target or core that this machine
/// does not have, with those that it has.
void Apply(const Setup& setup);

/// "CAIRN_SIMD='avx9' is no target, this CPU has: scalar sse4"; empty where Cairn has the target
/// that CAIRN_SIMD asks for, or none is asked for.
std::string WhyNotTarget();

/// Says so on stderr, and which target is taken instead: Cairn itself prints nothing.
/// @param program  what the line begins with: "cairn"
void WarnOfTarget(std::string_view program = "cairn");

/// While it lives, solvers that are made use this instruction set.
class ForcedTarget {
 public:
  explicit ForcedTarget(simd::Target target);
  ~ForcedTarget();
  ForcedTarget(const ForcedTarget&) = delete;
  ForcedTarget& operator=(const ForcedTarget&) = delete;

 private:
  std::optional<std::string> before_;
};

/// "1 thread, avx2 asked for, pinned to core 0"
std::string Describe(const Setup& setup);

nlohmann::ordered_json ToJson(const Setup& setup);

}  // namespace cairn::cli
