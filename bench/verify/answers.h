// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cairn::verify {

/// What a world or a problem came to: a hash of all states so far, after each tenth of its frames.
struct Answer {
  std::string name;  ///< For example "core/tower/work".
  std::vector<std::uint64_t> marks;

  friend bool operator==(const Answer&, const Answer&) = default;
};

inline constexpr int kFrames = 300;  ///< Of each world.
inline constexpr int kMarks = 10;

/// FNV-1a, of what was added so far.
class Hash {
 public:
  void Add(const void* bytes, std::size_t size);
  template <class Number>
  void Add(Number number) {
    Add(&number, sizeof number);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

/// One line of a golden file: the name, and the marks in hexadecimal.
std::string ToLine(const Answer& answer);
/// @pre ToLine() wrote it
Answer FromLine(std::string_view line);

/// How answers differ from those of a golden file.
struct Difference {
  std::string name;
  /// The first frame after which it may differ is first_frame, of which it does last_frame; both 0:
  /// it is not in the other list.
  int first_frame = 0, last_frame = 0;
};
std::vector<Difference> Compare(std::span<const Answer> golden, std::span<const Answer> now);

/// "core/tower/work: differs in frames 31 to 60"
std::string Describe(const Difference& difference);

/// Worlds of the public interface alone, and matrices. Takes a second.
std::vector<Answer> CoreAnswers();
/// Those of the golden file, which every machine is to give.
std::vector<Answer> GoldenCoreAnswers();

}  // namespace cairn::verify
