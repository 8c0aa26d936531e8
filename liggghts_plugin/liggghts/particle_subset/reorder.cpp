// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "reorder.hpp"

#include <algorithm>
#include <cstddef>
#include <typeinfo>

#include <liggghts/atom.h>

#include <liggghts/atom_vec.h>
#include <liggghts/fix_property_atom.h>
#include <liggghts/modify.h>

#include "team.hpp"

namespace granflux::particle_subset {

namespace {

/// The numbers of each particle that a fix keeps in an array, row after row.
struct Rows {
  double* first;
  std::size_t width;
};

/// Of a fix that does nothing but hold them: not of one derived from it.
bool holds_rows_alone(const LAMMPS_NS::Fix& fix) {
  return typeid(fix) == typeid(LAMMPS_NS::FixPropertyAtom) && (fix.array_atom || fix.vector_atom);
}

Rows rows_of(LAMMPS_NS::FixPropertyAtom& fix) {
  if (fix.array_atom)
    return {fix.array_atom[0], std::size_t(fix.get_nvalues())};
  return {fix.vector_atom, 1};
}

void reorder(const Rows& rows, const std::vector<int>& from, std::vector<double>& moved) {
  const auto at = [&rows](double* first, int row) { return first + std::size_t(row) * rows.width; };
  moved.resize(std::max(moved.size(), from.size() * rows.width));
  for_each_subset(int(from.size()), [&](Range range) {
    for (int k = range.begin; k < range.end; ++k)
      std::copy_n(at(rows.first, from[std::size_t(k)]), rows.width, at(moved.data(), k));
  });
  for_each_subset(int(from.size()), [&](Range range) {
    std::copy(at(moved.data(), range.begin), at(moved.data(), range.end),
              at(rows.first, range.begin));
  });
}

/// Rows of fixes in one go, by all threads; while this lives the host does not ask their fixes to
/// copy them particle by particle, which took longer than to move all else.
class RowsMoved {
public:
  RowsMoved(LAMMPS_NS::Atom& atom, LAMMPS_NS::Modify& modify, const std::vector<int>& from)
      : atom_(atom), asked_(atom.extra_grow, atom.extra_grow + atom.nextra_grow) {
    std::vector<double> moved;
    atom.nextra_grow = 0;
    for (const int number : asked_) {
      LAMMPS_NS::Fix& fix = *modify.fix[number];
      if (holds_rows_alone(fix))
        reorder(rows_of(static_cast<LAMMPS_NS::FixPropertyAtom&>(fix)), from, moved);
      else
        atom.extra_grow[atom.nextra_grow++] = number;
    }
  }
  ~RowsMoved() {
    std::ranges::copy(asked_, atom_.extra_grow);
    atom_.nextra_grow = int(asked_.size());
  }
  RowsMoved(const RowsMoved&) = delete;
  RowsMoved& operator=(const RowsMoved&) = delete;

private:
  LAMMPS_NS::Atom& atom_;
  const std::vector<int> asked_;
};

} // namespace

void reorder(LAMMPS_NS::Atom& atom, LAMMPS_NS::Modify& modify, std::vector<int>& from) {
  const int spare = atom.nlocal;
  if (spare == atom.nmax)
    atom.avec->grow(0);
  const RowsMoved rows(atom, modify, from);
  for (int first = 0; first < spare; ++first) {
    if (from[first] == first)
      continue;
    // One cycle: its first particle waits in the spare place until the cycle has come round.
    atom.avec->copy(first, spare, 0);
    int k = first;
    while (from[k] != first) {
      const int source = from[k];
      atom.avec->copy(source, k, 0);
      from[k] = k;
      k = source;
    }
    atom.avec->copy(spare, k, 0);
    from[k] = k;
  }
}

} // namespace granflux::particle_subset
