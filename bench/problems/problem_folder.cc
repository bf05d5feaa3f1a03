// SPDX-License-Identifier: MIT
#include "problems/problem_folder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace cairn::problems {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// meta.json, with the path for messages.
class Meta {
 public:
  explicit Meta(const fs::path& folder) : path_(folder / "meta.json") {
    try {
      json_ = Json::parse(ReadText(path_));
    } catch (const Json::exception& error) {
      Refuse(std::string("is no JSON: ") + error.what());
    }
    if (!json_.is_object()) Refuse("expected a JSON object");
  }

  [[noreturn]] void Refuse(const std::string& message) const { throw FileError(path_, message); }

  std::string Text(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) Refuse(std::string("'") + key + "' is missing; expected a text");
    if (!found->is_string()) Refuse(std::string("'") + key + "' is no text");
    return found->get<std::string>();
  }

  std::string TextOr(const char* key, const std::string& other) const {
    return json_.contains(key) ? Text(key) : other;
  }

  Eigen::Index Count(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) Refuse(std::string("'") + key + "' is missing; expected a number");
    if (!found->is_number_unsigned()) {
      Refuse(std::string("'") + key + "' is no whole number, 0 or more");
    }
    return static_cast<Eigen::Index>(found->get<std::uint64_t>());
  }

  bool Has(const char* key) const { return json_.contains(key); }

  /// True if the key is there and true; `inside` is an object that holds it, or null.
  bool Says(const char* inside, const char* key, bool otherwise) const {
    const Json* holder = &json_;
    if (inside != nullptr) {
      const auto found = json_.find(inside);
      if (found == json_.end() || found->is_null()) return otherwise;
      if (!found->is_object()) Refuse(std::string("'") + inside + "' is no object");
      holder = &*found;
    }
    const auto value = holder->find(key);
    if (value == holder->end() || value->is_null()) return otherwise;
    if (!value->is_boolean()) Refuse(std::string("'") + key + "' is neither true nor false");
    return value->get<bool>();
  }

 private:
  fs::path path_;
  Json json_;
};

/// A name becomes the name of a folder where results are written.
std::string ReadName(const Meta& meta) {
  const std::string name = meta.Text("name");
  const bool is_usable =
      !name.empty() && name.front() != '.' &&
      std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return c > ' ' && c < 127 && c != '/' && c != '\\' && c != ',' && c != '"';
      });
  if (!is_usable) {
    meta.Refuse(
        "'name' must be printable ASCII without blanks, commas, quotes and slashes, and not begin "
        "with a dot");
  }
  return name;
}

enum class Kind { kLcp, kMlcp, kBoxQp };

Kind ReadUsableKind(const Meta& meta) {
  const std::string kind = meta.Text("kind");
  if (kind == "lcp") return Kind::kLcp;
  if (kind == "mlcp") return Kind::kMlcp;
  if (kind == "boxqp") return Kind::kBoxQp;
  if (kind == "friction") {
    meta.Refuse(
        "kind 'friction' cannot be solved here: its bounds follow other unknowns, so it is no "
        "boxed "
        "LCP; expected lcp, mlcp or boxqp");
  }
  meta.Refuse("unknown kind '" + kind + "'; expected lcp, mlcp or boxqp");
}

Eigen::VectorXd ReadSized(const fs::path& path, Eigen::Index n) {
  Eigen::VectorXd vector = ReadVector(path);
  if (vector.size() != n) {
    throw FileError(path, std::to_string(vector.size()) + " numbers; expected " +
                              std::to_string(n) + ", as matrix.mtx has rows");
  }
  return vector;
}

Eigen::VectorXd ReadBound(const fs::path& path, Eigen::Index n) {
  return ReadSized(path, n).unaryExpr([](double bound) {
    return std::abs(bound) >= kFileInfinity ? std::copysign(kInfinite, bound) : bound;
  });
}

void ReadBounds(const fs::path& folder, const Meta& meta, BoxedLcp* lcp) {
  const Eigen::Index n = lcp->q.size();
  const Kind kind = ReadUsableKind(meta);
  if (kind == Kind::kBoxQp) {
    lcp->lo = ReadBound(folder / "lower.mtx", n);
    lcp->hi = ReadBound(folder / "upper.mtx", n);
    return;
  }
  lcp->lo = Eigen::VectorXd::Zero(n);
  lcp->hi = Eigen::VectorXd::Constant(n, kInfinite);
  if (kind == Kind::kLcp) return;
  const Eigen::Index free = meta.Count("n_a");
  if (free > n) {
    meta.Refuse("'n_a' is " + std::to_string(free) + ", but matrix.mtx has " + std::to_string(n) +
                " rows");
  }
  lcp->lo.head(free).setConstant(-kInfinite);
}

void ReadReference(const fs::path& folder, const Meta& meta, Problem* problem) {
  const Eigen::Index n = problem->lcp.q.size();
  const fs::path solution = folder / "solution.mtx", slack = folder / "w.mtx";
  const bool verified = meta.Says(nullptr, "verified", true);
  const bool unique = meta.Says("reference", "unique_solution", false);
  Eigen::VectorXd x, w;
  if (fs::exists(solution)) x = ReadSized(solution, n);
  if (fs::exists(slack)) w = ReadSized(slack, n);
  if (!verified) return;
  if (w.size() == 0 && x.size() != 0) w = problem->lcp.M * x + problem->lcp.q;
  if (unique) problem->solution = x;
  problem->slack = w;
}

bool IsInfinite(const Eigen::VectorXd& bound, Eigen::Index from) {
  return (bound.tail(bound.size() - from).array().abs() == kInfinite).all();
}

/// The number of free rows that an mlcp begins with; -1 if the bounds are those of no lcp or mlcp.
Eigen::Index FreeRowsOf(const BoxedLcp& lcp) {
  if (!IsInfinite(lcp.hi, 0) || (lcp.hi.array() < 0).any()) return -1;
  Eigen::Index free = 0;
  while (free < lcp.size() && lcp.lo[free] == -kInfinite) ++free;
  return (lcp.lo.tail(lcp.size() - free).array() == 0).all() ? free : -1;
}

Eigen::VectorXd ToFile(const Eigen::VectorXd& bound) {
  return bound.cwiseMax(-kFileInfinity).cwiseMin(kFileInfinity);
}

}  // namespace

bool IsProblemFolder(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "meta.json", ignored);
}

std::vector<fs::path> ProblemFoldersIn(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (IsProblemFolder(entry->path())) folders.push_back(entry->path());
  }
  if (error) throw FileError(folder, "cannot be listed: " + error.message());
  std::sort(folders.begin(), folders.end());
  return folders;
}

std::string ReadKind(const fs::path& folder) { return Meta(folder).Text("kind"); }

Problem ReadProblemFolder(const fs::path& folder) {
  const Meta meta(folder);
  Problem problem;
  problem.name = ReadName(meta);
  problem.source = meta.TextOr("source", "");
  ReadUsableKind(meta);  // before large files are read
  problem.lcp.M = ReadMatrix(folder / "matrix.mtx");
  const Eigen::Index n = problem.lcp.M.rows();
  if (meta.Has("n") && meta.Count("n") != n) {
    meta.Refuse("'n' is " + std::to_string(meta.Count("n")) + ", but matrix.mtx has " +
                std::to_string(n) + " rows");
  }
  problem.lcp.q = ReadSized(folder / "q.mtx", n);
  ReadBounds(folder, meta, &problem.lcp);
  ReadReference(folder, meta, &problem);
  return problem;
}

void WriteProblemFolder(const fs::path& folder, const Problem& problem) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(folder, "cannot be made: " + error.message());
  const BoxedLcp& lcp = problem.lcp;
  const Eigen::Index free = FreeRowsOf(lcp);
  Json meta = {{"name", problem.name},
               {"kind", free < 0    ? "boxqp"
                        : free == 0 ? "lcp"
                                    : "mlcp"},
               {"source", problem.source},
               {"n", lcp.size()},
               {"nnz", lcp.M.nonZeros()}};
  if (free >= 0) {
    meta["n_a"] = free;
    meta["n_b"] = lcp.size() - free;
  }
  WriteSymmetric(folder / "matrix.mtx", lcp.M);
  WriteVector(folder / "q.mtx", lcp.q);
  if (free < 0) {
    WriteVector(folder / "lower.mtx", ToFile(lcp.lo));
    WriteVector(folder / "upper.mtx", ToFile(lcp.hi));
  }
  if (problem.solution.size() != 0) WriteVector(folder / "solution.mtx", problem.solution);
  if (problem.slack.size() != 0) WriteVector(folder / "w.mtx", problem.slack);
  meta["reference"] = {{"unique_solution", problem.solution.size() != 0}};
  WriteText(folder / "meta.json", meta.dump(1) + "\n");
}

}  // namespace cairn::problems
