// SPDX-License-Identifier: MIT
#include "cairn/report.h"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace cairn {
namespace {

TEST(Describe, SaysSomethingElseForEveryStatus) {
  std::set<std::string_view> sentences;
  for (int i = 0; i <= static_cast<int>(Status::kBadFriction); ++i) {
    const std::string_view sentence = Describe(static_cast<Status>(i));
    EXPECT_GT(sentence.size(), 10u) << i;
    EXPECT_NE(sentence.back(), '.') << sentence;
    EXPECT_TRUE(sentences.insert(sentence).second) << sentence;
  }
  EXPECT_EQ(sentences.count("unknown status"), 0u);
}

TEST(Describe, SaysSomethingElseForEveryStopReason) {
  std::set<std::string_view> words;
  for (int i = 0; i <= static_cast<int>(StopReason::kWorkSpent); ++i) {
    const std::string_view word = Describe(static_cast<StopReason>(i));
    EXPECT_GT(word.size(), 5u) << i;
    EXPECT_TRUE(words.insert(word).second) << word;
  }
  EXPECT_EQ(words.count("unknown reason"), 0u);
}

TEST(Describe, SaysSomethingElseForEveryReasonNotToStep) {
  std::set<std::string_view> words;
  for (int i = 0; i <= static_cast<int>(NoStep::kTooDear); ++i) {
    const std::string_view word = Describe(static_cast<NoStep>(i));
    EXPECT_GT(word.size(), 5u) << i;
    EXPECT_TRUE(words.insert(word).second) << word;
  }
  EXPECT_EQ(words.count("unknown reason"), 0u);
}

TEST(Describe, AnswersNumbersThatAreNoStatus) {
  EXPECT_EQ(Describe(static_cast<Status>(99)), "unknown status");
  EXPECT_EQ(Describe(static_cast<StopReason>(99)), "unknown reason");
  EXPECT_EQ(Describe(static_cast<NoStep>(99)), "unknown reason");
}

}  // namespace
}  // namespace cairn
