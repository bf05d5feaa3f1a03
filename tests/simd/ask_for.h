// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <string>

#include "simd/target.h"
#include "tests/simd/environment.h"

namespace cairn::test {

/// CAIRN_SIMD while it lives: solvers that are made then use that target.
class AskFor {
 public:
  explicit AskFor(simd::Target target) {
    const char* const before = std::getenv("CAIRN_SIMD");
    if (before != nullptr) before_ = before;
    SetVariable("CAIRN_SIMD", std::string(simd::TargetName(target)));
  }
  ~AskFor() { SetVariable("CAIRN_SIMD", before_); }
  AskFor(const AskFor&) = delete;
  AskFor& operator=(const AskFor&) = delete;

 private:
  std::string before_;
};

}  // namespace cairn::test
