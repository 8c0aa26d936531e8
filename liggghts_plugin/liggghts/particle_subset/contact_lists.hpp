// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "cell_grid.hpp"
#include "particles.hpp"
#include "subset.hpp"

namespace granflux::particle_subset {

/// Partners of the particles of one range, row by row, with what their contacts remember.
struct ContactRows {
  std::vector<int> begin; ///< of each row in the arrays below, and the end
  /// End of each row's pairs that are evaluated; pairs of two particles at rest come last. Empty:
  /// all are evaluated.
  std::vector<int> work_end;
  std::vector<int> particle;   ///< whose row it is, pair by pair
  std::vector<int> partner;    ///< numbers of particles
  std::vector<int> flags;      ///< not 0 once a pair has touched
  std::vector<double> history; ///< history_size doubles a pair, seen from its lower number

  [[nodiscard]] int row_begin(int row) const { return begin[std::size_t(row)]; }
  [[nodiscard]] int row_end(int row) const { return begin[std::size_t(row) + 1]; }
  /// Calls visit(first, end) for the runs of pairs that are evaluated of the rows `first` to `end`.
  template <class Visit> void for_each_run(int first, int end, Visit&& visit) const {
    if (work_end.empty())
      visit(row_begin(first), row_begin(end));
    else
      for (int row = first; row < end; ++row)
        visit(row_begin(row), work_end[std::size_t(row)]);
  }
};

/// A pair that touched and no longer does, and what its contact remembered, seen from i.
struct PartedPair {
  int i, j;
  const double* history;
};

/// What one thread works on. A pair of which both particles are its own is held once; a pair that
/// crosses subsets is held by both owners, each of which adds to its own particle only.
struct ThreadContacts {
  Range own;
  ContactRows lower; ///< row j: partners of own j below own.begin, ascending: other threads'
  ContactRows upper; ///< row i: partners of own i above i: its own, other threads', ghosts
  /// End of the own particles that forces are added to by the lower rows, and by them and the upper
  /// rows of the first 1, 2 ... blocks.
  std::vector<int> reach;
  Range unseen; ///< own particles, of which no pair of other threads is
  /// Pairs at the very same place, not both of the frozen group: their contact has no direction.
  std::vector<std::pair<int, int>> coincident;
  /// Of the last part_far() or build(), each pair in one of them; until the next store().
  std::vector<PartedPair> parted;

  [[nodiscard]] int reach_of_lower() const { return reach.front(); }
  [[nodiscard]] int reach_of_block(Range block) const {
    return reach[std::size_t((block.end - own.begin + Subset::block - 1) / Subset::block)];
  }
};

/// What each particle remembers of its contacts while pairs are not in lists: as the host keeps it
/// across exchange, sorting and restarts.
struct PartnerHistory {
  int* count = nullptr;       ///< partners of each particle
  int** partner = nullptr;    ///< their tags
  double** history = nullptr; ///< seen from the particle; the partner sees the opposite
  /// Each contact is remembered by one of its particles, not by both: enough where no particle has
  /// a ghost, neither here nor on another rank. Behind the tags of a particle's partners are then
  /// the numbers that they had.
  bool one_sided = false;
};

/// The pairs that can touch before the next build, per thread.
///
/// Pairs are evaluated from the particle of lower number, whoever evaluates them, and a particle
/// takes contributions in an order that does not depend on the threads: from lower partners,
/// ascending, then along its own row. Hence forces are the same bits for every number of threads.
class ContactLists {
public:
  using Excluded = std::function<bool(int, int)>; ///< empty: no pair is

  /// Pairs up to radius_i + radius_j + skin apart. Pairs that touch find their history in `kept`
  /// under the tag of their partner. `at_rest`: group bit of particles that nothing moves; pairs of
  /// two of them are held, but not evaluated. 0: none.
  void build(const Particles& particles, double skin, int threads, int history_size,
             const Excluded& excluded, const PartnerHistory& kept, int at_rest = 0);

  /// Before store(): lets go of pairs that touched and are apart by `margin` or more, which the
  /// next lists may not hold. Positions of ghosts may be a step old: the sides of a pair on two
  /// ranks then part one here and one in build().
  void part_far(const Particles& particles, double margin);

  /// The way back: what touched since the build, for each owned particle. The arrays that the
  /// pointers in `kept` lead to are held here until the next call. Returns the most partners that
  /// one particle remembers.
  int store(const Particles& particles, PartnerHistory kept);

  /// After a step in which only the upper rows were advanced: the lower rows follow.
  void mirror_history();

  [[nodiscard]] const Subset& subset() const { return subset_; }
  [[nodiscard]] int history_size() const { return history_size_; }
  [[nodiscard]] ThreadContacts& of(int thread) { return threads_[std::size_t(thread)]; }
  [[nodiscard]] const ThreadContacts& of(int thread) const { return threads_[std::size_t(thread)]; }
  /// Bytes of all lists.
  [[nodiscard]] double memory() const;

private:
  struct Kept {
    std::vector<int> partner;
    std::vector<double> history;
  };
  void store_one_side(const Particles& particles, const ThreadContacts& contacts,
                      const PartnerHistory& kept, Kept& mine) const;
  void store_both_sides(const Particles& particles, const ThreadContacts& contacts,
                        const PartnerHistory& kept, Kept& mine) const;
  void find_rows(const Particles& particles, double skin, const Excluded& excluded,
                 ThreadContacts& contacts) const;
  static void find_coincident(const Particles& particles, Range own, int row,
                              ThreadContacts& contacts);
  static void find_reach(ThreadContacts& contacts);
  static void find_unseen(int owned, ThreadContacts& contacts);
  static void put_resting_last(const Particles& particles, Range own, int at_rest,
                               ContactRows& rows);

  Subset subset_{0, 1};
  int history_size_ = 0;
  CellGrid cells_;
  std::vector<ThreadContacts> threads_;
  std::vector<Kept> kept_; // per thread
};

} // namespace granflux::particle_subset
