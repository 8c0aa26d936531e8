// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "split_levels.hpp"

#include "direct_factor.hpp"
#include "graph_level.hpp"

namespace granflux::cfd {

namespace {

/// Of CellGroups: what is coupled as well as this shares an unknown. Of cells, which are many, more
/// is asked than of the nodes they make: those would be kept apart in such numbers that levels
/// would hardly shrink.
constexpr double well_coupled_cells = 0.15, well_coupled_nodes = 0.05;

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

/// The coarsest level, gathered and solved by every rank (coarsest_solver.hpp).
class CoarsestNodes {
public:
  CoarsestNodes(GraphLevel& level, bool singular) : level_(level), factor_(singular) {
    const MPI_Comm comm = level.place.mesh.comm;
    int ranks = 1, rank = 0;
    MPI_Comm_size(comm, &ranks);
    MPI_Comm_rank(comm, &rank);
    counts_.resize(u(ranks));
    MPI_Allgather(&level.own, 1, MPI_INT, counts_.data(), 1, MPI_INT, comm);
    for (const int count : counts_)
      starts_.push_back(starts_.back() + count);
    first_ = starts_[u(rank)];

    struct Entry {
      int one, other;
      double value;
    };
    std::vector<Entry> mine;
    for (int i = 0; i < level.own; ++i) {
      double diagonal = 0;
      for (int e = level.row[u(i)]; e < level.row[u(i) + 1]; ++e) {
        const double c = double(level.coupling[u(e)]);
        diagonal += c;
        const int other = number(level.neighbour[u(e)]);
        if (other >= 0 && other < first_ + i)
          mine.push_back({first_ + i, other, -c});
      }
      mine.push_back({first_ + i, first_ + i, diagonal});
    }
    int bytes = int(mine.size() * sizeof(Entry));
    std::vector<int> sizes(u(ranks)), offsets{0};
    MPI_Allgather(&bytes, 1, MPI_INT, sizes.data(), 1, MPI_INT, comm);
    for (const int size : sizes)
      offsets.push_back(offsets.back() + size);
    std::vector<Entry> all(u(offsets.back()) / sizeof(Entry));
    MPI_Allgatherv(mine.data(), bytes, MPI_BYTE, all.data(), sizes.data(), offsets.data(), MPI_BYTE,
                   comm);
    DirectFactor::Entries entries;
    for (const Entry& entry : all)
      entries.emplace_back(entry.one, entry.other, entry.value);
    factor_.factorise(starts_.back(), entries, false);
  }

  void solve() {
    const std::vector<double> mine(level_.rhs.begin(), level_.rhs.end());
    Eigen::VectorXd rhs(starts_.back());
    MPI_Allgatherv(mine.data(), level_.own, MPI_DOUBLE, rhs.data(), counts_.data(), starts_.data(),
                   MPI_DOUBLE, level_.place.mesh.comm);
    const Eigen::VectorXd solution = factor_.solve(std::move(rhs));
    for (int i = 0; i < level_.own; ++i)
      level_.x[u(i)] = float(solution[first_ + i]);
  }

private:
  /// Of a node among those of all ranks; -1 outside.
  [[nodiscard]] int number(int node) const {
    if (node < level_.own)
      return first_ + node;
    if (node == level_.outside())
      return -1;
    const RemoteNode& there = level_.halo.ghosts()[u(node - level_.own)];
    return starts_[u(there.rank)] + there.number;
  }

  GraphLevel& level_;
  std::vector<int> counts_, starts_{0};
  int first_ = 0;
  DirectFactor factor_;
};

} // namespace

struct SplitLevels::Impl {
  Impl(const std::vector<std::unique_ptr<Level>>& structured, std::size_t from,
       long largest_coarsest, bool singular)
      : cells(Level::cell_by_cell(*structured[from])) {
    levels.push_back(std::make_unique<GraphLevel>(*structured[from], cells, *structured[from + 1],
                                                  well_coupled_cells));
    for (std::size_t l = from + 2; l < structured.size() && levels.back()->total > largest_coarsest;
         ++l)
      levels.push_back(
          std::make_unique<GraphLevel>(*levels.back(), *structured[l], well_coupled_nodes));
    finer_nodes = cells_of_all_ranks(structured[from]->mesh);
    coarsest = std::make_unique<CoarsestNodes>(*levels.back(), singular);
  }

  /// Cycles of a level in one of the level above.
  [[nodiscard]] int visits(std::size_t l) const {
    if (l + 1 == levels.size())
      return 1;
    const long above = l == 0 ? finer_nodes : levels[l - 1]->total;
    return 4 * levels[l]->total <= above ? 2 : 1;
  }

  void cycle(std::size_t l, Start start) {
    if (l + 1 == levels.size()) {
      coarsest->solve();
      return;
    }
    GraphLevel &fine = *levels[l], &coarse = *levels[l + 1];
    fine.smooth(start);
    coarse.restrict_from(fine);
    for (int visit = 0; visit < visits(l + 1); ++visit)
      cycle(l + 1, visit == 0 ? Start::zero : Start::iterate);
    coarse.correct(fine);
    fine.smooth(Start::corrected);
  }

  Level cells;
  long finer_nodes = 0;
  std::vector<std::unique_ptr<GraphLevel>> levels;
  std::unique_ptr<CoarsestNodes> coarsest;
};

SplitLevels::SplitLevels(const std::vector<std::unique_ptr<Level>>& levels, std::size_t from,
                         long largest_coarsest, bool singular)
    : impl_(std::make_unique<Impl>(levels, from, largest_coarsest, singular)) {}

SplitLevels::~SplitLevels() = default;

Level& SplitLevels::cells() {
  return impl_->cells;
}

void SplitLevels::correct() {
  GraphLevel& first = *impl_->levels.front();
  first.restrict_from(impl_->cells);
  for (int visit = 0; visit < impl_->visits(0); ++visit)
    impl_->cycle(0, visit == 0 ? Start::zero : Start::iterate);
  first.correct(impl_->cells);
}

std::vector<long> SplitLevels::sizes() const {
  std::vector<long> sizes;
  for (const auto& level : impl_->levels)
    sizes.push_back(level->total);
  return sizes;
}

} // namespace granflux::cfd
