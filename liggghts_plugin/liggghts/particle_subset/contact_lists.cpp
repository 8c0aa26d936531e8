// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "contact_lists.hpp"

#include <algorithm>
#include <utility>

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

/// Restores what a pair remembers, if it touches now and did so before.
class HistoryLookup {
public:
  HistoryLookup(const Particles& particles, const PartnerHistory& kept, int size)
      : particles_(particles), kept_(kept), size_(size) {}

  /// Fills flags and history of all rows; the pair (lower number, higher number) of a row and a
  /// partner is given by `ordered`. What touches no longer goes into `parted`.
  template <class Ordered>
  void restore(ContactRows& rows, int rows_count, Ordered ordered,
               std::vector<PartedPair>& parted) const {
    rows.flags.assign(rows.partner.size(), 0);
    rows.history.assign(rows.partner.size() * std::size_t(size_), 0.0);
    if (size_ == 0)
      return;
    for (int row = 0; row < rows_count; ++row)
      for (int e = rows.row_begin(row); e < rows.row_end(row); ++e) {
        const auto [i, j] = ordered(row, rows.partner[std::size_t(e)]);
        const double* found = find(i, j);
        if (!found)
          continue;
        if (apart(particles_, i, j, 0)) {
          parted.push_back({i, j, found});
        } else {
          rows.flags[std::size_t(e)] = 1;
          std::copy_n(found, size_, &rows.history[std::size_t(e) * std::size_t(size_)]);
        }
      }
  }

private:
  [[nodiscard]] const double* find(int i, int j) const {
    const int count = kept_.count[i];
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
  // Each thread fills, and so first touches, its own lists.
#pragma omp parallel for num_threads(threads) schedule(static, 1)
  for (int thread = 0; thread < threads; ++thread) {
    ThreadContacts& mine = of(thread);
    mine.own = subset_.of(thread);
    build_rows(particles, skin, excluded, kept, at_rest, mine);
    find_reach(mine);
    find_unseen(particles.owned, mine);
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

/// The particles near to i that are above it or below its thread's range, in the order of the
/// cells.
ContactLists::Found ContactLists::find_partners(const Particles& particles, double skin, Range own,
                                                int i, std::vector<int>& found) const {
  const Vec3 x = particles.position[i];
  const double reach = particles.radius[i] + skin;
  const auto runs = cells_.around(x);
  std::size_t most = 0;
  for (const CellGrid::Run run : runs)
    most += std::size_t(run.end - run.begin);
  if (found.size() < most)
    found.resize(2 * most);

  const CellGrid::Entry* const entries = cells_.entries();
  const int* const numbers = cells_.numbers();
  int* const list = found.data();
  int count = 0, here = 0;
  for (const CellGrid::Run run : runs) {
    if (run.most < i && run.least >= own.begin)
      continue; // they have found this one
    for (int k = run.begin; k < run.end; ++k) {
      const CellGrid::Entry other = entries[k];
      const int p = numbers[k];
      const double limit = reach + other.radius;
      const double apart = distance_squared(x, {other.x, other.y, other.z});
      const bool near = apart <= limit * limit;
      list[count] = p; // overwritten by the next unless it is one
      count += near & ((p > i) | (p < own.begin));
      here += apart == 0;
    }
  }
  return {count, here};
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

void ContactLists::build_rows(const Particles& particles, double skin, const Excluded& excluded,
                              const PartnerHistory& kept, int at_rest,
                              ThreadContacts& contacts) const {
  const Range own = contacts.own;
  ContactRows& lower = contacts.lower;
  ContactRows& upper = contacts.upper;
  for (ContactRows* rows : {&lower, &upper}) {
    rows->particle.clear();
    rows->partner.clear();
    rows->begin.assign(1, 0);
    rows->begin.reserve(std::size_t(own.size()) + 1);
  }
  contacts.coincident.clear();
  contacts.parted.clear();
  std::vector<int> found;
  for (int i = own.begin; i < own.end; ++i) {
    const auto [partners, here] = find_partners(particles, skin, own, i, found);
    const auto count = std::ptrdiff_t(partners);
    const auto lower_begin = std::ptrdiff_t(lower.partner.size());
    for (auto p = found.begin(); p != found.begin() + count; ++p)
      if (!excluded || !excluded(std::min(i, *p), std::max(i, *p)))
        (*p > i ? upper : lower).partner.push_back(*p);
    std::sort(lower.partner.begin() + lower_begin, lower.partner.end());
    for (ContactRows* rows : {&lower, &upper}) {
      rows->begin.push_back(int(rows->partner.size()));
      rows->particle.resize(rows->partner.size(), i);
    }
    if (here > 1)
      find_coincident(particles, own, i - own.begin, contacts);
  }
  for (ContactRows* rows : {&lower, &upper})
    put_resting_last(particles, own, at_rest, *rows);
  const HistoryLookup lookup(particles, kept, history_size_);
  lookup.restore(
      lower, own.size(), [&](int row, int p) { return std::pair(p, own.begin + row); },
      contacts.parted);
  lookup.restore(
      upper, own.size(), [&](int row, int p) { return std::pair(own.begin + row, p); },
      contacts.parted);
}

void ContactLists::part_far(const Particles& particles, double margin) {
  const auto size = std::size_t(history_size_);
#pragma omp parallel for num_threads(subset_.threads()) schedule(static, 1)
  for (int thread = 0; thread < subset_.threads(); ++thread) {
    ThreadContacts& contacts = of(thread);
    contacts.parted.clear();
    const auto along = [&](ContactRows& rows) {
      for (int row = 0; row < contacts.own.size(); ++row)
        for (int e = rows.row_begin(row); e < rows.row_end(row); ++e) {
          const int p = contacts.own.begin + row, other = rows.partner[std::size_t(e)];
          if (!rows.flags[std::size_t(e)] || !apart(particles, p, other, margin))
            continue;
          rows.flags[std::size_t(e)] = 0;
          contacts.parted.push_back({std::min(p, other), std::max(p, other),
                                     rows.history.data() + std::size_t(e) * size});
        }
    };
    along(contacts.lower);
    along(contacts.upper);
  }
}

void ContactLists::store(const Particles& particles, PartnerHistory kept) {
  kept_.resize(threads_.size());
  const auto size = std::size_t(history_size_);
#pragma omp parallel for num_threads(subset_.threads()) schedule(static, 1)
  for (int thread = 0; thread < subset_.threads(); ++thread) {
    const ThreadContacts& contacts = of(thread);
    const Range own = contacts.own;
    Kept& mine = kept_[std::size_t(thread)];

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
