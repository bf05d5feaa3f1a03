// SPDX-License-Identifier: MIT
#include "problems/problem_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "cairn/lcp/solver.h"

namespace cairn::problems {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A folder of its own for each test, gone after it.
class FolderTest : public ::testing::Test {
 protected:
  FolderTest() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) /
              (std::string("cairn-") + test->test_suite_name() + "-" + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~FolderTest() override { fs::remove_all(folder_); }

  fs::path Path(const std::string& name) const { return folder_ / name; }

  fs::path Write(const std::string& name, const std::string& text) const {
    WriteText(Path(name), text);
    return Path(name);
  }

  const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
};

/// What a call says when it throws; "" if it does not.
template <class Call>
std::string ErrorOf(Call call) {
  try {
    call();
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

class MatrixMarket : public FolderTest {
 protected:
  std::string VectorError(const std::string& text) const {
    const fs::path path = Write("v.mtx", text);
    return ErrorOf([&] { ReadVector(path); });
  }
  std::string MatrixError(const std::string& text) const {
    const fs::path path = Write("m.mtx", text);
    return ErrorOf([&] { ReadMatrix(path); });
  }
};

const std::string kVector = "%%MatrixMarket matrix array real general\n";
const std::string kSymmetric = "%%MatrixMarket matrix coordinate real symmetric\n";

TEST_F(MatrixMarket, ReadsNumbersAsTheStandardWritesThem) {
  const fs::path path = Write("v.mtx", kVector +
                                           "% a comment\n%\n\n5 1\n1\n-2.5e-3\n\n+4E2\r\n"
                                           " 5 \n4.9406564584124654e-324\n");
  const Eigen::VectorXd v = ReadVector(path);
  ASSERT_EQ(v.size(), 5);
  EXPECT_EQ(v[0], 1);
  EXPECT_EQ(v[1], -2.5e-3);
  EXPECT_EQ(v[2], 400);
  EXPECT_EQ(v[3], 5);
  EXPECT_EQ(v[4], std::numeric_limits<double>::denorm_min());
}

TEST_F(MatrixMarket, FillsTheUpperTriangleOfASymmetricMatrix) {
  const fs::path path =
      Write("m.mtx", kSymmetric + "3 3 5\n1 1 2\n2 1 -1\n2 2 2\n3 3 4\n3 1 0.5\n");
  const Eigen::MatrixXd expected =
      (Eigen::MatrixXd(3, 3) << 2, -1, 0.5, -1, 2, 0, 0.5, 0, 4).finished();
  EXPECT_EQ(Eigen::MatrixXd(ReadMatrix(path)), expected);
}

TEST_F(MatrixMarket, ReadsAGeneralMatrixAsItStands) {
  const fs::path path = Write(
      "m.mtx", "%%MatrixMarket matrix coordinate integer general\n2 2 3\n1 1 2\n1 2 -1\n2 2 2\n");
  const Eigen::MatrixXd expected = (Eigen::MatrixXd(2, 2) << 2, -1, 0, 2).finished();
  EXPECT_EQ(Eigen::MatrixXd(ReadMatrix(path)), expected);
}

TEST_F(MatrixMarket, NamesFileAndLineOfWhatIsWrongInAVector) {
  const fs::path path = Path("v.mtx");
  const auto at = [&](int line) { return path.string() + ":" + std::to_string(line) + ": "; };
  EXPECT_EQ(VectorError(""), at(1) +
                                 "the file is empty; expected the header '%%MatrixMarket matrix "
                                 "array real general'");
  EXPECT_THAT(VectorError("%MatrixMarket matrix array real general\n1 1\n1\n"),
              HasSubstr("v.mtx:1: '%MatrixMarket matrix array real general' is not understood"));
  EXPECT_THAT(VectorError(kSymmetric + "1 1 1\n1 1 1\n"), HasSubstr("expected the header"));
  EXPECT_THAT(VectorError("%%MatrixMarket matrix array complex general\n1 1\n1\n"),
              HasSubstr("expected the header"));
  EXPECT_EQ(VectorError(kVector), at(1) + "the size line is missing; expected 'rows 1'");
  EXPECT_EQ(VectorError(kVector + "2 2\n1\n2\n3\n4\n"), at(2) + "2 columns; expected one");
  EXPECT_EQ(VectorError(kVector + "2 1\n1\nx\n"), at(4) + "'x' is no number");
  EXPECT_EQ(VectorError(kVector + "2 1\n1\n1,5\n"), at(4) + "'1,5' is no number");
  EXPECT_THAT(VectorError(kVector + "2 1\n1\nnan\n"), HasSubstr("v.mtx:4: 'nan' is not finite"));
  EXPECT_THAT(VectorError(kVector + "2 1\n-inf\n1\n"), HasSubstr("v.mtx:3: '-inf' is not finite"));
  EXPECT_THAT(VectorError(kVector + "2 1\n1e999\n1\n"), HasSubstr("is not finite"));
  EXPECT_EQ(VectorError(kVector + "2 1\n1 2\n3\n"),
            at(3) + "'2' is too much on this line; expected one number");
  EXPECT_EQ(VectorError(kVector + "2 1\n1\n2\n\n3\n"),
            at(6) + "'3' is too much; the size line says 2 entries");
  EXPECT_EQ(VectorError(kVector + "3 1\n1\n222\n"),
            path.string() + ": cut short: ends after 2 of 3 entries");
  EXPECT_THAT(VectorError(kVector + "2000000000 1\n1\n"),
              HasSubstr("too short for 2000000000 entries"));
  EXPECT_THAT(VectorError(kVector + "-1 1\n1\n"), HasSubstr("'-1' is no number of rows"));
}

TEST_F(MatrixMarket, NamesFileAndLineOfWhatIsWrongInAMatrix) {
  const fs::path path = Path("m.mtx");
  const auto at = [&](int line) { return path.string() + ":" + std::to_string(line) + ": "; };
  EXPECT_EQ(MatrixError(kSymmetric + "2 3 2\n1 1 1\n2 2 1\n"),
            at(2) + "2 rows and 3 columns; expected a square matrix");
  EXPECT_EQ(MatrixError(kSymmetric + "2 2 1\n1 1 1\n"),
            at(2) + "1 entries for 2 rows; expected at least the diagonal");
  EXPECT_EQ(MatrixError(kSymmetric + "0 0 0\n"), at(2) + "the matrix has no rows");
  EXPECT_EQ(MatrixError(kSymmetric + "2 2 2\n1 1 1\n3 2 1\n"),
            at(4) + "index 3 is out of range; expected 1 to 2");
  EXPECT_EQ(MatrixError(kSymmetric + "2 2 2\n1 1 1\n0 2 1\n"),
            at(4) + "index 0 is out of range; expected 1 to 2");
  EXPECT_THAT(MatrixError(kSymmetric + "2 2 2\n1 1 1\n1.5 2 1\n"), HasSubstr("'1.5' is no index"));
  EXPECT_EQ(MatrixError(kSymmetric + "2 2 2\n1 1 1\n2 2\n"),
            at(4) + "the value is missing; expected 'row column value'");
  EXPECT_EQ(MatrixError(kSymmetric + "2 2 2\n1 1 1\n2 2 1 9\n"),
            at(4) + "'9' is too much on this line; expected 'row column value'");
  EXPECT_EQ(MatrixError(kSymmetric + "2 2 2\n1 1 1\n1 2 1\n"),
            at(4) + "entry 1 2 is above the diagonal; a symmetric file stores the lower triangle");
  EXPECT_EQ(MatrixError(kSymmetric + "2 2 4\n1 1 1\n2 1 5\n2 2 1\n2 1 6\n"),
            at(6) + "entry 2 1 is given twice; it is on line 4 too");
  EXPECT_EQ(MatrixError(kSymmetric + "2 2 3\n1 1 1\n2 2 1\n"),
            path.string() + ": cut short: ends after 2 of 3 entries");
  EXPECT_THAT(MatrixError(kSymmetric + "2000000000 2000000000 2000000000\n1 1 1\n"),
              HasSubstr("too short for 2000000000 entries"));
  EXPECT_THAT(ErrorOf([&] { ReadMatrix(Path("none.mtx")); }),
              HasSubstr("none.mtx: cannot be read: No such file"));
  EXPECT_THAT(ErrorOf([&] { ReadMatrix(folder()); }), HasSubstr("is a folder"));
}

TEST_F(MatrixMarket, GivesTheSameBitsBack) {
  std::mt19937_64 random(1);
  Eigen::VectorXd v(1000);
  for (double& value : v) {
    do {
      const std::uint64_t bits = random();
      std::memcpy(&value, &bits, sizeof value);
    } while (!std::isfinite(value));
  }
  v[0] = -0.0;
  WriteVector(Path("v.mtx"), v);
  const Eigen::VectorXd read = ReadVector(Path("v.mtx"));
  ASSERT_EQ(read.size(), v.size());
  EXPECT_EQ(std::memcmp(read.data(), v.data(), v.size() * sizeof(double)), 0);

  Eigen::SparseMatrix<double> m(50, 50);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < 50; ++i) {
    entries.emplace_back(i, i, 1 + 1.0 / (i + 3));
    if (i > 2) {
      entries.emplace_back(i, i - 3, 1.0 / 3);
      entries.emplace_back(i - 3, i, 1.0 / 3);
    }
  }
  m.setFromTriplets(entries.begin(), entries.end());
  WriteSymmetric(Path("m.mtx"), m);
  EXPECT_EQ(Eigen::MatrixXd(ReadMatrix(Path("m.mtx"))), Eigen::MatrixXd(m));
}

// Each corruption of a sound file is either refused as FileError, or is another sound file. Under
// the sanitizers it also shows that nothing is read that is not there.
TEST_F(MatrixMarket, SurvivesTwoHundredRandomCorruptions) {
  const std::string vector = kVector + "4 1\n1.5\n-2\n3e-3\n0\n";
  const std::string matrix = kSymmetric + "4 4 6\n1 1 2\n2 1 -1\n2 2 2\n3 3 2\n4 4 2\n4 1 0.25\n";
  std::mt19937 random(7);
  int refused = 0;
  for (int round = 0; round < 200; ++round) {
    const bool is_vector = round % 2 == 0;
    std::string text = is_vector ? vector : matrix;
    const size_t place = random() % text.size();
    switch (random() % 4) {
      case 0:
        text.resize(place);
        break;
      case 1:
        text[place] = static_cast<char>(random() % 256);
        break;
      case 2:
        text.erase(place, 1 + random() % 5);
        break;
      default:
        text.insert(place, 1, static_cast<char>('0' + random() % 10));
    }
    SCOPED_TRACE(text);
    const fs::path path = Write("c.mtx", text);
    const std::string error = ErrorOf([&] {
      if (is_vector) {
        EXPECT_TRUE(ReadVector(path).allFinite());
      } else {
        const Eigen::SparseMatrix<double> m = ReadMatrix(path);
        EXPECT_GE(m.nonZeros(), m.rows());
      }
    });
    if (error.empty()) continue;
    ++refused;
    EXPECT_THAT(error, HasSubstr(path.string() + ":"));
  }
  // A changed digit leaves a sound file; most other changes do not.
  EXPECT_GT(refused, 100);
}

TEST_F(MatrixMarket, RefusesEveryFileThatWasCutShort) {
  const std::string text = kSymmetric + "3 3 4\n1 1 2\n2 1 -1\n2 2 2\n3 3 2\n";
  // Without its last line break, the file is whole.
  for (size_t length = 0; length + 2 < text.size(); ++length) {
    EXPECT_THAT(MatrixError(text.substr(0, length)), Not("")) << length;
  }
  EXPECT_EQ(MatrixError(text.substr(0, text.size() - 1)), "");
}

class ProblemFolder : public FolderTest {
 protected:
  /// Two unknowns: x = (2, 1) solves the lcp of M = [1 -1; -1 2], q = (-1, 0).
  void WriteLcp(const std::string& meta) const {
    Write("meta.json", meta);
    Write("matrix.mtx", kSymmetric + "2 2 3\n1 1 1\n2 1 -1\n2 2 2\n");
    Write("q.mtx", kVector + "2 1\n-1\n0\n");
  }
  std::string ErrorOfFolder() const {
    return ErrorOf([&] { ReadProblemFolder(folder()); });
  }
};

TEST_F(ProblemFolder, ReadsAnLcpWithItsSolution) {
  WriteLcp(R"({"name": "stack", "kind": "lcp", "n": 2, "source": "by hand",
               "reference": {"unique_solution": true}})");
  Write("solution.mtx", kVector + "2 1\n2\n1\n");
  const Problem problem = ReadProblemFolder(folder());
  EXPECT_EQ(problem.name, "stack");
  EXPECT_EQ(problem.source, "by hand");
  EXPECT_EQ(problem.lcp.lo, Eigen::Vector2d(0, 0));
  EXPECT_EQ(problem.lcp.hi, Eigen::Vector2d(kInfinite, kInfinite));
  EXPECT_EQ(problem.solution, Eigen::Vector2d(2, 1));
  EXPECT_EQ(problem.slack, Eigen::Vector2d(0, 0));
}

TEST_F(ProblemFolder, TakesOnlyWForTruthWhereXIsNotUnique) {
  WriteLcp(R"({"name": "stack", "kind": "lcp", "reference": {"unique_solution": false}})");
  Write("solution.mtx", kVector + "2 1\n2\n1\n");
  Write("w.mtx", kVector + "2 1\n0\n1e-17\n");
  EXPECT_EQ(ReadProblemFolder(folder()).solution.size(), 0);
  EXPECT_EQ(ReadProblemFolder(folder()).slack, Eigen::Vector2d(0, 1e-17));
}

TEST_F(ProblemFolder, TakesNothingForTruthThatWasNotVerified) {
  WriteLcp(R"({"name": "stack", "kind": "lcp", "verified": false,
               "reference": {"unique_solution": true}})");
  Write("solution.mtx", kVector + "2 1\n2\n1\n");
  EXPECT_EQ(ReadProblemFolder(folder()).solution.size(), 0);
  EXPECT_EQ(ReadProblemFolder(folder()).slack.size(), 0);
}

TEST_F(ProblemFolder, FreesTheFirstRowsOfAnMlcp) {
  WriteLcp(R"({"name": "joint", "kind": "mlcp", "n_a": 1, "n_b": 1})");
  const Problem problem = ReadProblemFolder(folder());
  EXPECT_EQ(problem.lcp.lo, Eigen::Vector2d(-kInfinite, 0));
  EXPECT_EQ(problem.lcp.hi, Eigen::Vector2d(kInfinite, kInfinite));
}

TEST_F(ProblemFolder, TakesHugeBoundsForInfinite) {
  WriteLcp(R"({"name": "box", "kind": "boxqp"})");
  Write("lower.mtx", kVector + "2 1\n-1e300\n-0.5\n");
  Write("upper.mtx", kVector + "2 1\n2\n1.0000000000000001e+300\n");
  const Problem problem = ReadProblemFolder(folder());
  EXPECT_EQ(problem.lcp.lo, Eigen::Vector2d(-kInfinite, -0.5));
  EXPECT_EQ(problem.lcp.hi, Eigen::Vector2d(2, kInfinite));
}

TEST_F(ProblemFolder, SaysWhatIsWrongWithMetaJson) {
  const auto error = [&](const std::string& meta) {
    WriteLcp(meta);
    return ErrorOfFolder();
  };
  const std::string path = Path("meta.json").string() + ": ";
  EXPECT_THAT(ErrorOfFolder(), HasSubstr("meta.json: cannot be read"));
  EXPECT_THAT(error("{"), HasSubstr("meta.json: is no JSON: "));
  EXPECT_THAT(error(R"({"n": 1e999})"), HasSubstr("meta.json: is no JSON: "));
  EXPECT_EQ(error("[]"), path + "expected a JSON object");
  EXPECT_EQ(error(R"({"kind": "lcp"})"), path + "'name' is missing; expected a text");
  EXPECT_EQ(error(R"({"name": 3, "kind": "lcp"})"), path + "'name' is no text");
  EXPECT_THAT(error(R"({"name": "../x", "kind": "lcp"})"), HasSubstr("'name' must be printable"));
  EXPECT_EQ(error(R"({"name": "a", "kind": "qp"})"),
            path + "unknown kind 'qp'; expected lcp, mlcp or boxqp");
  EXPECT_THAT(error(R"({"name": "a", "kind": "friction"})"),
              HasSubstr("kind 'friction' cannot be solved here"));
  EXPECT_EQ(error(R"({"name": "a", "kind": "lcp", "n": 3})"),
            path + "'n' is 3, but matrix.mtx has 2 rows");
  EXPECT_EQ(error(R"({"name": "a", "kind": "lcp", "n": -2})"),
            path + "'n' is no whole number, 0 or more");
  EXPECT_EQ(error(R"({"name": "a", "kind": "mlcp"})"),
            path + "'n_a' is missing; expected a number");
  EXPECT_EQ(error(R"({"name": "a", "kind": "mlcp", "n_a": 3})"),
            path + "'n_a' is 3, but matrix.mtx has 2 rows");
  Write("solution.mtx", kVector + "2 1\n2\n1\n");
  EXPECT_EQ(error(R"({"name": "a", "kind": "lcp", "reference": {"unique_solution": "yes"}})"),
            path + "'unique_solution' is neither true nor false");
}

TEST_F(ProblemFolder, RefusesSizesThatDoNotFitOneAnother) {
  for (const char* name : {"q.mtx", "lower.mtx", "upper.mtx", "solution.mtx", "w.mtx"}) {
    WriteLcp(R"({"name": "a", "kind": "boxqp"})");
    for (const char* bound : {"lower.mtx", "upper.mtx"}) Write(bound, kVector + "2 1\n0\n0\n");
    Write(name, kVector + "3 1\n0\n0\n0\n");
    EXPECT_EQ(ErrorOfFolder(),
              Path(name).string() + ": 3 numbers; expected 2, as matrix.mtx has rows");
    fs::remove(Path(name));
  }
  WriteLcp(R"({"name": "a", "kind": "boxqp"})");
  fs::remove(Path("lower.mtx"));
  EXPECT_THAT(ErrorOfFolder(), HasSubstr("lower.mtx: cannot be read"));
}

TEST_F(ProblemFolder, IsWrittenAsItIsRead) {
  for (const char* meta :
       {R"({"name": "a", "kind": "lcp", "source": "s", "reference": {"unique_solution": true}})",
        R"({"name": "a", "kind": "mlcp", "n_a": 1, "reference": {"unique_solution": false}})",
        R"({"name": "a", "kind": "boxqp"})"}) {
    SCOPED_TRACE(meta);
    WriteLcp(meta);
    Write("lower.mtx", kVector + "2 1\n-1e300\n0.1\n");
    Write("upper.mtx", kVector + "2 1\n1e300\n0.3\n");
    Write("solution.mtx", kVector + "2 1\n2\n1\n");
    const Problem first = ReadProblemFolder(folder());
    WriteProblemFolder(Path("again"), first);
    const Problem again = ReadProblemFolder(Path("again"));
    EXPECT_EQ(ReadKind(folder()), ReadKind(Path("again")));
    EXPECT_EQ(again.name, first.name);
    EXPECT_EQ(again.source, first.source);
    EXPECT_EQ(Eigen::MatrixXd(again.lcp.M), Eigen::MatrixXd(first.lcp.M));
    EXPECT_EQ(again.lcp.q, first.lcp.q);
    EXPECT_EQ(again.lcp.lo, first.lcp.lo);
    EXPECT_EQ(again.lcp.hi, first.lcp.hi);
    EXPECT_EQ(again.solution, first.solution);
    EXPECT_EQ(again.slack, first.slack);
  }
}

TEST_F(ProblemFolder, ListsTheFoldersInsideByName) {
  for (const char* name : {"b", "a", "c"}) fs::create_directories(Path(name));
  for (const char* name : {"b", "a"}) Write(std::string(name) + "/meta.json", "{}");
  EXPECT_EQ(ProblemFoldersIn(folder()), (std::vector<fs::path>{Path("a"), Path("b")}));
  EXPECT_FALSE(IsProblemFolder(Path("c")));
  EXPECT_THROW(ProblemFoldersIn(Path("none")), FileError);
}

/// CAIRN_PROBLEMS, or ../shared/problems beside the repository.
fs::path CollectedProblems() {
  if (const char* set = std::getenv("CAIRN_PROBLEMS")) return set;
  return fs::path(CAIRN_SOURCE_DIR).parent_path() / "shared/problems";
}

// Read back from the text, M x + q is w to the rounding of a row product.
TEST(CollectedProblems, HaveTheWTheySay) {
  const fs::path open = CollectedProblems() / "open";
  if (!fs::is_directory(open)) GTEST_SKIP() << open << " is not there; set CAIRN_PROBLEMS";
  int read = 0;
  for (const fs::path& folder : ProblemFoldersIn(open)) {
    SCOPED_TRACE(folder);
    if (ReadKind(folder) == "friction") {
      EXPECT_THROW(ReadProblemFolder(folder), FileError);
      continue;
    }
    const Problem problem = ReadProblemFolder(folder);
    EXPECT_EQ(lcp::Validate(problem.lcp).status, lcp::Status::kOk);
    ++read;
    if (problem.solution.size() == 0) continue;
    const Eigen::VectorXd w = problem.lcp.M * problem.solution + problem.lcp.q;
    const Eigen::VectorXd sizes =
        problem.lcp.M.cwiseAbs() * problem.solution.cwiseAbs() + problem.lcp.q.cwiseAbs();
    // n roundings of the largest sum of magnitudes, at most.
    const double rounding = static_cast<double>(problem.lcp.size()) *
                            std::numeric_limits<double>::epsilon() * sizes.maxCoeff();
    EXPECT_LE((w - problem.slack).lpNorm<Eigen::Infinity>(), rounding);
  }
  EXPECT_GT(read, 0);
}

}  // namespace
}  // namespace cairn::problems
