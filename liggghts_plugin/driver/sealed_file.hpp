// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <mpi.h>
#include <string>
#include <thread>

#include <granflux/cfd/whole_file.hpp>

namespace granflux::driver {

/// A file of a host with a seal behind it: the length and the checksum of all that is before, so
/// that damage shows before the host reads it. Hosts write by name and do not look whether the
/// disk took it; they write to path() instead, a pipe, and what comes through is checked, sealed
/// and put on the disk as a whole (WholeFile). For one rank.
class SealedFile {
public:
  explicit SealedFile(const std::string& path);
  ~SealedFile();
  SealedFile(const SealedFile&) = delete;
  SealedFile& operator=(const SealedFile&) = delete;

  /// What the host opens for writing and closes.
  [[nodiscard]] const std::string& path() const { return pipe_path_; }
  /// Returns whether the file is there now.
  bool finish();
  /// File and cause; empty as long as all went well.
  [[nodiscard]] const std::string& failure() const { return file_.failure(); }

private:
  void drain();

  cfd::WholeFile file_;
  int read_end_ = -1, write_end_ = -1;
  std::string pipe_path_;
  std::thread reader_;
};

/// Before a host reads a restart file: throws ConfigError on all ranks where it is a checkpoint
/// that is torn or damaged. Of files that never were sealed the host has to tell. Collective.
void check_restart_file(const std::string& path, MPI_Comm comm);

} // namespace granflux::driver
