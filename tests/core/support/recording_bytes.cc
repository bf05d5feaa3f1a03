// SPDX-License-Identifier: MIT
#include "recording_bytes.h"

#include <algorithm>
#include <span>

#include "recording/crc32.h"

namespace cairn::test {
namespace {

constexpr std::size_t kHeader = 32, kEntry = 32;

/// Sections that the table has room for.
std::size_t Sections(const Bytes& bytes) {
  if (bytes.size() < kHeader) return 0;
  return std::min<std::size_t>(NumberAt(bytes, 12, 4), (bytes.size() - kHeader) / kEntry);
}

}  // namespace

Bytes EncodeAll(const Recording& recording) {
  Bytes bytes;
  if (!Encode(recording, &bytes).ok()) bytes.clear();
  return bytes;
}

std::uint64_t NumberAt(const Bytes& bytes, std::size_t at, int size) {
  std::uint64_t value = 0;
  for (int i = 0; i < size; ++i) value |= std::to_integer<std::uint64_t>(bytes[at + i]) << (8 * i);
  return value;
}

void PutNumber(std::uint64_t value, std::size_t at, int size, Bytes* bytes) {
  for (int i = 0; i < size; ++i) (*bytes)[at + i] = static_cast<std::byte>(value >> (8 * i));
}

std::size_t TableEntryOf(const Bytes& bytes, const std::string& section) {
  for (std::size_t i = 0; i < Sections(bytes); ++i) {
    const std::size_t at = kHeader + i * kEntry;
    const bool same = std::equal(section.begin(), section.end(), bytes.begin() + at,
                                 [](char a, std::byte b) { return a == std::to_integer<char>(b); });
    if (same) return at;
  }
  return 0;
}

std::size_t DataOf(const Bytes& bytes, const std::string& section) {
  return NumberAt(bytes, TableEntryOf(bytes, section) + 8, 8);
}

void RepairChecksums(Bytes* bytes) {
  const std::size_t sections = Sections(*bytes);
  for (std::size_t i = 0; i < sections; ++i) {
    const std::size_t at = kHeader + i * kEntry;
    const std::uint64_t size = NumberAt(*bytes, at + 4, 4), offset = NumberAt(*bytes, at + 8, 8),
                        count = NumberAt(*bytes, at + 16, 8);
    const bool inside =
        offset <= bytes->size() && (count == 0 || size <= (bytes->size() - offset) / count);
    if (!inside) continue;
    PutNumber(Crc32(std::span(*bytes).subspan(offset, size * count)), at + 24, 4, bytes);
  }
  if (bytes->size() < kHeader) return;
  const auto all = std::span<const std::byte>(*bytes);
  PutNumber(Crc32(all.subspan(kHeader, sections * kEntry), Crc32(all.first(24))), 24, 4, bytes);
}

}  // namespace cairn::test
