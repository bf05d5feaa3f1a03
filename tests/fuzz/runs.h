// SPDX-License-Identifier: MIT
// What fuzz targets do, without clang: random bytes from fixed seeds, and what fuzzers found.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace cairn::test {

/// Says which promise was broken, or nothing.
using FuzzTarget = std::string (*)(std::span<const std::uint8_t>);

/// Expects no broken promise of that many inputs of up to @p most_bytes; CAIRN_FUZZ_RUNS and
/// CAIRN_FUZZ_SEED ask for others.
void RunRandom(FuzzTarget target, int runs, int most_bytes);
/// Of the inputs in tests/fuzz/corpus/NAME.
void RunCorpus(FuzzTarget target, const std::string& name);

}  // namespace cairn::test
