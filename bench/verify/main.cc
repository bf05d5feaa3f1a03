// SPDX-License-Identifier: MIT
// Says whether this machine gives the answers of the golden files, or prints its own:
//   cairn_answers [--print | --target]
// The target is the instruction set that kernels use here.
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "simd/target.h"
#include "verify/answers.h"
#ifdef CAIRN_VERIFY_WORLDS
#include "verify/world_answers.h"
#endif

int main(int count, char** arguments) {
  using namespace cairn::verify;
  if (count == 2 && std::strcmp(arguments[1], "--target") == 0) {
    std::printf("%s\n", std::string(TargetName(cairn::simd::ChooseTarget().target)).c_str());
    return 0;
  }
#ifdef CAIRN_VERIFY_WORLDS
  const std::vector<Answer> now = WorldAnswers(), golden = GoldenWorldAnswers();
#else
  const std::vector<Answer> now = CoreAnswers(), golden = GoldenCoreAnswers();
#endif
  if (count == 2 && std::strcmp(arguments[1], "--print") == 0) {
    for (const Answer& answer : now) std::printf("%s\n", ToLine(answer).c_str());
    return 0;
  }
  const std::vector<Difference> differences = Compare(golden, now);
  for (const Difference& difference : differences) {
    std::printf("%s\n", Describe(difference).c_str());
  }
  std::printf("%zu of %zu answers are the golden ones\n", now.size() - differences.size(),
              now.size());
  return differences.empty() ? 0 : 1;
}
