// SPDX-License-Identifier: MIT
#include "support/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "support/failure.h"

namespace cairn::cli {
namespace {

/// All options begin with them: they say nothing of how near two are.
std::string_view WithoutDashes(std::string_view word) {
  return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

}  // namespace

int EditDistance(std::string_view a, std::string_view b) {
  // Optimal string alignment; three rows of its table are enough.
  std::vector<int> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), 0);
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (size_t j = 1; j <= b.size(); ++j) {
      const int replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
    before_last.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

std::string DidYouMean(std::string_view word, std::span<const std::string> names) {
  const std::string_view letters = WithoutDashes(word);
  int least = static_cast<int>(letters.size()) / 3 + 1;
  std::string nearest;
  for (const std::string& name : names) {
    const int distance = EditDistance(letters, WithoutDashes(name));
    if (distance >= least) continue;
    least = distance;
    nearest = name;
  }
  return nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest);
}

size_t FindName(std::string_view kind, std::string_view word, std::span<const std::string> names,
                std::string_view help) {
  std::vector<size_t> fitting;
  for (size_t i = 0; i < names.size(); ++i) {
    if (names[i] == word) return i;
    if (!word.empty() && names[i].starts_with(word)) fitting.push_back(i);
  }
  if (fitting.size() == 1) return fitting[0];
  if (fitting.size() > 1) {
    std::string choices;
    for (size_t i : fitting) choices += (choices.empty() ? "" : ", ") + names[i];
    throw Failure(kUsage, fmt::format("'{}' could be any of these {}s: {}", word, kind, choices));
  }
  throw Failure(kUsage,
                fmt::format("unknown {} '{}': {}{}", kind, word, DidYouMean(word, names), help));
}

std::vector<std::string> Split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const size_t end = std::min(text.find(separator), text.size());
    if (end > 0) parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

}  // namespace cairn::cli
