// SPDX-License-Identifier: MIT
// Matrix Market text, read strictly. Eigen's unsupported reader takes a file that was cut short for
// a whole one, and fills what is missing with zeros; hence our own.
#pragma once

#include <Eigen/SparseCore>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace cairn::problems {

/// A file cannot be used. What() is for people: "path:line: what is wrong, what was expected".
class FileError : public std::runtime_error {
 public:
  FileError(const std::filesystem::path& path, const std::string& message);
  /// @param line  >= 1
  FileError(const std::filesystem::path& path, long long line, const std::string& message);
};

/// A file of `matrix array real general` or `matrix array integer general` with one column.
/// @throws FileError also for numbers that are not finite, too few or too many.
Eigen::VectorXd ReadVector(const std::filesystem::path& path);

/// A square matrix with both triangles: a file of `matrix coordinate real symmetric`, which stores
/// the lower triangle, or of `matrix coordinate real general`. For real, integer will do.
/// @throws FileError as above, for an index out of range, an entry given twice, and for fewer
/// entries than rows: a matrix that is positive on its diagonal has at least those.
Eigen::SparseMatrix<double> ReadMatrix(const std::filesystem::path& path);

/// Writes so that reading gives the same bits. @throws FileError if the file cannot be written.
void WriteVector(const std::filesystem::path& path, const Eigen::VectorXd& vector);
/// Writes the lower triangle. @pre matrix is symmetric
void WriteSymmetric(const std::filesystem::path& path, const Eigen::SparseMatrix<double>& matrix);

/// The whole file, and the reverse. @throws FileError
std::string ReadText(const std::filesystem::path& path);
void WriteText(const std::filesystem::path& path, const std::string& text);

}  // namespace cairn::problems
