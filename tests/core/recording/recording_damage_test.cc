// SPDX-License-Identifier: MIT
// Files that were cut or altered are refused with a reason, whatever was done to them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

#include "tests/core/support/recording_bytes.h"
#include "tests/core/support/recording_problems.h"

namespace cairn {
namespace {

using test::Bytes;
using test::DataOf;
using test::EncodeAll;
using test::NumberAt;
using test::PutNumber;
using test::RandomRecording;
using test::RepairChecksums;
using test::TableEntryOf;
using testing::HasSubstr;

constexpr std::size_t kCount = 16, kEntrySize = 4, kOffset = 8;  // in an entry of the table

RecordingStatus Refusal(const Bytes& bytes) {
  Recording recording;
  recording.source = "untouched";
  RecordingStatus status = Decode(bytes, &recording);
  EXPECT_FALSE(status.ok());
  EXPECT_FALSE(status.message.empty());
  EXPECT_EQ(recording.source, "untouched");
  return status;
}

void ExpectRefusal(const Bytes& bytes, RecordingFault fault, const std::string& words) {
  const RecordingStatus status = Refusal(bytes);
  EXPECT_EQ(status.fault, fault) << status.message;
  EXPECT_THAT(status.message, HasSubstr(words));
}

TEST(DamagedRecording, ThatWasCutSaysHowManyBytesAreMissing) {
  const Bytes whole = EncodeAll(RandomRecording(1));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    // before the header ends, its end is all that is known to be missing
    const std::size_t missing = (size < 32 ? 32 : whole.size()) - size;
    ExpectRefusal(cut, RecordingFault::kTooShort, std::to_string(missing) + " too few");
  }
}

TEST(DamagedRecording, WithBytesAppendedSaysHowMany) {
  Bytes bytes = EncodeAll(RandomRecording(1));
  bytes.resize(bytes.size() + 3);
  ExpectRefusal(bytes, RecordingFault::kTooLong, "3 bytes too many");
}

TEST(DamagedRecording, IsNamedByItsFault) {
  const Bytes whole = EncodeAll(RandomRecording(1));
  Bytes bytes = whole;
  PutNumber(0x50, 1, 1, &bytes);
  ExpectRefusal(bytes, RecordingFault::kNotARecording, "no recording");

  bytes = whole;
  PutNumber(7, 8, 4, &bytes);
  ExpectRefusal(bytes, RecordingFault::kUnknownVersion, "version 7");

  bytes = whole;
  PutNumber(NumberAt(bytes, 16, 8) + 9, 16, 8, &bytes);
  ExpectRefusal(bytes, RecordingFault::kChecksum, "header");

  bytes = whole;
  PutNumber(NumberAt(bytes, DataOf(bytes, "ROWS") + 70, 1) ^ 4, DataOf(bytes, "ROWS") + 70, 1,
            &bytes);
  ExpectRefusal(bytes, RecordingFault::kChecksum, "section ROWS");

  bytes = whole;
  PutNumber(1u << 31, 12, 4, &bytes);
  ExpectRefusal(bytes, RecordingFault::kBadLayout, "2147483648 sections");
}

/// What is wrong although every checksum is right.
void ExpectRefusalOf(const std::string& section, std::size_t field, std::uint64_t value, int size,
                     const std::string& words) {
  Bytes bytes = EncodeAll(RandomRecording(1));
  PutNumber(value, TableEntryOf(bytes, section) + field, size, &bytes);
  RepairChecksums(&bytes);
  ExpectRefusal(bytes, RecordingFault::kBadLayout, words);
}

TEST(DamagedRecording, WithAbsurdCountsIsRefusedBeforeMemoryIsAskedFor) {
  for (const std::uint64_t count :
       {std::uint64_t{1} << 62, ~std::uint64_t{0}, std::uint64_t{1} << 33, std::uint64_t{100000}}) {
    ExpectRefusalOf("ROWS", kCount, count, 8,
                    "section ROWS speaks of " + std::to_string(count) + " entries of 160 bytes");
  }
  // their product is 0 in 64 bits
  ExpectRefusalOf("ROWS", kCount, std::uint64_t{1} << 59, 8, "section ROWS speaks of");
  ExpectRefusalOf("BODY", kEntrySize, 0, 4, "section BODY speaks of");
}

TEST(DamagedRecording, WithATableThatDoesNotAddUpIsRefused) {
  ExpectRefusalOf("ROWS", kCount, 1, 8, "section RIMP begins at byte");
  ExpectRefusalOf("MANI", kOffset, 0, 8, "section MANI begins at byte 0 instead of");
  ExpectRefusalOf("MANI", 0, 0x44414544, 4, "section DEAD is not known");
  ExpectRefusalOf("MANI", 0, 0x53574f52, 4, "section ROWS is there twice or not in its place");

  Bytes bytes = EncodeAll(RandomRecording(1));
  PutNumber(NumberAt(bytes, 12, 4) - 1, 12, 4, &bytes);
  RepairChecksums(&bytes);
  EXPECT_EQ(Refusal(bytes).fault, RecordingFault::kBadLayout);
}

TEST(DamagedRecording, WithValuesThatNobodyWritesIsRefused) {
  const auto refused = [](const std::string& section, std::size_t at, std::uint64_t value) {
    Bytes bytes = EncodeAll(RandomRecording(1));
    PutNumber(value, DataOf(bytes, section) + at, 1, &bytes);
    RepairChecksums(&bytes);
    ExpectRefusal(bytes, RecordingFault::kBadValue, "of section " + section);
  };
  refused("SETT", 0, 9);     // no such method
  refused("SETT", 48, 3);    // no such kind of budget
  refused("LAWS", 4, 2);     // neither true nor false
  refused("LAWS", 6, 1);     // not used
  refused("MANI", 16, 5);    // points
  refused("MANI", 17, 200);  // tangents
}

/// Something that happens to files.
Bytes Corrupt(Bytes bytes, std::mt19937_64* random) {
  const auto below = [random](std::size_t most) { return (*random)() % most; };
  const auto any_byte = [&] { return static_cast<std::byte>(below(256)); };
  switch (below(6)) {
    case 0: {  // a bit
      bytes[below(bytes.size())] ^= static_cast<std::byte>(1u << below(8));
      break;
    }
    case 1: {  // a run of other bytes
      const std::size_t begin = below(bytes.size()), length = 1 + below(64);
      for (std::size_t i = begin; i < std::min(bytes.size(), begin + length); ++i) {
        bytes[i] = any_byte();
      }
      break;
    }
    case 2: {  // cut
      bytes.resize(below(bytes.size()));
      break;
    }
    case 3: {  // a piece lost
      const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(below(bytes.size()));
      bytes.erase(begin, begin + static_cast<std::ptrdiff_t>(
                                     1 + below(static_cast<std::size_t>(bytes.end() - begin))));
      break;
    }
    case 4: {  // a piece added
      const Bytes piece(1 + below(100), any_byte());
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(below(bytes.size())), piece.begin(),
                   piece.end());
      break;
    }
    default: {  // a block of zeros, as after a crash
      const std::size_t begin = below(bytes.size());
      std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(begin), bytes.end(), std::byte{});
    }
  }
  return bytes;
}

TEST(DamagedRecording, IsRefusedWhateverWasDoneToIt) {
  std::mt19937_64 random(20);
  int refused = 0;
  while (refused < 1000) {
    const Bytes whole = EncodeAll(RandomRecording(refused % 7));
    const Bytes bytes = Corrupt(whole, &random);
    if (bytes == whole) continue;  // a byte was replaced by itself
    const RecordingStatus status = Refusal(bytes);
    ASSERT_FALSE(status.ok()) << "corruption " << refused;
    ++refused;
  }
}

// Checksums do not protect from who computes them, too.
TEST(DamagedRecording, WithChecksumsMadeRightIsRefusedOrCanBeWrittenAgain) {
  std::mt19937_64 random(21);
  int read = 0;
  for (int i = 0; i < 3000; ++i) {
    Bytes bytes = Corrupt(EncodeAll(RandomRecording(i % 7)), &random);
    RepairChecksums(&bytes);
    Recording recording;
    const RecordingStatus status = Decode(bytes, &recording);
    EXPECT_EQ(status.ok(), status.message.empty());
    if (!status.ok()) continue;
    ++read;
    // settings of former times are written as what took their place
    Bytes written = EncodeAll(recording);
    const std::size_t settings = DataOf(bytes, "SETT");
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(settings), 104,
                written.begin() + static_cast<std::ptrdiff_t>(settings));
    RepairChecksums(&written);
    EXPECT_TRUE(written == bytes);
  }
  EXPECT_GT(read, 100);
}

TEST(RecordingFile, ThatIsNotThereOrCannotBeWrittenIsAnAnswer) {
  const std::string folder = testing::TempDir() + "/recording_file";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  Recording recording = RandomRecording(1);
  EXPECT_EQ(Load(folder + "/none.cairn", &recording).fault, RecordingFault::kCannotOpen);
  EXPECT_EQ(Load(folder, &recording).fault, RecordingFault::kCannotOpen);
  const RecordingStatus status = Save(recording, folder + "/none/a.cairn");
  EXPECT_EQ(status.fault, RecordingFault::kCannotWrite);
  EXPECT_THAT(status.message, HasSubstr("No such file"));
  EXPECT_EQ(Save(recording, folder).fault, RecordingFault::kCannotWrite);
  EXPECT_EQ(Save(recording, "/dev/full/a").fault, RecordingFault::kCannotWrite);

  ASSERT_TRUE(Save(recording, folder + "/a.cairn").ok());
  Recording read;
  ASSERT_TRUE(Load(folder + "/a.cairn", &read).ok());
  EXPECT_EQ(EncodeAll(read), EncodeAll(recording));
  int files = 0;
  for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator(folder)) ++files;
  EXPECT_EQ(files, 1);  // nothing half written is left
  std::ofstream(folder + "/text.cairn") << "not at all a recording of anything";
  EXPECT_EQ(Load(folder + "/text.cairn", &read).fault, RecordingFault::kNotARecording);
}

TEST(Recording, ThatNoReaderWouldTakeIsNotWritten) {
  const auto fault = [](const Recording& recording) {
    Bytes bytes;
    return Encode(recording, &bytes).fault;
  };
  Recording recording = RandomRecording(1);
  recording.row_impulses.pop_back();
  EXPECT_EQ(fault(recording), RecordingFault::kBadValue);
  recording = RandomRecording(1);
  recording.manifolds[0].points = 5;
  EXPECT_EQ(fault(recording), RecordingFault::kBadValue);
  recording = RandomRecording(1);
  recording.motions.resize(1);
  EXPECT_EQ(fault(recording), RecordingFault::kBadValue);
  recording = RandomRecording(1);
  recording.source.assign(5000, 'a');
  EXPECT_EQ(fault(recording), RecordingFault::kBadValue);
}

}  // namespace
}  // namespace cairn
