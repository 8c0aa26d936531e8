// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "contact_lists.hpp"

#include <algorithm>
#include <utility>

#include "compress.hpp"

namespace granflux::particle_subset {

namespace {

[[nodiscard]] double distance_squared(const Vec3& a, const Vec3& b) {
  const Vec3 d = a - b;
  return dot(d, d);
}

bool apart(const Particles& particles, int i, int j, double margin) {
  const double reach = particles.radius[i] + particles.radius[j] + margin;
  return distance_squared(particles.position[i], particles.position[j]) >= reach * reach;
}

/// Where in a row a partner is; `end` if it is not there. Eight at a time, as most rows are no
/// longer and nobody could foresee where in them it is.
int find_in_row(const std::vector<int>& partners, int begin, int end, int partner) {
  constexpr int lanes = 8;
  const int* const all = partners.data();
  const int last_start = int(partners.size()) - lanes;
  if (last_start < 0)
    return int(std::find(all + begin, all + end, partner) - all);
  for (int first = begin; first < end; first += lanes) {
    const int start = std::min(first, last_start);
    int place[lanes], found = -1;
    for (int l = 0; l < lanes; ++l) {
      const int e = start + l;
      place[l] = (all[e] == partner) & (e >= begin) & (e < end) ? e : -1;
    }
    for (int l = 0; l < lanes; ++l)
      found = std::max(found, place[l]);
    if (found >= 0)
      return found;
  }
  return end;
}

/// Restores what pairs remember that touch now and did so before.
class HistoryLookup {
public:
  HistoryLookup(const Particles& particles, const PartnerHistory& kept, int size)
      : particles_(particles), kept_(kept), size_(size) {}

  /// Nothing is remembered in `rows`.
  void clear(ContactRows& rows) const {
    rows.flags.assign(rows.partner.size(), 0);
    rows.history.assign(rows.partner.size() * std::size_t(size_), 0.0);
  }

  /// Clears the rows of `own` and restores what is remembered by one side, of partners that have
  /// kept their numbers: in the order of memory. Returns whether all has found its place.
  bool restore_by_number(ContactRows& upper, Range own, std::vector<PartedPair>& parted) const {
    upper.flags.resize(upper.partner.size());
    upper.history.resize(upper.partner.size() * std::size_t(size_));
    bool all = true;
    for_each_block(own, [&](Range block) { // while it is in the cache
      const int first = upper.row_begin(block.begin - own.begin);
      const int last = upper.row_begin(block.end - own.begin);
      std::fill(upper.flags.begin() + first, upper.flags.begin() + last, 0);
      std::fill(upper.history.begin() + std::ptrdiff_t(first) * size_,
                upper.history.begin() + std::ptrdiff_t(last) * size_, 0.0);
      for (int i = block.begin; i < block.end; ++i)
        all &= restore_row(upper, own, i, parted);
    });
    return all;
  }

  /// For all pairs that remember nothing; the pair (lower number, higher number) of a particle and
  /// its partner is given by `ordered`.
  template <class Ordered>
  void restore_by_tag(ContactRows& rows, Ordered ordered, std::vector<PartedPair>& parted) const {
    for (int e = 0; e < int(rows.partner.size()); ++e) {
      if (rows.flags[std::size_t(e)])
        continue;
      const auto [i, j] = ordered(rows.particle[std::size_t(e)], rows.partner[std::size_t(e)]);
      if (const double* found = find(i, j))
        restore(rows, e, {i, j, found}, 1, parted);
      else if (const double* other = kept_.one_sided ? find(j, i) : nullptr)
        restore(rows, e, {j, i, other}, -1, parted);
    }
  }

private:
  bool restore_row(ContactRows& upper, Range own, int i, std::vector<PartedPair>& parted) const {
    const int count = size_ > 0 ? kept_.count[i] : 0;
    const int begin = upper.row_begin(i - own.begin), end = upper.row_end(i - own.begin);
    bool all = true;
    for (int k = 0; k < count; ++k) {
      const int tag = kept_.partner[i][k], j = kept_.partner[i][count + k];
      const bool same = j > i && j < particles_.all && particles_.tag[j] == tag;
      const int e = same ? find_in_row(upper.partner, begin, end, j) : end;
      if (e < end) // else it has gone too far, if it is the same
        restore(upper, e, {i, j, kept_.history[i] + std::ptrdiff_t(k) * size_}, 1, parted);
      all &= same;
    }
    return all;
  }

  /// `sign`: of what is remembered, in the eyes of the entry.
  void restore(ContactRows& rows, int e, const PartedPair& pair, double sign,
               std::vector<PartedPair>& parted) const {
    if (apart(particles_, pair.i, pair.j, 0)) {
      parted.push_back(pair);
      return;
    }
    rows.flags[std::size_t(e)] = 1;
    for (int d = 0; d < size_; ++d)
      rows.history[std::size_t(e) * std::size_t(size_) + std::size_t(d)] = sign * pair.history[d];
  }

  [[nodiscard]] const double* find(int i, int j) const {
    const int count = size_ > 0 ? kept_.count[i] : 0;
    if (count == 0)
      return nullptr;
    const int* tags = kept_.partner[i];
    const int* found = std::find(tags, tags + count, particles_.tag[j]);
    return found == tags + count ? nullptr : kept_.history[i] + (found - tags) * size_;
  }

  const Particles& particles_;
  const PartnerHistory& kept_;
  int size_;
};

/// The particle whose partners are looked for.
struct Seeker {
  int number;
  Vec3 place;
  double reach; ///< radius and skin
};

/// Writes those of a run that are near and of higher number to `found` and returns how many there
/// are; up to CellGrid::lanes numbers behind them are overwritten. Without branches, which nobody
/// could foresee. `coincide`: becomes not 0 where one is at the very same place, if that is asked.
template <bool ask_coincide>
int find_above(const CellGrid::Columns& all, const CellGrid::Run& run, const Seeker& seeker,
               int* found, int (&coincide)[CellGrid::lanes]) {
  constexpr int lanes = CellGrid::lanes;
  int count = 0;
  for (int first = run.begin; first < run.end; first += lanes) {
    int near[lanes];
    for (int l = 0; l < lanes; ++l) {
      const int k = first + l;
      const double limit = seeker.reach + all.radius[k];
      const double apart = distance_squared(seeker.place, {all.x[k], all.y[k], all.z[k]});
      near[l] = (apart <= limit * limit) & (all.number[k] > seeker.number) & (k < run.end);
      if constexpr (ask_coincide)
        coincide[l] |= near[l] & (apart == 0);
    }
    count += compress(all.number + first, near, found + count);
  }
  return count;
}

/// The same of numbers below `end`, of which there are few.
int find_below(const CellGrid::Columns& all, const CellGrid::Run& run, const Seeker& seeker,
               int end, int* found) {
  int count = 0;
  for (int k = run.begin; k < run.end; ++k) {
    const double limit = seeker.reach + all.radius[k];
    if (all.number[k] < end &&
        distance_squared(seeker.place, {all.x[k], all.y[k], all.z[k]}) <= limit * limit)
      found[count++] = all.number[k];
  }
  return count;
}

/// Writes `value` at least `count` times, in whole lanes.
void fill_lanes(int* values, int count, int value) {
  for (int first = 0; first < count; first += CellGrid::lanes)
    for (int l = 0; l < CellGrid::lanes; ++l)
      values[first + l] = value;
}

/// Room for `count` more behind the first `used`; what it has held is kept in use.
void make_room(std::vector<int>& values, int used, int count) {
  if (const auto needed = std::size_t(used + count); values.size() < needed)
    values.resize(needed + needed / 4);
}

double largest_radius(const Particles& particles, int threads) {
  double largest = 0;
#pragma omp parallel for num_threads(threads) schedule(static) reduction(max : largest)
  for (int p = 0; p < particles.all; ++p)
    largest = std::max(largest, particles.radius[p]);
  return largest;
}

} // namespace

void ContactLists::build(const Particles& particles, double skin, int threads, int history_size,
                         const Excluded& excluded, const PartnerHistory& kept, int at_rest) {
  subset_ = Subset(particles.owned, threads);
  history_size_ = history_size;
  threads_.resize(std::size_t(threads));
  cells_.sort(particles, 2 * largest_radius(particles, threads) + skin, threads);
  const HistoryLookup lookup(particles, kept, history_size_);
  const bool by_number = kept.one_sided;
  bool found_all = by_number;
  // Each thread fills, and so first touches, its own lists.
#pragma omp parallel for num_threads(threads) schedule(static, 1) reduction(&& : found_all)
  for (int thread = 0; thread < threads; ++thread) {
    ThreadContacts& mine = of(thread);
    mine.own = subset_.of(thread);
    mine.parted.clear();
    find_rows(particles, skin, excluded, mine);
    for (ContactRows* rows : {&mine.lower, &mine.upper})
      put_resting_last(particles, mine.own, at_rest, *rows);
    find_reach(mine);
    find_unseen(particles.owned, mine);
    lookup.clear(mine.lower);
    if (by_number)
      found_all = lookup.restore_by_number(mine.upper, mine.own, mine.parted) && found_all;
    else
      lookup.clear(mine.upper);
  }
#pragma omp parallel for num_threads(threads) schedule(static, 1)
  for (int thread = 0; thread < threads; ++thread) {
    ThreadContacts& mine = of(thread);
    if (!found_all) {
      mine.parted.clear(); // they are found once more
      lookup.restore_by_tag(
          mine.upper, [](int p, int partner) { return std::pair(p, partner); }, mine.parted);
    }
    lookup.restore_by_tag(
        mine.lower, [](int p, int partner) { return std::pair(partner, p); }, mine.parted);
  }
}

void ContactLists::find_reach(ThreadContacts& contacts) {
  const Range own = contacts.own;
  int reach = own.begin;
  for (int row = own.size() - 1; row >= 0 && reach == own.begin; --row)
    if (contacts.lower.row_begin(row) < contacts.lower.row_end(row))
      reach = own.begin + row + 1;
  contacts.reach.assign(1, reach);
  for_each_block(own, [&](Range block) {
    reach = std::max(reach, block.end);
    const int end = contacts.upper.row_begin(block.end - own.begin);
    for (int e = contacts.upper.row_begin(block.begin - own.begin); e < end; ++e)
      if (const int partner = contacts.upper.partner[std::size_t(e)]; own.holds(partner))
        reach = std::max(reach, partner + 1);
    contacts.reach.push_back(reach);
  });
}

/// Threads below have those with lower rows in pairs, threads above those with partners there.
void ContactLists::find_unseen(int owned, ThreadContacts& contacts) {
  const Range own = contacts.own;
  int end = own.end;
  if (own.end < owned) { // else all partners above are ghosts
    const std::vector<int>& partner = contacts.upper.partner;
    const auto first = std::find_if(partner.begin(), partner.end(),
                                    [&](int p) { return p >= own.end && p < owned; });
    if (first != partner.end())
      end = contacts.upper.particle[std::size_t(first - partner.begin())];
  }
  const int begin = contacts.reach_of_lower();
  contacts.unseen = {begin, std::max(begin, end)};
}

void ContactLists::find_coincident(const Particles& particles, Range own, int row,
                                   ThreadContacts& contacts) {
  const int i = own.begin + row;
  const auto frozen = [&](int p) {
    return particles.frozen_group && (particles.groups[p] & particles.frozen_group);
  };
  for (const ContactRows* rows : {&contacts.lower, &contacts.upper})
    for (int e = rows->row_begin(row); e < rows->row_end(row); ++e) {
      const int p = rows->partner[std::size_t(e)];
      if (distance_squared(particles.position[i], particles.position[p]) == 0 &&
          !(frozen(i) && frozen(p)))
        contacts.coincident.emplace_back(i, p);
    }
}

void ContactLists::put_resting_last(const Particles& particles, Range own, int at_rest,
                                    ContactRows& rows) {
  rows.work_end.clear();
  if (!at_rest)
    return;
  const auto rests = [&](int p) { return (particles.groups[p] & at_rest) != 0; };
  for (int row = 0; row < own.size(); ++row) {
    const auto begin = rows.partner.begin() + rows.row_begin(row),
               end = rows.partner.begin() + rows.row_end(row);
    const auto first_resting =
        rests(own.begin + row) ? std::stable_partition(begin, end, [&](int p) { return !rests(p); })
                               : end;
    rows.work_end.push_back(int(first_resting - rows.partner.begin()));
  }
}

/// The partners of each particle that are above it or below its thread's range, the former in the
/// order of the cells.
void ContactLists::find_rows(const Particles& particles, double skin, const Excluded& excluded,
                             ThreadContacts& contacts) const {
  const Range own = contacts.own;
  ContactRows& lower = contacts.lower;
  ContactRows& upper = contacts.upper;
  contacts.coincident.clear();
  for (ContactRows* rows : {&lower, &upper}) {
    rows->begin.resize(std::size_t(own.size()) + 1);
    rows->begin[0] = 0;
  }
  const CellGrid::Columns all = cells_.columns();
  const int room = cells_.most_around() + CellGrid::lanes;
  int lower_end = 0, upper_end = 0;
  for (int i = own.begin; i < own.end; ++i) {
    for (std::vector<int>* of : {&lower.partner, &lower.particle})
      make_room(*of, lower_end, room);
    for (std::vector<int>* of : {&upper.partner, &upper.particle})
      make_room(*of, upper_end, room);
    int* const lower_row = lower.partner.data() + lower_end;
    int* const upper_row = upper.partner.data() + upper_end;
    int below = 0, above = 0;
    int coincide[CellGrid::lanes] = {};
    const Seeker seeker{i, particles.position[i], particles.radius[i] + skin};
    cells_.for_each_run_around(seeker.place, [&](const CellGrid::Run& run, auto own_cell) {
      if (run.most > i)
        above += find_above<own_cell.value>(all, run, seeker, upper_row + above, coincide);
      if (run.least < own.begin)
        below += find_below(all, run, seeker, own.begin, lower_row + below);
    });
    if (excluded) {
      const auto left = [&](int* row, int count) {
        return int(std::remove_if(row, row + count,
                                  [&](int p) { return excluded(std::min(i, p), std::max(i, p)); }) -
                   row);
      };
      below = left(lower_row, below);
      above = left(upper_row, above);
    }
    if (below > 0)
      std::sort(lower_row, lower_row + below);
    const auto row = std::size_t(i - own.begin);
    fill_lanes(lower.particle.data() + lower_end, below, i);
    fill_lanes(upper.particle.data() + upper_end, above, i);
    lower.begin[row + 1] = lower_end += below;
    upper.begin[row + 1] = upper_end += above;
    if (below > 0 || std::ranges::any_of(coincide, [](int c) { return c != 0; }))
      find_coincident(particles, own, int(row), contacts);
  }
  for (std::vector<int>* of : {&lower.partner, &lower.particle})
    of->resize(std::size_t(lower_end));
  for (std::vector<int>* of : {&upper.partner, &upper.particle})
    of->resize(std::size_t(upper_end));
}

void ContactLists::part_far(const Particles& particles, double margin) {
  const auto size = std::size_t(history_size_);
#pragma omp parallel for num_threads(subset_.threads()) schedule(static, 1)
  for (int thread = 0; thread < subset_.threads(); ++thread) {
    ThreadContacts& contacts = of(thread);
    contacts.parted.clear();
    const auto along = [&](ContactRows& rows) {
      constexpr std::size_t ahead = 16; // partners lie apart in memory
      const std::size_t pairs = rows.partner.size();
      for (std::size_t e = 0; e < pairs; ++e) {
        __builtin_prefetch(particles.position + rows.partner[std::min(e + ahead, pairs - 1)]);
        const int p = rows.particle[e], other = rows.partner[e];
        // In one: whether a pair has touched is as likely as not.
        if (!(int(rows.flags[e] != 0) & int(apart(particles, p, other, margin))))
          continue;
        rows.flags[e] = 0;
        contacts.parted.push_back(
            {std::min(p, other), std::max(p, other), rows.history.data() + e * size});
      }
    };
    along(contacts.lower);
    along(contacts.upper);
  }
}

int ContactLists::store(const Particles& particles, PartnerHistory kept) {
  kept_.resize(threads_.size());
  int most = 0;
#pragma omp parallel for num_threads(subset_.threads()) schedule(static, 1) reduction(max : most)
  for (int thread = 0; thread < subset_.threads(); ++thread) {
    const ThreadContacts& contacts = of(thread);
    Kept& mine = kept_[std::size_t(thread)];
    if (kept.one_sided)
      store_one_side(particles, contacts, kept, mine);
    else
      store_both_sides(particles, contacts, kept, mine);
    for (int p = contacts.own.begin; p < contacts.own.end; ++p)
      most = std::max(most, kept.count[p]);
  }
  return most;
}

/// Entry after entry: each is written to the next place, which is kept if the pair has touched.
void ContactLists::store_one_side(const Particles& particles, const ThreadContacts& contacts,
                                  const PartnerHistory& kept, Kept& mine) const {
  const auto size = std::size_t(history_size_);
  const ContactRows& rows = contacts.upper;
  std::size_t total = 0;
  for (const int flags : rows.flags)
    total += flags != 0;
  mine.partner.resize(2 * total);
  mine.history.resize((total + 1) * size);
  std::size_t stored = 0;
  for (int p = contacts.own.begin; p < contacts.own.end; ++p) {
    const int row = p - contacts.own.begin;
    const std::size_t first = stored;
    for (auto e = std::size_t(rows.row_begin(row)); e < std::size_t(rows.row_end(row)); ++e) {
      for (std::size_t d = 0; d < size; ++d)
        mine.history[stored * size + d] = rows.history[e * size + d];
      stored += rows.flags[e] != 0;
    }
    const std::size_t count = stored - first;
    int* const tags = mine.partner.data() + 2 * first;
    std::size_t k = 0;
    for (auto e = std::size_t(rows.row_begin(row)); e < std::size_t(rows.row_end(row)); ++e)
      if (rows.flags[e]) {
        tags[k] = particles.tag[rows.partner[e]];
        tags[count + k++] = rows.partner[e];
      }
    kept.count[p] = int(count);
    kept.partner[p] = tags;
    kept.history[p] = mine.history.data() + first * size;
  }
}

void ContactLists::store_both_sides(const Particles& particles, const ThreadContacts& contacts,
                                    const PartnerHistory& kept, Kept& mine) const {
  const auto size = std::size_t(history_size_);
  const Range own = contacts.own;

  // Calls visit(particle, its partner, entry, sign) for every side of a contact that is ours.
  const auto each = [&](const ContactRows& rows, bool partners_come_first, auto visit) {
    for (int row = 0; row < own.size(); ++row)
      for (int e = rows.row_begin(row); e < rows.row_end(row); ++e)
        if (rows.flags[std::size_t(e)]) {
          const int p = own.begin + row, other = rows.partner[std::size_t(e)];
          visit(p, other, e, partners_come_first ? -1.0 : 1.0);
          if (own.holds(other))
            visit(other, p, e, -1.0);
        }
  };
  const auto each_side = [&](auto visit) {
    each(contacts.lower, true,
         [&](int p, int other, int e, double sign) { visit(contacts.lower, p, other, e, sign); });
    each(contacts.upper, false,
         [&](int p, int other, int e, double sign) { visit(contacts.upper, p, other, e, sign); });
  };

  std::fill(kept.count + own.begin, kept.count + own.end, 0);
  std::size_t total = 0;
  each_side([&](const ContactRows&, int p, int, int, double) { ++kept.count[p], ++total; });
  mine.partner.resize(total);
  mine.history.resize(total * size);
  std::size_t offset = 0;
  for (int p = own.begin; p < own.end; ++p) {
    kept.partner[p] = mine.partner.data() + offset;
    kept.history[p] = mine.history.data() + offset * size;
    offset += std::size_t(kept.count[p]);
    kept.count[p] = 0;
  }
  each_side([&](const ContactRows& rows, int p, int other, int e, double sign) {
    const auto k = std::size_t(kept.count[p]++);
    kept.partner[p][k] = particles.tag[other];
    for (std::size_t d = 0; d < size; ++d)
      kept.history[p][k * size + d] = sign * rows.history[std::size_t(e) * size + d];
  });
}

void ContactLists::mirror_history() {
  const auto size = std::size_t(history_size_);
#pragma omp parallel for num_threads(subset_.threads()) schedule(static, 1)
  for (int thread = 0; thread < subset_.threads(); ++thread) {
    ThreadContacts& mine = of(thread);
    ContactRows& lower = mine.lower;
    for (int row = 0; row < mine.own.size(); ++row)
      for (int e = lower.row_begin(row); e < lower.row_end(row); ++e) {
        const int i = lower.partner[std::size_t(e)];
        int owner = 0;
        while (!threads_[std::size_t(owner)].own.holds(i))
          ++owner;
        const ThreadContacts& theirs = threads_[std::size_t(owner)];
        int same = theirs.upper.row_begin(i - theirs.own.begin);
        while (theirs.upper.partner[std::size_t(same)] != mine.own.begin + row)
          ++same;
        lower.flags[std::size_t(e)] = theirs.upper.flags[std::size_t(same)];
        std::copy_n(&theirs.upper.history[std::size_t(same) * size], size,
                    &lower.history[std::size_t(e) * size]);
      }
  }
}

double ContactLists::memory() const {
  std::size_t bytes = 0;
  for (const ThreadContacts& t : threads_)
    for (const ContactRows* rows : {&t.lower, &t.upper})
      bytes += (rows->begin.capacity() + rows->work_end.capacity() + rows->particle.capacity() +
                rows->partner.capacity() + rows->flags.capacity()) *
                   sizeof(int) +
               rows->history.capacity() * sizeof(double);
  for (const Kept& kept : kept_)
    bytes += kept.partner.capacity() * sizeof(int) + kept.history.capacity() * sizeof(double);
  return double(bytes);
}

} // namespace granflux::particle_subset
