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
constexpr std::size_t longest_name = 32; ///< of a node in a CGNS file

/// One array to be written for each block.
struct Component {
  std::string name;
  std::vector<const Field*> blocks; ///< on the blocks of this rank, in the order of Mesh::local
};

/// Where the nodes are, CGNS' names.
std::vector<Component> coordinates_of(const Mesh& mesh) {
  std::vector<Component> coordinates;
  for (std::size_t d = 0; d < 3; ++d) {
    coordinates.push_back({std::string("Coordinate") + "XYZ" [d], {}});
    for (const Block& block : mesh.local)
      coordinates.back().blocks.push_back(&block.node[d]);
  }
  return coordinates;
}

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
  for (const Component& component : components)
    if (component.name.empty() || component.name.size() > longest_name)
      throw ConfigError(fmt::format("field name \"{}\": a CGNS file takes 1 to {} characters",
                                    component.name, longest_name));
  return components;
}

/// One more node than cells along each direction.
Index3 nodes_of(const Index3& cells) {
  return {cells[0] + 1, cells[1] + 1, cells[2] + 1};
}

std::size_t count(const Index3& n) {
  return std::size_t(n[0]) * std::size_t(n[1]) * std::size_t(n[2]);
}

/// The first n values along each direction in the file's order, i fastest.
std::vector<double> packed(const Layout& layout, const Index3& n, const Field& field) {
  std::vector<double> values;
  values.reserve(count(n));
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
        values.push_back(field[layout.at(i, j, k)]);
  return values;
}

std::string zone_name(int block) {
  return fmt::format("Block{:05d}", block);
}

/// The nodes around the faces of a patch, first and last, counted from 1 as in the file.
std::array<Index3, 2> node_range(const Patch& patch) {
  std::array<Index3, 2> range{patch.cells.lo, patch.cells.hi};
  const auto d = std::size_t(patch.side.direction);
  (patch.side.high ? range[0] : range[1])[d] = patch.side.high ? range[1][d] : range[0][d];
  for (Index3& corner : range)
    for (int& n : corner)
      ++n;
  return range;
}

/// The donor's node for one of this block, both counted from 1.
Index3 donor_node(const Link& link, const Index3& node) {
  Index3 donor = link.donor({node[0] - 1, node[1] - 1, node[2] - 1});
  for (std::size_t a = 0; a < 3;
       ++a) // where the order turns, a cell's low node becomes its high one
    donor[a] += link.sign[a] < 0 ? 2 : 1;
  return donor;
}

std::array<cgsize_t, 6> file_range(const Index3& begin, const Index3& end) {
  return {begin[0], begin[1], begin[2], end[0], end[1], end[2]};
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

  void write_families(const std::vector<std::string>& boundaries) {
    for (std::size_t b = 0; b < boundaries.size() && failure.empty(); ++b) {
      families_.push_back(family_name(boundaries[b], b));
      int family = 0;
      done(cg_family_write(file_, base_, families_.back().c_str(), &family));
      done(cg_goto(file_, base_, "Family_t", family, "end"));
      done(cg_descriptor_write("Boundary", boundaries[b].c_str()));
    }
  }

  void begin_zone(int block, const Index3& cells) {
    if (!failure.empty())
      return;
    std::array<cgsize_t, 9> size{};
    for (std::size_t d = 0; d < 3; ++d)
      size[d] = cells[d] + 1, size[3 + d] = cells[d];
    done(cg_zone_write(file_, base_, zone_name(block).c_str(), size.data(), CGNS_ENUMV(Structured),
                       &zone_));
  }

  /// Boundaries and connections of the zone just begun.
  void write_patches(const std::vector<Patch>& patches) {
    for (std::size_t p = 0; p < patches.size() && failure.empty(); ++p)
      patches[p].link ? write_link(p, patches[p]) : write_boundary(p, patches[p]);
  }

  void write_coordinate(const std::string& name, const std::vector<double>& values) {
    int written = 0;
    if (failure.empty())
      done(cg_coord_write(file_, base_, zone_, CGNS_ENUMV(RealDouble), name.c_str(), values.data(),
                          &written));
  }

  void begin_fields() {
    if (!failure.empty())
      return;
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
    done(cg_dataclass_write(CGNS_ENUMV(Dimensional)));
    done(cg_units_write(CGNS_ENUMV(Kilogram), CGNS_ENUMV(Meter), CGNS_ENUMV(Second),
                        CGNS_ENUMV(Kelvin), CGNS_ENUMV(Radian)));
  }

  /// A boundary's own name where the format takes it; else one by number, and the name is in the
  /// family's descriptor only.
  static std::string family_name(const std::string& boundary, std::size_t number) {
    const bool fits = boundary.size() <= longest_name && boundary.find('/') == std::string::npos;
    return fits ? boundary : fmt::format("Boundary{}", number);
  }

  void write_boundary(std::size_t number, const Patch& patch) {
    const auto [begin, end] = node_range(patch);
    const std::array<cgsize_t, 6> range = file_range(begin, end);
    int condition = 0;
    done(cg_boco_write(file_, base_, zone_, fmt::format("Patch{}", number).c_str(),
                       CGNS_ENUMV(FamilySpecified), CGNS_ENUMV(PointRange), 2, range.data(),
                       &condition));
    done(cg_goto(file_, base_, "Zone_t", zone_, "ZoneBC_t", 1, "BC_t", condition, "end"));
    done(cg_famname_write(families_[std::size_t(patch.boundary)].c_str()));
  }

  void write_link(std::size_t number, const Patch& patch) {
    const Link& link = *patch.link;
    const auto [begin, end] = node_range(patch);
    const std::array<cgsize_t, 6> range = file_range(begin, end),
                                  donor =
                                      file_range(donor_node(link, begin), donor_node(link, end));
    std::array<int, 3> transform{};
    for (std::size_t a = 0; a < 3; ++a)
      transform[std::size_t(link.axis[a])] = link.sign[a] * int(a + 1);
    int connection = 0;
    done(cg_1to1_write(file_, base_, zone_, fmt::format("Link{}", number).c_str(),
                       zone_name(link.block).c_str(), range.data(), donor.data(), transform.data(),
                       &connection));
    if (link.shift == Vec3{})
      return;
    const std::array<float, 3> none{},
        to_donor{float(-link.shift.x), float(-link.shift.y), float(-link.shift.z)};
    done(cg_1to1_periodic_write(file_, base_, zone_, connection, none.data(), none.data(),
                                to_donor.data()));
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
  std::vector<std::string> families_; ///< of the mesh's boundaries
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
  constexpr std::size_t per_base = 64 << 10, per_zone = 64 << 10, per_array = 8 << 10,
                        per_patch = 48 << 10, per_family = 16 << 10;
  std::size_t bytes = per_base + per_family * mesh.boundaries.size();
  for (const BlockInfo& info : mesh.blocks) {
    bytes += per_zone + (3 + components) * per_array + info.patches.size() * per_patch;
    bytes += (3 * count(nodes_of(info.cells)) + components * count(info.cells)) * sizeof(double);
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

/// One array of a block on rank 0: its own, or what the owner sends.
std::vector<double> taken(const Mesh& mesh, const BlockInfo& info, const Index3& n,
                          const Field* own) {
  if (own)
    return packed(Layout(info.cells), n, *own);
  std::vector<double> values(count(n));
  MPI_Recv(values.data(), int(values.size()), MPI_DOUBLE, info.rank, message_tag, mesh.comm,
           MPI_STATUS_IGNORE);
  return values;
}

/// Rank 0's part of a write: takes every block from its owner, even after a failure, so that no
/// owner waits for ever. Returns the text of the failure.
std::string write_file(const Mesh& mesh, const std::string& name, double time, bool patches,
                       const std::vector<Component>& coordinates,
                       const std::vector<Component>& components) {
  FileOnRankZero file(name, time, room_fault(name, file_size(mesh, components.size())));
  if (patches)
    file.write_families(mesh.boundaries);
  std::size_t local = 0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const BlockInfo& info = mesh.blocks[b];
    const bool own = info.rank == 0;
    file.begin_zone(int(b), info.cells);
    if (patches)
      file.write_patches(info.patches);
    for (const Component& coordinate : coordinates)
      file.write_coordinate(coordinate.name, taken(mesh, info, nodes_of(info.cells),
                                                   own ? coordinate.blocks[local] : nullptr));
    file.begin_fields();
    for (const Component& component : components)
      file.write_field(component.name,
                       taken(mesh, info, info.cells, own ? component.blocks[local] : nullptr));
    local += own;
  }
  file.close();
  return file.failure;
}

void send_blocks(const Mesh& mesh, const std::vector<Component>& coordinates,
                 const std::vector<Component>& components) {
  const auto send = [&](const Block& block, const Index3& n, const Field& field) {
    const std::vector<double> values = packed(block.layout, n, field);
    MPI_Send(values.data(), int(values.size()), MPI_DOUBLE, 0, message_tag, mesh.comm);
  };
  for (std::size_t local = 0; local < mesh.local.size(); ++local) {
    const Block& block = mesh.local[local];
    for (const Component& coordinate : coordinates)
      send(block, nodes_of(block.layout.cells), *coordinate.blocks[local]);
    for (const Component& component : components)
      send(block, block.layout.cells, *component.blocks[local]);
  }
}

} // namespace

CgnsWriter::CgnsWriter(const Mesh& mesh, std::string path, long first)
    : mesh_(mesh), path_(std::move(path)), first_(first), next_(first) {
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
  const std::vector<Component> coordinates = coordinates_of(mesh_);
  const std::string name = fmt::format("{}_{:06d}.cgns", path_, next_);
  const std::string unfinished = name + ".part";
  int rank = 0;
  MPI_Comm_rank(mesh_.comm, &rank);
  std::string failure;
  if (rank == 0) {
    failure = write_file(mesh_, unfinished, time, next_ == first_, coordinates, components);
    std::error_code error;
    if (failure.empty()) {
      std::filesystem::rename(unfinished, name, error);
      if (error)
        failure = error.message();
    }
    if (!failure.empty())
      std::filesystem::remove(unfinished, error);
  } else {
    send_blocks(mesh_, coordinates, components);
  }
  failure = broadcast(failure, mesh_.comm);
  if (!failure.empty())
    throw NumericalError(
        fmt::format("\"{}\" at t = {:g} s cannot be written: {}", name, time, failure));
  ++next_;
  return name;
}

} // namespace granflux::cfd
