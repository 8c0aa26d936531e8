// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <granflux/cfd/field.hpp>

namespace granflux::cfd {

/// What leaves a cell through its six faces, of a quantity on faces counted along +direction.
class FaceSum {
public:
  FaceSum(const Layout& layout, const std::array<Field, 3>& faces)
      : i_(faces[0].data()), j_(faces[1].data()), k_(faces[2].data()), sj_(layout.stride[1]),
        sk_(layout.stride[2]) {}
  double operator()(std::ptrdiff_t c) const {
    return i_[c + 1] - i_[c] + j_[c + sj_] - j_[c] + k_[c + sk_] - k_[c];
  }

private:
  const double *i_, *j_, *k_;
  std::ptrdiff_t sj_, sk_;
};

} // namespace granflux::cfd
