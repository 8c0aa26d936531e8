// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/whole_file.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include <granflux/cfd/error.hpp>

namespace granflux::cfd {

WholeFile::WholeFile(std::string path) : path_(std::move(path)), unfinished_(path_ + ".part") {
  constexpr mode_t readable = 0666; // less what the user's mask takes off
  file_ = open(unfinished_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, readable);
  if (file_ < 0)
    fail();
}

WholeFile::~WholeFile() {
  if (file_ < 0)
    return;
  close(file_);
  unlink(unfinished_.c_str());
}

/// By what the system said last.
void WholeFile::fail() {
  if (failure_.empty())
    failure_ = path_ + ": " + std::strerror(errno);
}

void WholeFile::write(const void* bytes, std::size_t count) {
  constexpr std::size_t most = std::size_t(1) << 30; // the system takes no more in one go
  const auto* at = static_cast<const char*>(bytes);
  while (failure_.empty() && count > 0) {
    const ssize_t done = ::write(file_, at, std::min(count, most));
    if (done < 0 && errno == EINTR)
      continue;
    if (done < 0)
      return fail();
    at += done;
    count -= std::size_t(done);
  }
}

bool WholeFile::finish() {
  if (file_ < 0)
    return false;
  if (failure_.empty() && fsync(file_) != 0)
    fail();
  if (close(file_) != 0)
    fail();
  file_ = -1;
  if (failure_.empty() && std::rename(unfinished_.c_str(), path_.c_str()) != 0)
    fail();
  if (!failure_.empty()) {
    unlink(unfinished_.c_str());
    return false;
  }
  // The name, too, is to outlive a loss of power; some file systems cannot promise it.
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  const int names = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (names >= 0) {
    fsync(names);
    close(names);
  }
  return true;
}

MappedFile::MappedFile(const std::string& path) {
  const auto refuse = [&] {
    throw ConfigError(std::string("cannot be read: ") + std::strerror(errno));
  };
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0)
    refuse();
  struct stat about {};
  void* where = nullptr;
  const bool known = fstat(file, &about) == 0;
  size_ = known ? std::size_t(about.st_size) : 0;
  if (known && size_ > 0)
    where = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0);
  const bool mapped = known && where != MAP_FAILED;
  close(file);
  if (!mapped)
    refuse();
  data_ = static_cast<const char*>(where);
}

MappedFile::~MappedFile() {
  if (data_)
    munmap(const_cast<char*>(data_), size_);
}

} // namespace granflux::cfd
