// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace cairn::cli {

/// How a run uses the machine.
struct Setup {
  int threads = 1;            ///< That Cairn may use.
  std::string simd;           ///< The target that Cairn was told to use; empty: the best.
  std::optional<int> pinned;  ///< The core that everything stays on.
};

/// A setup as typed; empty texts are not asked for. @throws Failure (kUsage)
Setup ParseSetup(const std::string& threads, const std::string& simd, const std::string& core);

/// Makes it so for this process. @throws Failure (kUsage) for a target or core that this machine
/// does not have, with those that it has.
void Apply(const Setup& setup);

/// "1 thread, avx2 asked for, pinned to core 0"
std::string Describe(const Setup& setup);

nlohmann::ordered_json ToJson(const Setup& setup);

}  // namespace cairn::cli
