// SPDX-License-Identifier: MIT
#include "verify/answers.h"

#include <algorithm>
#include <charconv>

namespace cairn::verify {

void Hash::Add(const void* bytes, std::size_t size) {
  const auto* const begin = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ begin[i]) * 0x100000001b3u;
}

std::string ToLine(const Answer& answer) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string line = answer.name;
  for (const std::uint64_t mark : answer.marks) {
    line += ' ';
    for (int shift = 60; shift >= 0; shift -= 4) line += kDigits[mark >> shift & 15];
  }
  return line;
}

Answer FromLine(std::string_view line) {
  Answer answer;
  std::size_t space = line.find(' ');
  answer.name = line.substr(0, space);
  while (space != std::string_view::npos) {
    const std::size_t end = std::min(line.find(' ', space + 1), line.size());
    std::uint64_t mark = 0;
    std::from_chars(line.data() + space + 1, line.data() + end, mark, 16);
    answer.marks.push_back(mark);
    space = end < line.size() ? end : std::string_view::npos;
  }
  return answer;
}

std::vector<Difference> Compare(std::span<const Answer> golden, std::span<const Answer> now) {
  std::vector<Difference> differences;
  const auto find = [](std::span<const Answer> list, const std::string& name) {
    return std::find_if(list.begin(), list.end(), [&](const Answer& a) { return a.name == name; });
  };
  for (const Answer& answer : now) {
    const auto expected = find(golden, answer.name);
    if (expected == golden.end()) {
      differences.push_back({.name = answer.name});
    } else if (answer != *expected) {
      const auto at = std::mismatch(answer.marks.begin(), answer.marks.end(),
                                    expected->marks.begin(), expected->marks.end())
                          .first;
      const int equal = static_cast<int>(at - answer.marks.begin());
      const int frames = kFrames / kMarks;
      differences.push_back({answer.name, equal * frames + 1, (equal + 1) * frames});
    }
  }
  for (const Answer& answer : golden) {
    if (find(now, answer.name) == now.end()) differences.push_back({.name = answer.name});
  }
  return differences;
}

std::string Describe(const Difference& difference) {
  if (difference.first_frame == 0) return difference.name + ": is in one of the lists alone";
  return difference.name + ": differs in frames " + std::to_string(difference.first_frame) +
         " to " + std::to_string(difference.last_frame);
}

}  // namespace cairn::verify
