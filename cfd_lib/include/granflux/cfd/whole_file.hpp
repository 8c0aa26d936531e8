// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace granflux::cfd {

/// A file that appears under its name only when it is whole and on the disk; what had the name
/// before stays until then. For one rank. Nothing throws: after the first failure nothing more is
/// written, and `failure` has its text.
class WholeFile {
public:
  /// Opens `path`.part beside it.
  explicit WholeFile(std::string path);
  /// Removes what is unfinished.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void write(const void* bytes, std::size_t count);
  /// Returns whether the file is there now.
  bool finish();

  /// File and cause; empty as long as all went well.
  [[nodiscard]] const std::string& failure() const { return failure_; }

private:
  void fail();

  std::string path_, unfinished_, failure_;
  int file_ = -1;
};

/// A file in memory, read only. Throws ConfigError where it cannot be read.
class MappedFile {
public:
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] const char* data() const { return data_; }
  [[nodiscard]] std::size_t size() const { return size_; }

private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

} // namespace granflux::cfd
