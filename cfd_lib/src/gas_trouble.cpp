// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

#include <cmath>

#include <fmt/core.h>

#include <granflux/cfd/courant_limit.hpp>

#include "block_geometry.hpp"
#include "throw_alike.hpp"

namespace granflux::cfd {

namespace {

/// First cell of a block, i fastest, for which is_bad(c); nothing where there is none.
template <class IsBad> std::optional<Index3> first_cell(const Layout& layout, IsBad&& is_bad) {
  for (int k = 0; k < layout.cells[2]; ++k)
    for (int j = 0; j < layout.cells[1]; ++j)
      for (int i = 0; i < layout.cells[0]; ++i)
        if (is_bad(layout.at(i, j, k)))
          return Index3{i, j, k};
  return {};
}

} // namespace

/// "gas: step 7, time 0.1 s: ... in cell (1, 2, 3) of block 0, centre (0.1, 0.2, 0.3) m" is made of
/// this.
std::string GasSolver::Impl::place(std::size_t b, const Index3& cell) const {
  const Block& block = mesh.local[b];
  const Vec3 x = get(block.centre, block.layout.at(cell[0], cell[1], cell[2]));
  return fmt::format("cell ({}, {}, {}) of block {}, centre ({:.6g}, {:.6g}, {:.6g}) m", cell[0],
                     cell[1], cell[2], block.id, x.x, x.y, x.z);
}

/// Names a cell whose velocity, drag or temperature is not a number. What comes from outside is
/// looked at first: the pressure carries the rest everywhere within one step.
void GasSolver::Impl::check_finite() const {
  const auto complain = [&](const char* what, auto&& value) {
    std::string complaint;
    for (std::size_t b = 0; b < mesh.local.size() && complaint.empty(); ++b)
      if (const auto cell = first_cell(
              mesh.local[b].layout, [&](std::ptrdiff_t c) { return !std::isfinite(value(b, c)); }))
        complaint = fmt::format("gas: step {}, time {:.6g} s: {} is not a number in {}", steps + 1,
                                time, what, place(b, *cell));
    throw_alike<NumericalError>(mesh.comm, complaint);
  };
  complain("void fraction or drag",
           [&](std::size_t b, std::ptrdiff_t c) { return a[b][c] + share[b][c] + eps[b][c]; });
  complain("velocity", [&](std::size_t b, std::ptrdiff_t c) {
    double probe = 0;
    for (std::size_t m = 0; m < 3; ++m)
      probe += u[b][m][c] + r[b][m][c];
    return probe;
  });
  if (energy)
    complain("temperature",
             [&](std::size_t b, std::ptrdiff_t c) { return energy->temperature()[b][c]; });
}

/// Stops at a Courant number that no later step mends.
void GasSolver::Impl::check_courant(double dt, double courant) const {
  const double most = hopeless_courant(numerics);
  if (courant <= most)
    return;
  std::string complaint;
  for (std::size_t b = 0; b < mesh.local.size() && complaint.empty(); ++b) {
    const Block& block = mesh.local[b];
    const auto [si, sj, sk] = block.layout.stride;
    const auto& [i, j, k] = flux[b];
    const auto of_cell = [&, si = si, sj = sj, sk = sk, &i = i, &j = j, &k = k](std::ptrdiff_t c) {
      const double gross = std::abs(i[c + si]) + std::abs(i[c]) + std::abs(j[c + sj]) +
                           std::abs(j[c]) + std::abs(k[c + sk]) + std::abs(k[c]);
      return 0.5 * dt * gross / block.volume[c] / eps_middle[b][c];
    };
    if (const auto cell = first_cell(
            block.layout, [&](std::ptrdiff_t c) { return of_cell(c) >= (1 - 1e-9) * courant; })) {
      const Vec3 v = get(u[b], block.layout.at((*cell)[0], (*cell)[1], (*cell)[2]));
      complaint = fmt::format("gas: step {}, time {:.6g} s: Courant number {:.4g} in {}, velocity "
                              "({:.4g}, {:.4g}, {:.4g}) m/s: explicit convection is stable up to "
                              "{}, and beyond {} the run is given up",
                              steps + 1, time, courant, place(b, *cell), v.x, v.y, v.z,
                              courant_limit(numerics), most);
    }
  }
  throw_alike<NumericalError>(mesh.comm, complaint);
}

} // namespace granflux::cfd
