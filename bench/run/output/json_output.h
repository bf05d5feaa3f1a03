// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "run/result.h"

namespace cairn::cli {

/// The whole result, "schema_version": 1: `context` says where and how it was made, `scenes` holds
/// for each solver its summary and arrays with one value per frame. What was not measured is null.
/// docs/run.schema.json describes it.
std::string ToJson(const RunResult& run);

}  // namespace cairn::cli
