// SPDX-License-Identifier: MIT
// How a game of bytes is played, and what comes out: the same for games of the core and worlds of
// the adapter.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace cairn::test {

/// None of this may change a bit.
struct Play {
  std::string simd;  ///< CAIRN_SIMD
  int threads = 1;
};

struct GameResult {
  std::uint64_t hash = 0;
  std::string broken;  ///< the promise that was; empty if none was
};

using PlayGameOnce = GameResult (*)(std::span<const std::uint8_t> bytes, const Play& play);

/// The same on every instruction set of this machine, on 1, 2 and 3 threads in turn. Returns the
/// promise that was broken, or nothing.
std::string PlayEverywhere(PlayGameOnce play_once, std::span<const std::uint8_t> bytes);

/// FNV-1a.
class Hash {
 public:
  template <class T>
  void Add(const T& value) {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 0x100000001b3u;
  }
  template <class T>
  void AddAll(const std::vector<T>& values) {
    for (const T& value : values) Add(value);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace cairn::test
