// SPDX-License-Identifier: MIT
#include "support/command_line.h"

#include <fmt/format.h>

#include <charconv>

#include "support/failure.h"
#include "support/names.h"

namespace cairn::cli {
namespace {

std::string CheckPrecision(const std::string& precision) {
  if (precision == "float" || precision == "float64") return precision;
  throw Failure(kUsage, fmt::format("--precision '{}': write float or float64", precision));
}

}  // namespace

std::string TakePrecision(std::vector<std::string>* arguments) {
  constexpr std::string_view kOption = "--precision", kWithValue = "--precision=";
  std::string precision;
  std::vector<std::string> rest;
  for (size_t i = 0; i < arguments->size(); ++i) {
    const std::string& word = (*arguments)[i];
    if (word == "--float64") {
      precision = "float64";
    } else if (word.starts_with("--float64=")) {
      throw Failure(kUsage, "--float64 stands alone, without a value");
    } else if (word == kOption) {
      precision = CheckPrecision(i + 1 < arguments->size() ? (*arguments)[++i] : "");
    } else if (word.starts_with(kWithValue)) {
      precision = CheckPrecision(word.substr(kWithValue.size()));
    } else {
      rest.push_back(word);
    }
  }
  *arguments = rest;
  return precision;
}

std::string WithoutPaths(std::string_view program, const std::vector<std::string>& arguments) {
  std::string text(program);
  for (std::string word : arguments) {
    while (word.size() > 1 && word.ends_with('/')) word.pop_back();
    const size_t equals = word.starts_with("--") ? word.find('=') : std::string::npos;
    const size_t start = equals == std::string::npos ? 0 : equals + 1;
    const size_t slash = word.rfind('/');
    const bool is_path = slash != std::string::npos && slash >= start;
    text += fmt::format(" {}{}", word.substr(0, start), word.substr(is_path ? slash + 1 : start));
  }
  return text;
}

long long ParseCount(std::string_view option, std::string_view text, long long least,
                     long long most, std::string_view meaning) {
  long long value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || rest != end || value < least || value > most) {
    throw Failure(kUsage, fmt::format("{} '{}': write a whole number from {} to {} ({})", option,
                                      text, least, most, meaning));
  }
  return value;
}

int ParseInt(std::string_view option, std::string_view text, long long least, long long most,
             std::string_view meaning) {
  return static_cast<int>(ParseCount(option, text, least, most, meaning));
}

double ParseNumber(std::string_view option, std::string_view text, double least, double most,
                   std::string_view meaning) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  // A NaN is in no range.
  if (error != std::errc{} || rest != end || !(value >= least && value <= most)) {
    throw Failure(kUsage, fmt::format("{} '{}': write a number from {:g} to {:g} ({})", option,
                                      text, least, most, meaning));
  }
  return value;
}

ProgressMode ParseProgress(const OutputWords& words) {
  const std::vector<std::string> names = {"auto", "always", "never"};
  constexpr ProgressMode kModes[] = {ProgressMode::kAuto, ProgressMode::kAlways,
                                     ProgressMode::kNever};
  const ProgressMode mode =
      kModes[FindName("progress mode", words.progress, names, "write auto, always or never")];
  return words.quiet ? ProgressMode::kNever : mode;
}

}  // namespace cairn::cli
