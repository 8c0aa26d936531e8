// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/share_lists.hpp>

#include <algorithm>

namespace granflux::coupling {

ShareLists::Pass& ShareLists::Pass::operator+=(const Pass& o) & {
  placing += o.placing;
  most_entries = std::max(most_entries, o.most_entries);
  fits = fits && o.fits;
  return *this;
}

/// What was found is kept if it was by the same kernel and locator. Whose it was does not count:
/// a particle at the same place has the same shares.
void ShareLists::keep_places(std::size_t particles, std::string_view kernel, long locator,
                             int parts) {
  constexpr std::size_t first_rows = 2;
  for (std::size_t n = 0; n <= std::size_t(parts); ++n)
    share_[n] = double(n) / parts;
  if (kernel_ != kernel || locator_ != locator) {
    forget();
    kernel_ = kernel;
    locator_ = locator;
  }
  if (particles == particles_)
    return;
  sorted_ = false;
  if (particles > stride_) {
    forget();
    stride_ = particles + particles / 8; // ranks exchange a few now and then
    rows_ = std::max(rows_, first_rows);
    cell_.resize(rows_ * stride_);
    parts_.resize(rows_ * stride_);
  }
  particles_ = particles;
  entries_.resize(particles);
  found_.resize(particles);
}

/// All shares are found anew.
void ShareLists::forget() {
  window_ = {};
  sorted_ = false;
  std::fill(found_.begin(), found_.end(), Found{});
  std::fill(entries_.begin(), entries_.end(), std::uint8_t{0});
}

/// Particles may have drawn together.
void ShareLists::narrow_window() {
  constexpr int keep_window = 64; // builds
  if (!sorted_ || --builds_left_ > 0)
    return;
  builds_left_ = keep_window;
  Placing tight;
  for (std::size_t c = 0; c < window_.size(); ++c)
    if (by_cell_.begin(c) < by_cell_.end(c)) {
      const cfd::Index3 cell = window_.cell(c);
      tight.include(cell, {cell[0] + 1, cell[1] + 1, cell[2] + 1});
    }
  if (window_.size() > 0 && tight.window.size() < window_.size()) {
    forget();
    window_ = tight.window;
  }
}

/// For entries that did not fit.
void ShareLists::make_room(const Pass& pass) {
  if (pass.most_entries > rows_) {
    rows_ = pass.most_entries;
    cell_.resize(rows_ * stride_);
    parts_.resize(rows_ * stride_);
  }
  Placing wider = pass.placing;
  if (window_.size() > 0)
    wider.include(window_.lo, window_.hi);
  if (wider.window.size() == window_.size())
    return;
  forget();
  window_ = wider.window;
}

/// False where the entries do not fit.
bool ShareLists::set(std::size_t p, const Entries& found, Moves& moves) {
  if (found.count > rows_ ||
      !std::all_of(found.cell.begin(), found.cell.begin() + std::ptrdiff_t(found.count),
                   [&](const cfd::Index3& c) { return window_.contains(c); })) {
    found_[p] = {};
    return false;
  }
  const std::size_t before = entries_[p];
  for (std::size_t k = 0; k < std::max(before, found.count); ++k) {
    const std::uint32_t from = k < before ? cell_[at(p, k)] : CellOrder::nowhere;
    const std::uint32_t to =
        k < found.count ? std::uint32_t(window_.index(found.cell[k])) : CellOrder::nowhere;
    if (from != to)
      moves.push_back({item(p, k), from, to});
    cell_[at(p, k)] = to;
    parts_[at(p, k)] = k < found.count ? found.parts[k] : std::uint8_t{0};
  }
  if (found.count == 1) {
    cell_[at(p, 1)] = cell_[at(p, 0)];
    parts_[at(p, 1)] = 0;
  }
  entries_[p] = std::uint8_t(found.count);
  return true;
}

void ShareLists::sort_entries() {
  if (sorted_ && by_cell_.mend(moves_))
    return;
  by_cell_.sort(window_.size(), [&](int t, int n, auto&& visit) {
    const std::size_t end = run_begin(particles_, t + 1, n);
    for (std::size_t p = run_begin(particles_, t, n); p < end; ++p)
      for (std::size_t k = 0; k < entries_[p]; ++k)
        visit(cell_[at(p, k)], item(p, k));
  });
  sorted_ = true;
}

} // namespace granflux::coupling
