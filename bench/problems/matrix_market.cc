// SPDX-License-Identifier: MIT
#include "problems/matrix_market.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "cairn/detail/whole_file.h"

namespace cairn::problems {
namespace {

namespace fs = std::filesystem;

/// Blanks that separate words of a line; files from Windows end lines with "\r\n".
constexpr std::string_view kBlanks = " \t\r";

/// What a message shows of a line or word: not all of a binary file.
std::string Quote(std::string_view text) {
  constexpr size_t kMost = 40;
  std::string shown;
  for (const char c : text.substr(0, kMost)) {
    shown += std::isprint(static_cast<unsigned char>(c)) ? c : '?';
  }
  return "'" + shown + (text.size() > kMost ? "..." : "") + "'";
}

/// Takes the next word off the line; empty at its end.
std::string_view TakeWord(std::string_view* line) {
  line->remove_prefix(std::min(line->find_first_not_of(kBlanks), line->size()));
  const size_t end = std::min(line->find_first_of(kBlanks), line->size());
  const std::string_view word = line->substr(0, end);
  line->remove_prefix(end);
  return word;
}

/// The lines of a file in turn, blank ones left out.
class Lines {
 public:
  Lines(fs::path path, std::string_view text) : path_(std::move(path)), rest_(text) {}

  /// The next line that is not blank; none at the end of the file.
  std::optional<std::string_view> Next() {
    while (!rest_.empty()) {
      const size_t end = std::min(rest_.find('\n'), rest_.size());
      const std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      if (line.find_first_not_of(kBlanks) != std::string_view::npos) return line;
    }
    return {};
  }

  /// The first line that is neither blank nor a comment.
  std::optional<std::string_view> NextAfterComments() {
    for (;;) {
      const auto line = Next();
      if (!line || !line->starts_with('%')) return line;
    }
  }

  [[noreturn]] void Refuse(const std::string& message) const {
    throw FileError(path_, std::max(1LL, number_), message);
  }
  [[noreturn]] void RefuseFile(const std::string& message) const {
    throw FileError(path_, message);
  }

  long long number() const { return number_; }
  /// Characters not read yet.
  size_t rest() const { return rest_.size(); }

 private:
  fs::path path_;
  std::string_view rest_;
  long long number_ = 0;
};

long long ToCount(const Lines& lines, std::string_view word, std::string_view what) {
  long long count = 0;
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, count);
  constexpr long long kMost = std::numeric_limits<int>::max();
  if (error != std::errc{} || rest != end || count < 0 || count > kMost) {
    lines.Refuse(Quote(word) + " is no " + std::string(what) +
                 "; expected a whole number from 0 to " + std::to_string(kMost));
  }
  return count;
}

double ToNumber(const Lines& lines, std::string_view word) {
  std::string_view digits = word;
  // from_chars() takes no plus sign.
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double number = 0;
  const char* const end = digits.data() + digits.size();
  const auto [rest, error] = std::from_chars(digits.data(), end, number);
  if (error == std::errc::invalid_argument || rest != end) {
    lines.Refuse(Quote(word) + " is no number");
  }
  if (error != std::errc{} || !std::isfinite(number)) {
    lines.Refuse(Quote(word) +
                 " is not finite in double precision; expected a finite number (an "
                 "infinite bound is written as 1e300)");
  }
  return number;
}

void ExpectEndOfLine(const Lines& lines, std::string_view rest, std::string_view expected) {
  const std::string_view extra = TakeWord(&rest);
  if (!extra.empty()) {
    lines.Refuse(Quote(extra) + " is too much on this line; expected " + std::string(expected));
  }
}

void ExpectEndOfFile(Lines* lines, long long entries) {
  if (const auto line = lines->Next()) {
    lines->Refuse(Quote(*line) + " is too much; the size line says " + std::to_string(entries) +
                  " entries");
  }
}

[[noreturn]] void RefuseCutShort(const Lines& lines, long long found, long long entries) {
  lines.RefuseFile("cut short: ends after " + std::to_string(found) + " of " +
                   std::to_string(entries) + " entries");
}

/// Before memory is asked for: an entry takes at least `least` characters of the file.
void ExpectRoom(const Lines& lines, long long entries, size_t least) {
  if (static_cast<unsigned long long>(entries) > lines.rest() / least + 1) {
    lines.Refuse("the file is too short for " + std::to_string(entries) +
                 " entries: cut short, or a wrong size line");
  }
}

/// Reads "%%MatrixMarket matrix FORMAT FIELD SYMMETRY".
/// @return the index in `symmetries` of what the file has.
size_t ReadHeader(Lines* lines, std::string_view format,
                  const std::vector<std::string_view>& symmetries) {
  const auto line = lines->Next();
  std::string expected = "expected the header '%%MatrixMarket matrix " + std::string(format) +
                         " real " + std::string(symmetries.front()) + "'";
  if (!line) lines->Refuse("the file is empty; " + expected);
  const auto lower = [](std::string_view word) {
    std::string text(word);
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
  };
  std::string_view rest = *line;
  // Words of a header may be written in capitals; the banner may not.
  const bool known = TakeWord(&rest) == "%%MatrixMarket" && lower(TakeWord(&rest)) == "matrix" &&
                     lower(TakeWord(&rest)) == format;
  const std::string field = known ? lower(TakeWord(&rest)) : "";
  const std::string symmetry = known ? lower(TakeWord(&rest)) : "";
  const auto found = std::find(symmetries.begin(), symmetries.end(), symmetry);
  if ((field != "real" && field != "integer") || found == symmetries.end() ||
      !TakeWord(&rest).empty()) {
    lines->Refuse(Quote(*line) + " is not understood; " + expected);
  }
  return found - symmetries.begin();
}

/// An entry as setFromTriplets() takes it, and the line it came from.
struct Entry {
  int i, j;
  double number;
  long long line;

  int row() const { return i; }
  int col() const { return j; }
  double value() const { return number; }
};

Entry ReadEntry(const Lines& lines, std::string_view line, long long n) {
  constexpr std::string_view kExpected = "'row column value'";
  long long index[2];
  for (long long& one : index) {
    const std::string_view word = TakeWord(&line);
    one = ToCount(lines, word, "index");
    if (one < 1 || one > n) {
      lines.Refuse("index " + std::to_string(one) + " is out of range; expected 1 to " +
                   std::to_string(n));
    }
  }
  const std::string_view word = TakeWord(&line);
  if (word.empty()) lines.Refuse("the value is missing; expected " + std::string(kExpected));
  const double value = ToNumber(lines, word);
  ExpectEndOfLine(lines, line, kExpected);
  return {static_cast<int>(index[0]) - 1, static_cast<int>(index[1]) - 1, value, lines.number()};
}

/// Refuses the entry that was given before, the first such in the file.
[[noreturn]] void RefuseTwice(const fs::path& path, std::vector<Entry> entries) {
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::pair(a.i, a.j) < std::pair(b.i, b.j);
  });
  const Entry *first = nullptr, *before = nullptr;
  for (size_t k = 1; k < entries.size(); ++k) {
    const bool is_same = entries[k - 1].i == entries[k].i && entries[k - 1].j == entries[k].j;
    if (!is_same || (first != nullptr && first->line < entries[k].line)) continue;
    first = &entries[k];
    before = &entries[k - 1];
  }
  throw FileError(path, first->line,
                  "entry " + std::to_string(first->i + 1) + " " + std::to_string(first->j + 1) +
                      " is given twice; it is on line " + std::to_string(before->line) + " too");
}

long long ReadMatrixSize(Lines* lines, long long* entries) {
  const auto line = lines->NextAfterComments();
  if (!line) lines->Refuse("the size line is missing; expected 'rows columns entries'");
  std::string_view rest = *line;
  const long long n = ToCount(*lines, TakeWord(&rest), "number of rows");
  const long long columns = ToCount(*lines, TakeWord(&rest), "number of columns");
  *entries = ToCount(*lines, TakeWord(&rest), "number of entries");
  ExpectEndOfLine(*lines, rest, "'rows columns entries'");
  if (n != columns) {
    lines->Refuse(std::to_string(n) + " rows and " + std::to_string(columns) +
                  " columns; expected a square matrix");
  }
  if (n == 0) lines->Refuse("the matrix has no rows");
  if (*entries < n) {
    lines->Refuse(std::to_string(*entries) + " entries for " + std::to_string(n) +
                  " rows; expected at least the diagonal");
  }
  ExpectRoom(*lines, *entries, sizeof("1 1 1"));
  return n;
}

void Append(double number, std::string* text) {
  char buffer[32];
  text->append(buffer, std::to_chars(std::begin(buffer), std::end(buffer), number).ptr);
}

}  // namespace

FileError::FileError(const fs::path& path, const std::string& message)
    : std::runtime_error(path.string() + ": " + message) {}

FileError::FileError(const fs::path& path, long long line, const std::string& message)
    : std::runtime_error(path.string() + ":" + std::to_string(line) + ": " + message) {}

Eigen::VectorXd ReadVector(const fs::path& path) {
  const std::string text = ReadText(path);
  Lines lines(path, text);
  ReadHeader(&lines, "array", {"general"});
  const auto size = lines.NextAfterComments();
  if (!size) lines.Refuse("the size line is missing; expected 'rows 1'");
  std::string_view rest = *size;
  const long long n = ToCount(lines, TakeWord(&rest), "number of rows");
  const long long columns = ToCount(lines, TakeWord(&rest), "number of columns");
  ExpectEndOfLine(lines, rest, "'rows 1'");
  if (columns != 1) lines.Refuse(std::to_string(columns) + " columns; expected one");
  ExpectRoom(lines, n, sizeof("1"));

  Eigen::VectorXd vector(n);
  for (long long i = 0; i < n; ++i) {
    const auto line = lines.Next();
    if (!line) RefuseCutShort(lines, i, n);
    rest = *line;
    vector[i] = ToNumber(lines, TakeWord(&rest));
    ExpectEndOfLine(lines, rest, "one number");
  }
  ExpectEndOfFile(&lines, n);
  return vector;
}

Eigen::SparseMatrix<double> ReadMatrix(const fs::path& path) {
  const std::string text = ReadText(path);
  Lines lines(path, text);
  const bool symmetric = ReadHeader(&lines, "coordinate", {"symmetric", "general"}) == 0;
  long long count = 0;
  const long long n = ReadMatrixSize(&lines, &count);

  std::vector<Entry> entries;
  entries.reserve(symmetric ? 2 * count : count);
  for (long long k = 0; k < count; ++k) {
    const auto line = lines.Next();
    if (!line) RefuseCutShort(lines, k, count);
    const Entry entry = ReadEntry(lines, *line, n);
    if (symmetric && entry.j > entry.i) {
      lines.Refuse("entry " + std::to_string(entry.i + 1) + " " + std::to_string(entry.j + 1) +
                   " is above the diagonal; a symmetric file stores the lower triangle");
    }
    entries.push_back(entry);
    if (symmetric && entry.j < entry.i) {
      entries.push_back({entry.j, entry.i, entry.number, entry.line});
    }
  }
  ExpectEndOfFile(&lines, count);

  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  // Eigen adds up what is given twice.
  if (matrix.nonZeros() != static_cast<Eigen::Index>(entries.size())) {
    if (symmetric) std::erase_if(entries, [](const Entry& entry) { return entry.i < entry.j; });
    RefuseTwice(path, std::move(entries));
  }
  return matrix;
}

void WriteVector(const fs::path& path, const Eigen::VectorXd& vector) {
  std::string text = "%%MatrixMarket matrix array real general\n";
  text += std::to_string(vector.size()) + " 1\n";
  for (const double value : vector) {
    Append(value, &text);
    text += '\n';
  }
  WriteText(path, text);
}

void WriteSymmetric(const fs::path& path, const Eigen::SparseMatrix<double>& matrix) {
  std::string body;
  long long entries = 0;
  for (Eigen::Index j = 0; j < matrix.outerSize(); ++j) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, j); entry; ++entry) {
      if (entry.row() < entry.col()) continue;
      ++entries;
      body += std::to_string(entry.row() + 1) + " " + std::to_string(entry.col() + 1) + " ";
      Append(entry.value(), &body);
      body += '\n';
    }
  }
  const std::string n = std::to_string(matrix.rows());
  WriteText(path, "%%MatrixMarket matrix coordinate real symmetric\n" + n + " " + n + " " +
                      std::to_string(entries) + "\n" + body);
}

std::string ReadText(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw FileError(path, "is a folder; expected a file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw FileError(path, std::string("cannot be read: ") + std::strerror(errno));
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw FileError(path, "cannot be read: " + error.message());
  std::string text(size, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!file) throw FileError(path, "cannot be read to its end");
  return text;
}

void WriteText(const fs::path& path, const std::string& text) {
  const std::error_code error = WriteWholeFile(path.string(), std::as_bytes(std::span(text)));
  if (error) throw FileError(path, "cannot be written: " + error.message());
}

}  // namespace cairn::problems
