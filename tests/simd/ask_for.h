// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <string>

#include "simd/target.h"

namespace cairn::test {

/// CAIRN_SIMD while it lives: solvers that are made then use that target.
class AskFor {
 public:
  explicit AskFor(simd::Target target) {
    const char* const before = std::getenv("CAIRN_SIMD");
    was_set_ = before != nullptr;
    if (was_set_) before_ = before;
    setenv("CAIRN_SIMD", std::string(simd::TargetName(target)).c_str(), 1);
  }
  ~AskFor() {
    if (was_set_) {
      setenv("CAIRN_SIMD", before_.c_str(), 1);
    } else {
      unsetenv("CAIRN_SIMD");
    }
  }
  AskFor(const AskFor&) = delete;
  AskFor& operator=(const AskFor&) = delete;

 private:
  bool was_set_;
  std::string before_;
};

}  // namespace cairn::test
