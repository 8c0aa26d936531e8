// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Every void-fraction kernel of the list is held to the contract of kernel.hpp.

#include <gtest/gtest.h>
#include <map>
#include <set>

#include <granflux/cfd/cylinder_grid.hpp>
#include <granflux/cfd/mesh.hpp>
#include <granflux/coupling/kernel/kernels.hpp>

#include "sample_lattices.hpp"

using namespace granflux;
using namespace granflux::coupling;

namespace {

template <class Kernel>
std::map<cfd::Index3, double> shares(const Kernel& kernel, const LatticeLocator& lattice,
                                     const Vec3& centre, double radius) {
  std::map<cfd::Index3, double> found;
  const auto cell = lattice.cell(centre);
  EXPECT_TRUE(cell.has_value());
  kernel(lattice, ParticlePlace{centre, radius, *cell}, [&](const cfd::Index3& c, double share) {
    EXPECT_TRUE(found.emplace(c, share).second) << kernel.name << " emits a cell twice";
  });
  return found;
}

const std::vector<std::array<bool, 3>> peripheries{
    {false, false, false}, {true, false, true}, {true, true, true}};

// Particles from 0.3 to 2 times the largest cell, anywhere, on faces and corners too.
TEST(Kernels, SharesSumToOneAndStayInside) {
  VoidFractionKernels::for_each([](auto kernel) {
    for (const auto& periodic : peripheries) {
      const auto nodes = sample_lattice(periodic);
      const LatticeLocator lattice(nodes);
      std::mt19937 random(7);
      for (int p = 0; p < 2000; ++p) {
        const Vec3 centre = sample_point(nodes, random);
        const double radius = std::uniform_real_distribution(0.15, 1.)(random) * 0.1;
        double sum = 0;
        for (const auto& [cell, share] : shares(kernel, lattice, centre, radius)) {
          EXPECT_GT(share, 0);
          sum += share;
          for (int d = 0; d < 3; ++d)
            if (!periodic[std::size_t(d)]) {
              EXPECT_TRUE(0 <= cell[std::size_t(d)] &&
                          cell[std::size_t(d)] < lattice.axis(d).cells())
                  << kernel.name << " emits a cell outside the domain";
            }
        }
        EXPECT_NEAR(sum, 1, 4e-16 * 29) << kernel.name;
      }
    }
  });
}

// Moving a particle by a period changes the labels by the number of cells and nothing else.
TEST(Kernels, PeriodicImagesAreAlike) {
  VoidFractionKernels::for_each([](auto kernel) {
    const auto nodes = sample_lattice({true, true, true});
    const LatticeLocator lattice(nodes);
    std::mt19937 random(3);
    for (int p = 0; p < 300; ++p) {
      Vec3 centre;
      for (int d = 0; d < 3; ++d) {
        const auto& x = nodes.nodes[std::size_t(d)];
        centre[d] = std::uniform_real_distribution(x.front(), x.back())(random);
      }
      const auto here = shares(kernel, lattice, centre, 0.09);
      const auto there = shares(kernel, lattice, centre + Vec3{1, -2, 1.5}, 0.09);
      ASSERT_EQ(here.size(), there.size()) << kernel.name;
      for (const auto& [cell, share] : here) {
        const auto image = there.find({cell[0] + 10, cell[1] - 7, cell[2] + 5});
        ASSERT_NE(image, there.end()) << kernel.name;
        EXPECT_NEAR(image->second, share, 1e-13);
      }
    }
  });
}

TEST(Kernels, CentreIsOneCell) {
  const LatticeLocator lattice(sample_lattice({false, false, false}));
  const auto found = shares(Centre{}, lattice, {0.2, 1.5, 0.5}, 3);
  EXPECT_EQ(found, (std::map<cfd::Index3, double>{{*lattice.cell({0.2, 1.5, 0.5}), 1.}}));
}

double linear(const Vec3& x) {
  return 0.7 + 2 * x.x - 3 * x.y + 0.5 * x.z;
}

/// Particles anywhere for which no kernel meets a wall: `use`(centre).
template <class Use> void for_inner_points(const cfd::Lattice& nodes, Use&& use) {
  const LatticeLocator lattice(nodes);
  std::mt19937 random(11);
  int inner = 0;
  for (int p = 0; p < 2000; ++p) {
    const Vec3 centre = sample_point(nodes, random);
    bool near_wall = false;
    for (int d = 0; d < 3; ++d) {
      const auto& x = nodes.nodes[std::size_t(d)];
      near_wall = near_wall || centre[d] < x[1] || centre[d] > x[x.size() - 2];
    }
    if (near_wall)
      continue;
    ++inner;
    use(centre);
  }
  EXPECT_GT(inner, 400);
}

double sampled(const auto& kernel, const LatticeLocator& lattice, const Vec3& centre) {
  double value = 0;
  for (const auto& [c, share] : shares(kernel, lattice, centre, 0.05))
    value += share * linear({lattice.axis(0).centre(c[0]), lattice.axis(1).centre(c[1]),
                             lattice.axis(2).centre(c[2])});
  return value;
}

// Linear fields are sampled exactly between cell centres, on stretched grids too.
TEST(Kernels, SplinesAreLinearExact) {
  const auto nodes = sample_lattice({false, false, false});
  const LatticeLocator lattice(nodes);
  for_inner_points(nodes, [&](const Vec3& centre) {
    EXPECT_NEAR(sampled(Trilinear{}, lattice, centre), linear(centre), 1e-13);
    EXPECT_NEAR(sampled(Spline{}, lattice, centre), linear(centre), 1e-13);
  });
}

/// Largest jump of the slope of a share, in shares a cell, as a particle goes through the whole
/// lattice along a direction: second differences are of order the step where there is none.
double largest_kink(const auto& kernel, const cfd::Lattice& nodes, int d) {
  const LatticeLocator lattice(nodes);
  const auto& along = nodes.nodes[std::size_t(d)];
  const int steps = 4000;
  const double step = (along.back() - along.front()) / steps;
  std::map<cfd::Index3, std::array<double, 2>> last;
  double kink = 0;
  for (int s = 0; s <= steps; ++s) {
    Vec3 centre{0.11, 1.3, 0.4};
    centre[d] = std::min(along.front() + s * step, along.back());
    std::map<cfd::Index3, std::array<double, 2>> now;
    for (auto& [cell, before] : last)
      now[cell] = {before[1], 0};
    for (const auto& [cell, share] : shares(kernel, lattice, centre, 0.05))
      now[cell][1] = share;
    if (s > 1)
      for (const auto& [cell, share] : now)
        kink = std::max(kink, std::abs(share[1] - 2 * share[0] + last[cell][0]) / step *
                                  lattice.axis(d).length() / lattice.axis(d).cells());
    last = std::move(now);
  }
  return kink;
}

TEST(Kernels, TheSplinesSlopeHasNoJumpUpToTheWalls) {
  for (const bool periodic : {false, true}) {
    const auto nodes = sample_lattice({periodic, periodic, periodic});
    for (int d = 0; d < 3; ++d) {
      EXPECT_LT(largest_kink(Spline{}, nodes, d), 0.05) << d;
      EXPECT_GT(largest_kink(Trilinear{}, nodes, d), 0.3) << d;
    }
  }
}

TEST(Kernels, SplineInTheMiddleOfEqualCells) {
  const LatticeLocator lattice(sample_lattice({false, false, false}));
  const auto row = *lattice.axis(0).row<3>(lattice.axis(0).centre(4));
  EXPECT_EQ(row.lowest, 3);
  EXPECT_NEAR(row.others[0], 0.125, 1e-14);
  EXPECT_NEAR(row.others[1], 0.125, 1e-14);
}

TEST(Kernels, TrilinearAtACellCentreIsThatCell) {
  const LatticeLocator lattice(sample_lattice({false, true, false}));
  const Vec3 centre{lattice.axis(0).centre(4), lattice.axis(1).centre(0),
                    lattice.axis(2).centre(4)};
  const auto found = shares(Trilinear{}, lattice, centre, 0.05);
  EXPECT_EQ(found, (std::map<cfd::Index3, double>{{{4, 0, 4}, 1.}}));
}

TEST(Kernels, TrilinearCrossesPeriodicFacesOnly) {
  const LatticeLocator lattice(sample_lattice({false, true, false}));
  const Vec3 low_corner{-0.3, 1, 0};
  std::set<int> i, j, k;
  for (const auto& [c, share] : shares(Trilinear{}, lattice, low_corner, 0.05))
    i.insert(c[0]), j.insert(c[1]), k.insert(c[2]);
  EXPECT_EQ(i, std::set<int>{0});
  EXPECT_EQ(j, (std::set<int>{-1, 0}));
  EXPECT_EQ(k, std::set<int>{0});
}

// The points stand for equal volumes: their mean is the centre, their second moments the sphere's
// R^2/5 along each axis but for the core.
TEST(Kernels, DividedPointsHaveTheMomentsOfTheSphere) {
  Vec3 mean;
  double second[3][3] = {};
  for (const Vec3& x : Divided::offsets()) {
    mean += x / Divided::points;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        second[a][b] += x[a] * x[b] / Divided::points;
    EXPECT_LE(norm(x), 1);
  }
  EXPECT_LT(norm(mean), 1e-15);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      EXPECT_NEAR(second[a][b], a == b ? 0.2 * (1 - std::pow(1 / 29., 5 / 3.)) : 0, 1e-14);
}

TEST(Kernels, DividedSpheresInOneCellAreNotSplit) {
  const LatticeLocator lattice(sample_lattice({false, false, false}));
  const Vec3 centre{lattice.axis(0).centre(4), lattice.axis(1).centre(3),
                    lattice.axis(2).centre(2)};
  EXPECT_EQ(shares(Divided{}, lattice, centre, 0.04).size(), 1u);
  EXPECT_GT(shares(Divided{}, lattice, centre, 0.08).size(), 1u);
}

// A sphere cut in half by a face: the points on the face count above it.
TEST(Kernels, DividedOnAFace) {
  const LatticeLocator lattice(sample_lattice({false, false, false}));
  const double face = cfd::uniform_nodes(-0.3, 1, 10)[4];
  const auto found = shares(Divided{}, lattice,
                            {face, lattice.axis(1).centre(3), lattice.axis(2).centre(2)}, 0.05);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found.at({3, 3, 2}), 10 / 29., 1e-15);
  EXPECT_NEAR(found.at({4, 3, 2}), 19 / 29., 1e-15);
}

// Points beyond a wall go to the cell of the centre.
TEST(Kernels, DividedAtAWall) {
  const LatticeLocator lattice(sample_lattice({false, false, false}));
  const Vec3 on_wall{-0.3, lattice.axis(1).centre(3), lattice.axis(2).centre(2)};
  const auto found = shares(Divided{}, lattice, on_wall, 0.05);
  EXPECT_EQ(found, (std::map<cfd::Index3, double>{{{0, 3, 2}, 1.}}));
}

// Shares against the exact volumes of a sphere cut by planes: within what 29 points can say.
TEST(Kernels, DividedIsNearTheExactCut) {
  const LatticeLocator lattice(sample_lattice({false, false, false}));
  const auto nodes = cfd::uniform_nodes(-0.3, 1, 10);
  const double radius = 0.045;
  for (int s = -8; s <= 8; ++s) {
    const double t = s / 8.; // the face lies t radii above the centre
    const Vec3 centre{nodes[4] - t * radius, lattice.axis(1).centre(3), lattice.axis(2).centre(2)};
    double above = 0;
    for (const auto& [c, share] : shares(Divided{}, lattice, centre, radius))
      above += c[0] >= 4 ? share : 0;
    const double exact = (2 - 3 * t + t * t * t) / 4;
    EXPECT_NEAR(above, exact, 0.17) << t;
  }
}

TEST(Kernels, ChosenByName) {
  for (const auto name : VoidFractionKernels::names) {
    const AnyKernel chosen = VoidFractionKernels::make("void_fraction", name);
    EXPECT_EQ(std::visit([](const auto& k) { return std::string_view(k.name); }, chosen), name);
  }
  EXPECT_THROW(VoidFractionKernels::make("void_fraction", "none"), ConfigError);
}

// Cell by cell from the plain search of each point, in the order of the points.
TEST(Kernels, DividedOnFittedGrids) {
  cfd::CylinderGrid cylinder;
  cylinder.radius = 0.5, cylinder.length = 0.8;
  cylinder.core = 4, cylinder.radial = 3, cylinder.axial = 6;
  const cfd::Mesh mesh = make_mesh(make_cylinder(cylinder), MPI_COMM_SELF);
  const BlockLocator blocks(mesh);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> along(-0.5, 0.5);
  using Shares = std::vector<std::pair<cfd::Index3, double>>;
  int several = 0, at_walls = 0, without_room = 0, kept = 0;
  for (int p = 0; p < 5000; ++p) {
    const Vec3 centre{along(random), along(random), 0.4 + 0.8 * along(random)};
    const double radius = 0.02 + 0.2 * std::abs(along(random));
    const auto cell = blocks.cell(centre);
    if (!cell)
      continue;
    Shares wanted;
    for (const Vec3& offset : Divided::offsets()) {
      const auto in = blocks.cell(centre + radius * offset);
      at_walls += !in;
      const auto same = std::find_if(wanted.begin(), wanted.end(), [&](const auto& share) {
        return share.first == in.value_or(*cell);
      });
      if (same == wanted.end())
        wanted.emplace_back(in.value_or(*cell), 1);
      else
        ++same->second;
    }
    for (auto& share : wanted)
      share.second /= Divided::points;
    const auto shares_at = [&](const Vec3& x, const cfd::Index3& in) {
      Shares of_cells;
      const Room room =
          Divided{}(blocks, ParticlePlace{x, radius, in},
                    [&](const cfd::Index3& c, double share) { of_cells.emplace_back(c, share); });
      return std::pair(of_cells, room);
    };
    const auto [found, room] = shares_at(centre, *cell);
    EXPECT_EQ(found, wanted);
    EXPECT_LT(room.ball, 0.5);
    several += found.size() > 2;
    without_room += !room.holds({}); // searched for anew in every coupling step
    for (const double part : {0.3, 0.6, 0.9, 0.999}) {
      const Vec3 way{along(random), along(random), along(random)};
      const Vec3 moved = centre + part * double(room.ball) / norm(way) * way;
      if (const auto in = blocks.cell(moved); in && room.holds(moved - centre)) {
        EXPECT_EQ(shares_at(moved, *in).first, found);
        ++kept;
      }
    }
  }
  EXPECT_GT(several, 1000);
  EXPECT_GT(at_walls, 1000);
  EXPECT_LT(without_room, 15);
  EXPECT_GT(kept, 1000);
}

} // namespace
