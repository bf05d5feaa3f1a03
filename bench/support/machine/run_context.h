// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "support/machine/build_info.h"
#include "support/machine/machine.h"

namespace cairn::cli {

/// Where, when and how results were made.
struct RunContext {
  std::string date;     ///< ISO 8601, UTC
  std::string command;  ///< Without paths.
  BuildInfo build;
  Machine machine;
  Noise noise;
  std::string simd_target;
};

/// Looks at this machine; takes 0.3 s.
/// @param command  what was typed
RunContext DescribeContext(const std::string& command);

/// A heading, and where, with what and by which command the figures below it were made; Markdown.
std::string Origin(const std::string& title, const RunContext& context);

/// With the names of Google Benchmark where it has them; the name of the host is nobody's business.
nlohmann::ordered_json ToJson(const RunContext& context);

}  // namespace cairn::cli
