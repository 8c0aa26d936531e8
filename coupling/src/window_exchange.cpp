// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/window_exchange.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace granflux::coupling {

using cfd::Index3;

namespace {

constexpr int consensus_tag = 2101, deposit_tag = 2102, sample_tag = 2103;

/// Cells of a frame along one direction that lie in one slab of blocks.
struct Run {
  int slab = 0, frame = 0, cell = 0, count = 0;
};

/// Splits lo <= i < lo + count along direction d into runs, through every periodic image.
std::vector<Run> split(const cfd::Lattice& lattice, std::size_t d, int lo, int count) {
  const int n = lattice.cells()[d];
  const std::vector<int>& starts = lattice.starts[d];
  std::vector<Run> runs;
  for (int i = lo; i < lo + count;) {
    const int cell = lattice.periodic[d] ? ((i % n) + n) % n : i;
    const auto slab = std::upper_bound(starts.begin(), starts.end(), cell) - starts.begin() - 1;
    const int end = starts[std::size_t(slab) + 1];
    const int length = std::min(end - cell, lo + count - i);
    runs.push_back({int(slab), i, cell - starts[std::size_t(slab)], length});
    i += length;
  }
  return runs;
}

std::size_t cells_of(const Index3& n) {
  return std::size_t(n[0]) * std::size_t(n[1]) * std::size_t(n[2]);
}

} // namespace

WindowExchange::WindowExchange(const cfd::Mesh& mesh)
    : mesh_(mesh), stack_(mesh.blocks), local_(mesh.blocks.size(), -1) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    local_[std::size_t(mesh.local[b].id)] = int(b);
}

Window WindowExchange::frame_around(const Window& window) const {
  constexpr int slack = 2; // cells that particles may move on before the next consensus
  if (window.size() == 0)
    return {};
  Window frame = window;
  const Index3 cells = mesh_.lattice ? mesh_.lattice->cells() : stack_.extent();
  for (std::size_t d = 0; d < 3; ++d) {
    frame.lo[d] -= slack;
    frame.hi[d] += slack;
    if (!mesh_.lattice || !mesh_.lattice->periodic[d]) {
      frame.lo[d] = std::max(frame.lo[d], 0);
      frame.hi[d] = std::min(frame.hi[d], cells[d]);
    }
  }
  return frame;
}

void WindowExchange::bind(const Window& window) {
  constexpr std::size_t too_wide = 4; // times the cells that a new frame would have
  const Window wanted = frame_around(window);
  const bool fits = window.size() == 0 ||
                    (frame_.contains(window.lo) &&
                     frame_.contains({window.hi[0] - 1, window.hi[1] - 1, window.hi[2] - 1}));
  int outgrown = !bound_ || !fits || frame_.size() > too_wide * wanted.size();
  window_ = window;
  MPI_Allreduce(MPI_IN_PLACE, &outgrown, 1, MPI_INT, MPI_LOR, mesh_.comm);
  if (!outgrown)
    return;
  frame_ = wanted;
  bound_ = true;
  owners_ = find_owners();
  users_ = find_users();
}

/// Parts of the frame over the blocks of a lattice, through every periodic image.
std::vector<WindowExchange::Overlap> WindowExchange::overlaps_of_lattice() const {
  const cfd::Lattice& lattice = *mesh_.lattice;
  std::array<std::vector<Run>, 3> runs;
  for (std::size_t d = 0; d < 3; ++d)
    runs[d] = split(lattice, d, frame_.lo[d], frame_.extent()[d]);
  std::vector<Overlap> overlaps;
  for (const Run& k : runs[2])
    for (const Run& j : runs[1])
      for (const Run& i : runs[0])
        overlaps.push_back({lattice.block({i.slab, j.slab, k.slab}),
                            {i.frame, j.frame, k.frame},
                            {i.cell, j.cell, k.cell},
                            {i.count, j.count, k.count}});
  return overlaps;
}

std::vector<WindowExchange::Overlap> WindowExchange::overlaps_of_stack() const {
  std::vector<Overlap> overlaps;
  for (int block = 0; block < int(mesh_.blocks.size()); ++block) {
    const Index3& n = mesh_.blocks[std::size_t(block)].cells;
    const int first = stack_.first(block);
    const cfd::IndexBox both =
        cfd::intersection({frame_.lo, frame_.hi}, {{0, 0, first}, {n[0], n[1], first + n[2]}});
    if (!both.empty())
      overlaps.push_back(
          {block,
           both.lo,
           {both.lo[0], both.lo[1], both.lo[2] - first},
           {both.hi[0] - both.lo[0], both.hi[1] - both.lo[1], both.hi[2] - both.lo[2]}});
  }
  return overlaps;
}

std::vector<WindowExchange::Partner> WindowExchange::find_owners() const {
  std::map<int, Partner> owners;
  if (frame_.size() > 0)
    for (const Overlap& overlap : mesh_.lattice ? overlaps_of_lattice() : overlaps_of_stack())
      owners[mesh_.blocks[std::size_t(overlap.block)].rank].overlaps.push_back(overlap);
  std::vector<Partner> list;
  for (auto& [rank, owner] : owners) {
    owner.rank = rank;
    for (const Overlap& o : owner.overlaps)
      owner.cells += cells_of(o.count);
    list.push_back(std::move(owner));
  }
  return list;
}

// Non-blocking consensus: Hoefler, Siebert, Lumsdaine, "Scalable communication protocols for
// dynamic sparse data exchange", PPoPP 2010. A synchronous send completes when it is received, so
// once all ranks have entered the barrier no message is on its way.
std::vector<WindowExchange::Partner> WindowExchange::find_users() const {
  int me = 0;
  MPI_Comm_rank(mesh_.comm, &me);
  constexpr int ints = int(sizeof(Overlap) / sizeof(int));
  static_assert(sizeof(Overlap) == 10 * sizeof(int));

  std::map<int, Partner> users;
  std::vector<MPI_Request> sends;
  for (const Partner& owner : owners_) {
    if (owner.rank == me)
      users[me].overlaps = owner.overlaps;
    else
      MPI_Issend(owner.overlaps.data(), ints * int(owner.overlaps.size()), MPI_INT, owner.rank,
                 consensus_tag, mesh_.comm, &sends.emplace_back());
  }
  MPI_Request barrier = MPI_REQUEST_NULL;
  for (bool in_barrier = false, done = false; !done;) {
    int arrived = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, consensus_tag, mesh_.comm, &arrived, &status);
    if (arrived) {
      int count = 0;
      MPI_Get_count(&status, MPI_INT, &count);
      std::vector<Overlap>& overlaps = users[status.MPI_SOURCE].overlaps;
      overlaps.resize(std::size_t(count / ints));
      MPI_Recv(overlaps.data(), count, MPI_INT, status.MPI_SOURCE, consensus_tag, mesh_.comm,
               MPI_STATUS_IGNORE);
    }
    int flag = 0;
    if (in_barrier) {
      MPI_Test(&barrier, &flag, MPI_STATUS_IGNORE);
      done = flag != 0;
    } else {
      MPI_Testall(int(sends.size()), sends.data(), &flag, MPI_STATUSES_IGNORE);
      if (flag) {
        MPI_Ibarrier(mesh_.comm, &barrier);
        in_barrier = true;
      }
    }
  }
  std::vector<Partner> list;
  for (auto& [rank, user] : users) {
    user.rank = rank;
    for (const Overlap& o : user.overlaps)
      user.cells += cells_of(o.count);
    list.push_back(std::move(user));
  }
  return list;
}

template <class Row> void WindowExchange::rows(const Partner& partner, Row&& row) const {
  for (const Overlap& o : partner.overlaps) {
    const int b = local_[std::size_t(o.block)];
    for (int k = 0; k < o.count[2]; ++k)
      for (int j = 0; j < o.count[1]; ++j) {
        const std::ptrdiff_t in_block =
            b < 0 ? 0
                  : mesh_.local[std::size_t(b)].layout.at(o.cell[0], o.cell[1] + j, o.cell[2] + k);
        row(b, in_block, Index3{o.frame[0], o.frame[1] + j, o.frame[2] + k},
            std::size_t(o.count[0]));
      }
  }
}

WindowExchange::Inside WindowExchange::inside(const Index3& first, std::size_t length) const {
  const int lo = std::max(first[0], window_.lo[0]);
  const int hi = std::min(first[0] + int(length), window_.hi[0]);
  if (lo >= hi || !window_.contains({lo, first[1], first[2]}))
    return {};
  return {window_.index({lo, first[1], first[2]}), std::size_t(lo - first[0]),
          std::size_t(hi - lo)};
}

void WindowExchange::deposit(std::span<const double> from, std::span<cfd::BlockFields* const> to) {
  int me = 0;
  MPI_Comm_rank(mesh_.comm, &me);
  const std::size_t each = to.size();
  std::vector<MPI_Request> receives(users_.size(), MPI_REQUEST_NULL), sends;
  for (std::size_t u = 0; u < users_.size(); ++u) {
    Partner& user = users_[u];
    if (user.rank == me)
      continue;
    user.buffer.resize(user.cells * each);
    MPI_Irecv(user.buffer.data(), int(user.buffer.size()), MPI_DOUBLE, user.rank, deposit_tag,
              mesh_.comm, &receives[u]);
  }
  for (Partner& owner : owners_) {
    if (owner.rank == me)
      continue;
    owner.buffer.assign(owner.cells * each, 0);
    double* out = owner.buffer.data();
    rows(owner, [&](int, std::ptrdiff_t, const Index3& first, std::size_t n) {
      const Inside part = inside(first, n);
      std::copy_n(from.data() + part.in_window * each, part.length * each,
                  out + part.in_row * each);
      out += n * each;
    });
    MPI_Isend(owner.buffer.data(), int(owner.buffer.size()), MPI_DOUBLE, owner.rank, deposit_tag,
              mesh_.comm, &sends.emplace_back());
    numbers_sent_ += long(owner.buffer.size());
  }
  const auto add = [&](int b, std::ptrdiff_t in_block, const double* values, std::size_t n) {
    for (std::size_t f = 0; f < each; ++f) {
      double* cells = (*to[f])[std::size_t(b)].data() + in_block;
      for (std::size_t i = 0; i < n; ++i)
        cells[i] += values[i * each + f];
    }
  };
  // In order of rank, whatever arrives first: the sums must not depend on timing.
  for (std::size_t u = 0; u < users_.size(); ++u) {
    const Partner& user = users_[u];
    MPI_Wait(&receives[u], MPI_STATUS_IGNORE);
    const double* in = user.buffer.data();
    rows(user, [&](int b, std::ptrdiff_t in_block, const Index3& first, std::size_t n) {
      if (user.rank != me) {
        add(b, in_block, std::exchange(in, in + n * each), n);
        return;
      }
      const Inside part = inside(first, n);
      add(b, in_block + std::ptrdiff_t(part.in_row), from.data() + part.in_window * each,
          part.length);
    });
  }
  MPI_Waitall(int(sends.size()), sends.data(), MPI_STATUSES_IGNORE);
}

void WindowExchange::sample(std::span<const cfd::Field* const> from, std::size_t each,
                            std::span<double> to) {
  int me = 0;
  MPI_Comm_rank(mesh_.comm, &me);
  const auto read = [&](int b, std::ptrdiff_t in_block, std::size_t n, double* values) {
    for (std::size_t f = 0; f < each; ++f) {
      const double* cells = from[std::size_t(b) * each + f]->data() + in_block;
      for (std::size_t i = 0; i < n; ++i)
        values[i * each + f] = cells[i];
    }
  };
  std::vector<MPI_Request> receives(owners_.size(), MPI_REQUEST_NULL), sends;
  for (std::size_t o = 0; o < owners_.size(); ++o) {
    Partner& owner = owners_[o];
    if (owner.rank == me)
      continue;
    owner.buffer.resize(owner.cells * each);
    MPI_Irecv(owner.buffer.data(), int(owner.buffer.size()), MPI_DOUBLE, owner.rank, sample_tag,
              mesh_.comm, &receives[o]);
  }
  for (Partner& user : users_) {
    if (user.rank == me)
      continue;
    user.buffer.resize(user.cells * each);
    double* out = user.buffer.data();
    rows(user, [&](int b, std::ptrdiff_t in_block, const Index3&, std::size_t n) {
      read(b, in_block, n, out);
      out += n * each;
    });
    MPI_Isend(user.buffer.data(), int(user.buffer.size()), MPI_DOUBLE, user.rank, sample_tag,
              mesh_.comm, &sends.emplace_back());
    numbers_sent_ += long(user.buffer.size());
  }
  for (std::size_t o = 0; o < owners_.size(); ++o) {
    const Partner& owner = owners_[o];
    MPI_Wait(&receives[o], MPI_STATUS_IGNORE);
    const double* in = owner.buffer.data();
    rows(owner, [&](int b, std::ptrdiff_t in_block, const Index3& first, std::size_t n) {
      const Inside part = inside(first, n);
      double* values = to.data() + part.in_window * each;
      if (owner.rank == me)
        read(b, in_block + std::ptrdiff_t(part.in_row), part.length, values);
      else
        std::copy_n(std::exchange(in, in + n * each) + part.in_row * each, part.length * each,
                    values);
    });
  }
  MPI_Waitall(int(sends.size()), sends.data(), MPI_STATUSES_IGNORE);
}

} // namespace granflux::coupling
