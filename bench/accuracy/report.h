// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "measure/velocity_norm.h"
#include "support/machine/run_context.h"

namespace cairn::accuracy {

/// Prints a heading, and where, with what and by which command the figures below it were made.
void PrintContext(const std::string& title, const cli::RunContext& context);

/// Of a file: who wrote it, in which form, and under which circumstances.
nlohmann::ordered_json JsonHead(const std::string& subcommand, const cli::RunContext& context);

/// Does nothing without a path. @throws cli::Failure
void WriteJson(const std::string& path, const nlohmann::ordered_json& json);

/// {"rms_m_s": ..., "max_m_s": ...}
nlohmann::ordered_json ToJson(const bench::VelocityDistance& distance);

/// Three digits: "0.00123", "-" for what was not measured.
std::string Digits(double value);

}  // namespace cairn::accuracy
