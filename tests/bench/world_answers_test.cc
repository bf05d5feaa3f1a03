// SPDX-License-Identifier: MIT
#include "verify/world_answers.h"

#include <gtest/gtest.h>

namespace cairn::verify {
namespace {

TEST(Golden, AnswersOfWorldsAreTheGoldenOnes) {
  for (const Difference& difference : Compare(GoldenWorldAnswers(), WorldAnswers())) {
    ADD_FAILURE() << Describe(difference);
  }
}

}  // namespace
}  // namespace cairn::verify
