// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/cgns_writer.hpp>

#include <array>
#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <cgnslib.h>
#include <fmt/format.h>

#include <granflux/cfd/error.hpp>

namespace granflux::cfd {

namespace {

constexpr int message_tag = 7301;

/// The components to be written, each by its name, as flat lists.
struct Component {
  std::string name;
  std::vector<const Field*> blocks; ///< on the blocks of this rank, in the order of Mesh::local
};

std::vector<Component> components_of(const std::vector<NamedVector>& vectors,
                                     const std::vector<NamedField>& scalars) {
  std::vector<Component> components;
  for (const NamedVector& vector : vectors)
    for (std::size_t d = 0; d < 3; ++d) {
      components.push_back({vector.name + "XYZ" [d], {}});
      for (const VectorField& block : *vector.values)
        components.back().blocks.push_back(&block[d]);
    }
  for (const NamedField& scalar : scalars) {
    components.push_back({scalar.name, {}});
    for (const Field& block : *scalar.values)
      components.back().blocks.push_back(&block);
  }
  constexpr std::size_t longest = 32; // of a node's name in a CGNS file
  for (const Component& component : components)
    if (component.name.empty() || component.name.size() > longest)
      throw ConfigError(fmt::format("field name \"{}\": a CGNS file takes 1 to {} characters",
                                    component.name, longest));
  return components;
}

/// Interior values in the file's order, i fastest.
std::vector<double> packed(const Layout& layout, const Field& field) {
  std::vector<double> values;
  values.reserve(std::size_t(layout.interior()));
  for (int k = 0; k < layout.cells[2]; ++k)
    for (int j = 0; j < layout.cells[1]; ++j)
      for (int i = 0; i < layout.cells[0]; ++i)
        values.push_back(field[layout.at(i, j, k)]);
  return values;
}

/// Node coordinates along each direction of one block of a lattice [m].
std::array<std::vector<double>, 3> block_nodes(const Lattice& lattice, int block) {
  const Index3 blocks = lattice.blocks();
  const Index3 slab{block % blocks[0], block / blocks[0] % blocks[1],
                    block / (blocks[0] * blocks[1])};
  std::array<std::vector<double>, 3> nodes;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto begin = lattice.nodes[d].begin();
    const std::size_t s = std::size_t(slab[d]);
    nodes[d].assign(begin + lattice.starts[d][s], begin + lattice.starts[d][s + 1] + 1);
  }
  return nodes;
}

/// An open CGNS file on rank 0. After the first failure nothing more is written; `failure` keeps
/// its text.
class FileOnRankZero {
public:
  /// With a fault to begin with, nothing is opened.
  FileOnRankZero(const std::string& name, double time, std::string fault)
      : failure(std::move(fault)) {
    if (!failure.empty())
      return;
    cg_set_file_type(CG_FILE_HDF5);
    opened_ = done(cg_open(name.c_str(), CG_MODE_WRITE, &file_));
    if (opened_)
      write_base(time);
  }
  FileOnRankZero(const FileOnRankZero&) = delete;
  FileOnRankZero& operator=(const FileOnRankZero&) = delete;
  ~FileOnRankZero() { close(); }

  void write_zone(int block, const Index3& cells, const std::array<std::vector<double>, 3>& nodes) {
    if (!failure.empty())
      return;
    std::array<cgsize_t, 9> size{};
    for (std::size_t d = 0; d < 3; ++d)
      size[d] = cells[d] + 1, size[3 + d] = cells[d];
    const std::string name = fmt::format("Block{:05d}", block);
    done(cg_zone_write(file_, base_, name.c_str(), size.data(), CGNS_ENUMV(Structured), &zone_));

    std::vector<double> coordinate(nodes[0].size() * nodes[1].size() * nodes[2].size());
    for (std::size_t d = 0; d < 3; ++d) {
      std::size_t n = 0;
      for (std::size_t k = 0; k < nodes[2].size(); ++k)
        for (std::size_t j = 0; j < nodes[1].size(); ++j)
          for (std::size_t i = 0; i < nodes[0].size(); ++i)
            coordinate[n++] = nodes[d][d == 0 ? i : d == 1 ? j : k];
      int written = 0;
      const std::string title = std::string("Coordinate") + "XYZ"[d];
      done(cg_coord_write(file_, base_, zone_, CGNS_ENUMV(RealDouble), title.c_str(),
                          coordinate.data(), &written));
    }
    done(cg_sol_write(file_, base_, zone_, solution_name, CGNS_ENUMV(CellCenter), &solution_));
    write_zone_time();
  }

  void write_field(const std::string& name, const std::vector<double>& values) {
    int written = 0;
    if (failure.empty())
      done(cg_field_write(file_, base_, zone_, solution_, CGNS_ENUMV(RealDouble), name.c_str(),
                          values.data(), &written));
  }

  void close() {
    if (std::exchange(opened_, false))
      done(cg_close(file_));
  }

  std::string failure;

private:
  static constexpr const char* solution_name = "FlowSolution";

  void write_base(double time) {
    done(cg_base_write(file_, "GranFlux", 3, 3, &base_));
    done(cg_simulation_type_write(file_, base_, CGNS_ENUMV(TimeAccurate)));
    done(cg_biter_write(file_, base_, "TimeIterValues", 1));
    const cgsize_t one = 1;
    done(cg_goto(file_, base_, "BaseIterativeData_t", 1, "end"));
    done(cg_array_write("TimeValues", CGNS_ENUMV(RealDouble), 1, &one, &time));
    done(cg_goto(file_, base_, "end"));
    done(cg_descriptor_write("Units", "SI: m, s, m/s, Pa; Pressure is dynamic, p - rho g.x"));
  }

  /// Readers find the solution of a time through this list, 32 characters a name.
  void write_zone_time() {
    done(cg_ziter_write(file_, base_, zone_, "ZoneIterativeData"));
    done(cg_goto(file_, base_, "Zone_t", zone_, "ZoneIterativeData_t", 1, "end"));
    const std::string name = fmt::format("{:<32}", solution_name);
    const std::array<cgsize_t, 2> size{32, 1};
    done(
        cg_array_write("FlowSolutionPointers", CGNS_ENUMV(Character), 2, size.data(), name.data()));
  }

  bool done(int status) {
    if (status != CG_OK && failure.empty())
      failure = cg_get_error();
    return status == CG_OK;
  }

  bool opened_ = false;
  int file_ = 0, base_ = 0, zone_ = 0, solution_ = 0;
};

std::string broadcast(std::string text, MPI_Comm comm) {
  int size = int(text.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  text.resize(std::size_t(size));
  MPI_Bcast(text.data(), size, MPI_CHAR, 0, comm);
  return text;
}

/// Why files cannot be made at a path; empty if they can.
std::string folder_fault(const std::string& path) {
  std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (folder.empty())
    folder = ".";
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error))
    return fmt::format("the folder \"{}\" does not exist", folder.string());
  if (access(folder.c_str(), W_OK) != 0)
    return fmt::format("the folder \"{}\" is not writable: {}", folder.string(),
                       std::generic_category().message(errno));
  return {};
}

/// Most that the file can take [bytes]: its numbers, and generous room for HDF5's own structures.
std::size_t file_size(const Mesh& mesh, std::size_t components) {
  constexpr std::size_t per_base = 64 << 10, per_zone = 64 << 10, per_array = 8 << 10;
  std::size_t bytes = per_base;
  for (const BlockInfo& info : mesh.blocks) {
    std::size_t nodes = 1, cells = 1;
    for (const int n : info.cells)
      nodes *= std::size_t(n) + 1, cells *= std::size_t(n);
    bytes += per_zone + (3 + components) * per_array;
    bytes += (3 * nodes + components * cells) * sizeof(double);
  }
  return bytes;
}

/// Whether that much can be written to a file of that name, by taking the room and giving it back.
/// HDF5 1.10 does not survive a write that fails: its next use, or the end of the program, crashes.
std::string room_fault(const std::string& name, std::size_t bytes) {
  const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0)
    return std::generic_category().message(errno);
  const int code = posix_fallocate(file, 0, off_t(bytes));
  close(file);
  return code == 0 ? "" : std::generic_category().message(code);
}

/// Rank 0's part of a write: takes every block from its owner, even after a failure, so that no
/// owner waits for ever. Returns the text of the failure.
std::string write_file(const Mesh& mesh, const std::string& name, double time,
                       const std::vector<Component>& components) {
  FileOnRankZero file(name, time, room_fault(name, file_size(mesh, components.size())));
  std::size_t local = 0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const BlockInfo& info = mesh.blocks[b];
    file.write_zone(int(b), info.cells, block_nodes(*mesh.lattice, int(b)));
    const Layout layout(info.cells);
    std::vector<double> values;
    for (const Component& component : components) {
      if (info.rank == 0) {
        values = packed(layout, *component.blocks[local]);
      } else {
        values.resize(std::size_t(layout.interior()));
        MPI_Recv(values.data(), int(values.size()), MPI_DOUBLE, info.rank, message_tag, mesh.comm,
                 MPI_STATUS_IGNORE);
      }
      file.write_field(component.name, values);
    }
    local += info.rank == 0;
  }
  file.close();
  return file.failure;
}

void send_blocks(const Mesh& mesh, const std::vector<Component>& components) {
  for (std::size_t local = 0; local < mesh.local.size(); ++local)
    for (const Component& component : components) {
      const auto values = packed(mesh.local[local].layout, *component.blocks[local]);
      MPI_Send(values.data(), int(values.size()), MPI_DOUBLE, 0, message_tag, mesh.comm);
    }
}

} // namespace

CgnsWriter::CgnsWriter(const Mesh& mesh, std::string path, long first)
    : mesh_(mesh), path_(std::move(path)), next_(first) {
  if (!mesh.lattice)
    throw ConfigError("CGNS output needs a box mesh");
  int rank = 0;
  MPI_Comm_rank(mesh.comm, &rank);
  const std::string fault = broadcast(rank == 0 ? folder_fault(path_) : "", mesh.comm);
  if (!fault.empty())
    throw ConfigError(fmt::format("[output] fields = \"{}\": {}", path_, fault));
}

std::string CgnsWriter::write(const GasSolver& solver, const std::vector<NamedField>& extra) {
  std::vector<NamedField> scalars{{"Pressure", &solver.pressure()},
                                  {"VoidFraction", &solver.void_fraction()}};
  if (solver.temperature())
    scalars.push_back({"Temperature", solver.temperature()});
  scalars.insert(scalars.end(), extra.begin(), extra.end());
  return write(solver.time(), {{"Velocity", &solver.velocity()}}, scalars);
}

std::string CgnsWriter::write(double time, const std::vector<NamedVector>& vectors,
                              const std::vector<NamedField>& scalars) {
  const std::vector<Component> components = components_of(vectors, scalars);
  const std::string name = fmt::format("{}_{:06d}.cgns", path_, next_);
  const std::string unfinished = name + ".part";
  int rank = 0;
  MPI_Comm_rank(mesh_.comm, &rank);
  std::string failure;
  if (rank == 0) {
    failure = write_file(mesh_, unfinished, time, components);
    std::error_code error;
    if (failure.empty()) {
      std::filesystem::rename(unfinished, name, error);
      if (error)
        failure = error.message();
    }
    if (!failure.empty())
      std::filesystem::remove(unfinished, error);
  } else {
    send_blocks(mesh_, components);
  }
  failure = broadcast(failure, mesh_.comm);
  if (!failure.empty())
    throw NumericalError(
        fmt::format("\"{}\" at t = {:g} s cannot be written: {}", name, time, failure));
  ++next_;
  return name;
}

} // namespace granflux::cfd
