// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <omp.h>

#include <granflux/cfd/cylinder_grid.hpp>
#include <granflux/cfd/mesh.hpp>
#include <granflux/coupling/weights.hpp>

#include "sample_lattices.hpp"

using namespace granflux;
using namespace granflux::coupling;

namespace {

struct Cloud {
  std::vector<Vec3> position;
  std::vector<double> radius, value;
};

Cloud random_cloud(const cfd::Lattice& lattice, int count, unsigned seed = 5) {
  std::mt19937 random(seed);
  Cloud cloud;
  for (int p = 0; p < count; ++p) {
    cloud.position.push_back(sample_point(lattice, random));
    cloud.radius.push_back(std::uniform_real_distribution(0.01, 0.2)(random));
    cloud.value.push_back(std::normal_distribution()(random));
  }
  return cloud;
}

std::vector<double> random_field(std::size_t size) {
  std::mt19937 random(9);
  std::vector<double> field(size);
  for (double& f : field)
    f = std::normal_distribution()(random);
  return field;
}

template <class Body> void for_each_case(Body&& body) {
  for (const auto name : VoidFractionKernels::names)
    for (const bool periodic : {false, true}) {
      SCOPED_TRACE(std::string(name) + (periodic ? ", periodic" : ", walls"));
      body(VoidFractionKernels::make("void_fraction", name),
           sample_lattice({periodic, periodic, periodic}));
    }
}

using Values = std::vector<double>;

Values deposit(const Weights& weights, const Values& value) {
  Values field(weights.window().size());
  weights.deposit<double>(value, field);
  return field;
}

Values sample(const Weights& weights, const Values& field) {
  Values value(weights.particles());
  weights.sample<double>(field, value);
  return value;
}

TEST(Weights, DepositIsTheAdjointOfSample) {
  for_each_case([](const AnyKernel& kernel, const cfd::Lattice& lattice) {
    const auto cloud = random_cloud(lattice, 3000);
    Weights weights;
    weights.build(kernel, LatticeLocator(lattice), cloud.position, cloud.radius);
    EXPECT_EQ(weights.placed_count(), cloud.position.size());
    const Values f = random_field(weights.window().size());
    const Values dq = deposit(weights, cloud.value), sf = sample(weights, f);
    const double by_particles =
        std::inner_product(cloud.value.begin(), cloud.value.end(), sf.begin(), 0.);
    const double by_cells = std::inner_product(dq.begin(), dq.end(), f.begin(), 0.);
    double scale = 0;
    for (std::size_t p = 0; p < sf.size(); ++p)
      scale += std::abs(cloud.value[p] * sf[p]);
    EXPECT_NEAR(by_particles, by_cells, 1e-14 * scale);
  });
}

TEST(Weights, DepositKeepsTheSumAndSampleKeepsAConstant) {
  for_each_case([](const AnyKernel& kernel, const cfd::Lattice& lattice) {
    const auto cloud = random_cloud(lattice, 3000);
    Weights weights;
    weights.build(kernel, LatticeLocator(lattice), cloud.position, cloud.radius);
    const Values volume = deposit(weights, cloud.radius);
    const double in = std::accumulate(cloud.radius.begin(), cloud.radius.end(), 0.);
    EXPECT_NEAR(std::accumulate(volume.begin(), volume.end(), 0.), in, 1e-13 * in);
    for (const double value : sample(weights, Values(weights.window().size(), 1.)))
      EXPECT_NEAR(value, 1, 1e-14);
  });
}

// What the kernel says, added up in the order of the particles.
void expect_plain_loop(const AnyKernel& any_kernel, const cfd::Lattice& lattice) {
  const auto cloud = random_cloud(lattice, 500);
  const LatticeLocator locator(lattice);
  Weights weights;
  weights.build(any_kernel, locator, cloud.position, cloud.radius);
  const Values f = random_field(weights.window().size());
  Values deposited(f.size(), 0.), sampled(cloud.value.size(), 0.);
  std::visit(
      [&](const auto& kernel) {
        for (std::size_t p = 0; p < sampled.size(); ++p) {
          const ParticlePlace place{cloud.position[p], cloud.radius[p],
                                    *locator.cell(cloud.position[p])};
          kernel(locator, place, [&](const cfd::Index3& cell, double share) {
            ASSERT_TRUE(weights.window().contains(cell));
            deposited[weights.window().index(cell)] += cloud.value[p] * share;
            sampled[p] += f[weights.window().index(cell)] * share;
          });
        }
      },
      any_kernel);
  const Values d = deposit(weights, cloud.value), s = sample(weights, f);
  for (std::size_t c = 0; c < d.size(); ++c)
    EXPECT_NEAR(d[c], deposited[c], 1e-14);
  for (std::size_t p = 0; p < s.size(); ++p)
    EXPECT_NEAR(s[p], sampled[p], 1e-14);
}

TEST(Weights, MatchAPlainLoop) {
  for_each_case(expect_plain_loop);
}

// There is no upper cell then.
TEST(Weights, GridsOfOneCell) {
  for (const auto name : VoidFractionKernels::names)
    for (int thin = 0; thin < 3; ++thin)
      for (const bool periodic : {false, true}) {
        auto lattice = sample_lattice({periodic, periodic, periodic});
        auto& nodes = lattice.nodes[std::size_t(thin)];
        nodes = {nodes.front(), nodes.back()};
        lattice.starts[std::size_t(thin)] = {0, 1};
        expect_plain_loop(VoidFractionKernels::make("void_fraction", name), lattice);
      }
}

// Bit for bit, whatever the number of threads.
TEST(Weights, SameBitsForEveryNumberOfThreads) {
  const int before = omp_get_max_threads();
  for_each_case([](const AnyKernel& kernel, const cfd::Lattice& lattice) {
    const auto cloud = random_cloud(lattice, 3001);
    Values deposited, sampled;
    for (const int threads : {1, 2, 3, 7}) {
      omp_set_num_threads(threads);
      Weights weights;
      weights.build(kernel, LatticeLocator(lattice), cloud.position, cloud.radius);
      const Values d = deposit(weights, cloud.value);
      const Values s = sample(weights, random_field(weights.window().size()));
      if (threads == 1)
        deposited = d, sampled = s;
      EXPECT_EQ(d, deposited) << threads;
      EXPECT_EQ(s, sampled) << threads;
    }
  });
  omp_set_num_threads(before);
}

TEST(Weights, VectorsGoLikeTheirComponents) {
  const auto lattice = sample_lattice({false, true, false});
  const auto cloud = random_cloud(lattice, 200);
  Weights weights;
  weights.build(Trilinear{}, LatticeLocator(lattice), cloud.position, cloud.radius);
  std::vector<Vec3> vectors(cloud.value.size()), field(weights.window().size());
  for (std::size_t p = 0; p < vectors.size(); ++p)
    vectors[p] = {cloud.value[p], 2 * cloud.value[p], cloud.radius[p]};
  weights.deposit<Vec3>(vectors, field);
  const Values x = deposit(weights, cloud.value), z = deposit(weights, cloud.radius);
  for (std::size_t c = 0; c < field.size(); ++c) {
    EXPECT_EQ(field[c].x, x[c]);
    EXPECT_EQ(field[c].z, z[c]);
  }
}

TEST(Weights, LeavesOutWhatIsOutsideOrNotCoupled) {
  const auto lattice = sample_lattice({false, true, false});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> position{{0, 2, 1}, {5, 2, 1}, {0, 2, 1}, {0, nan, 1}, {0, 3.5, 1}};
  const std::vector<double> radius(5, 0.1), value(5, 1.);
  const std::vector<std::uint8_t> coupled{1, 1, 0, 1, 1};
  for (const auto name : VoidFractionKernels::names) {
    Weights weights;
    weights.build(VoidFractionKernels::make("void_fraction", name), LatticeLocator(lattice),
                  position, radius, coupled);
    EXPECT_EQ(weights.placed_count(), 2u);
    EXPECT_EQ(weights.outside_count(), 2u) << "a particle that is not coupled is not missed";
    const std::vector<bool> placed{true, false, false, false, true};
    for (std::size_t p = 0; p < 5; ++p)
      EXPECT_EQ(weights.placed(p), placed[p]);
    const Values field = deposit(weights, value);
    EXPECT_NEAR(std::accumulate(field.begin(), field.end(), 0.), 2, 1e-14);
    const Values back = sample(weights, Values(field.size(), 1.));
    for (std::size_t p = 0; p < 5; ++p)
      EXPECT_NEAR(back[p], placed[p] ? 1 : 0, 1e-14);
  }
}

TEST(Weights, NoParticles) {
  Weights weights;
  EXPECT_EQ(weights.particles(), 0u);
  weights.build(Trilinear{}, LatticeLocator(sample_lattice({false, true, false})), {}, {});
  EXPECT_EQ(weights.particles(), 0u);
  EXPECT_EQ(weights.window().size(), 0u);
  weights.deposit<double>({}, {});
  weights.sample<double>({}, {});
}

// Where all cells are equal, particles are placed together on vector registers. The window of a
// rank whose particles were all outside has no cells.
TEST(Weights, ParticlesInsideAfterNoneWas) {
  cfd::Lattice lattice = sample_lattice({false, false, false});
  lattice.nodes[1] = cfd::uniform_nodes(1, 2, 7);
  lattice.nodes[2] = cfd::uniform_nodes(0, 1.5, 5);
  const auto cloud = random_cloud(lattice, 96); // none is left over, to be placed alone
  auto outside = cloud.position;
  for (Vec3& x : outside)
    x.y += 10;
  for (const auto name : VoidFractionKernels::names) {
    SCOPED_TRACE(name);
    const AnyKernel kernel = VoidFractionKernels::make("void_fraction", name);
    Weights weights, fresh;
    weights.build(kernel, LatticeLocator(lattice), outside, cloud.radius);
    EXPECT_EQ(weights.placed_count(), 0u);
    weights.build(kernel, LatticeLocator(lattice), cloud.position, cloud.radius);
    fresh.build(kernel, LatticeLocator(lattice), cloud.position, cloud.radius);
    EXPECT_EQ(weights.placed_count(), cloud.position.size());
    EXPECT_EQ(weights.window().lo, fresh.window().lo);
    EXPECT_EQ(weights.window().hi, fresh.window().hi);
    EXPECT_EQ(deposit(weights, cloud.value), deposit(fresh, cloud.value));
  }
}

// A rank whose particles sit together has a small window, also across a periodic face, and also
// where the host has not wrapped them for long.
TEST(Weights, WindowIsTight) {
  const auto lattice = sample_lattice({true, true, true});
  const std::vector<Vec3> position{{-0.31, 1.01, 0.01}, {-0.29, 0.99, -0.01}, {-0.3, 41, 30}};
  const std::vector<double> radius(3, 0.01);
  Weights weights;
  weights.build(Trilinear{}, LatticeLocator(lattice), position, radius);
  EXPECT_EQ(weights.window().lo, (cfd::Index3{-1, -1, -1}));
  EXPECT_EQ(weights.window().hi, (cfd::Index3{1, 1, 1}));
}

// Building again leaves nothing of before.
TEST(Weights, BuildAnew) {
  const auto lattice = sample_lattice({false, false, false});
  const auto many = random_cloud(lattice, 1000), few = random_cloud(lattice, 10, 77);
  Weights weights, fresh;
  weights.build(Divided{}, LatticeLocator(lattice), many.position, many.radius);
  weights.build(Trilinear{}, LatticeLocator(lattice), few.position, few.radius);
  fresh.build(Trilinear{}, LatticeLocator(lattice), few.position, few.radius);
  EXPECT_EQ(weights.window().lo, fresh.window().lo);
  EXPECT_EQ(weights.window().hi, fresh.window().hi);
  EXPECT_EQ(deposit(weights, few.value), deposit(fresh, few.value));
}

// Field values by cell: two builds may have windows of different widths.
void expect_same_deposit(const Weights& kept, const Weights& fresh, const Values& value) {
  const Window &wide = kept.window(), &tight = fresh.window();
  const Values all = deposit(kept, value), found = deposit(fresh, value);
  double rest = 0;
  for (int k = wide.lo[2]; k < wide.hi[2]; ++k)
    for (int j = wide.lo[1]; j < wide.hi[1]; ++j)
      for (int i = wide.lo[0]; i < wide.hi[0]; ++i) {
        const double field = all[wide.index({i, j, k})];
        if (tight.contains({i, j, k}))
          ASSERT_EQ(field, found[tight.index({i, j, k})]);
        else
          rest += std::abs(field);
      }
  EXPECT_EQ(rest, 0);
}

// Particles by cell are kept from build to build and mended: the order of the sums, and so every
// bit, is that of a sort. Few move, then many, some leave the grid and come back.
TEST(Weights, KeptOrderIsThatOfASort) {
  const int before = omp_get_max_threads();
  const auto follow = [](const AnyKernel& kernel, const cfd::Lattice& lattice) {
    auto cloud = random_cloud(lattice, 2000);
    std::mt19937 random(4);
    Weights kept;
    for (int build = 0; build < 100; ++build) {
      omp_set_num_threads(1 + build % 3);
      const double share = build % 10 == 9 ? 0.5 : build % 10 == 8 ? 0 : 0.01;
      for (Vec3& x : cloud.position)
        if (std::uniform_real_distribution()(random) < share)
          x = build % 10 == 6 ? Vec3{1e3, 1e3, 1e3} : sample_point(lattice, random);
      kept.build(kernel, LatticeLocator(lattice), cloud.position, cloud.radius);
      Weights fresh;
      fresh.build(kernel, LatticeLocator(lattice), cloud.position, cloud.radius);
      EXPECT_EQ(kept.placed_count(), fresh.placed_count());
      EXPECT_EQ(kept.outside_count(), fresh.outside_count());
      ASSERT_NO_FATAL_FAILURE(expect_same_deposit(kept, fresh, cloud.value)) << build;
    }
  };
  for_each_case(follow);
  cfd::Lattice equal = sample_lattice({false, false, false}); // all cells found on vector registers
  equal.nodes[1] = cfd::uniform_nodes(1, 2, 7), equal.nodes[2] = cfd::uniform_nodes(0, 1.5, 5);
  follow(Trilinear{}, equal);
  omp_set_num_threads(before);
}

// A window that has become too wide for its particles narrows after a while.
TEST(Weights, WindowNarrows) {
  const auto lattice = sample_lattice({false, false, false});
  auto cloud = random_cloud(lattice, 100);
  Weights kept, fresh;
  kept.build(Trilinear{}, LatticeLocator(lattice), cloud.position, cloud.radius);
  std::fill(cloud.position.begin(), cloud.position.end(), cloud.position[0]);
  for (int build = 0; build < 100; ++build)
    kept.build(Trilinear{}, LatticeLocator(lattice), cloud.position, cloud.radius);
  fresh.build(Trilinear{}, LatticeLocator(lattice), cloud.position, cloud.radius);
  EXPECT_EQ(kept.window().lo, fresh.window().lo);
  EXPECT_EQ(kept.window().hi, fresh.window().hi);
  EXPECT_EQ(deposit(kept, cloud.value), deposit(fresh, cloud.value));
}

cfd::Mesh drum(int radial) {
  cfd::CylinderGrid cylinder;
  cylinder.radius = 0.5, cylinder.length = 0.8;
  cylinder.core = 4, cylinder.radial = radial, cylinder.axial = 6;
  cylinder.axial_blocks = 2;
  cylinder.periodic_axis = true;
  return make_mesh(make_cylinder(cylinder), MPI_COMM_SELF);
}

void expect_same_shares(const Weights& kept, const Weights& fresh, const Values& value) {
  EXPECT_EQ(kept.window().lo, fresh.window().lo);
  EXPECT_EQ(kept.window().hi, fresh.window().hi);
  EXPECT_EQ(kept.placed_count(), fresh.placed_count());
  EXPECT_EQ(kept.outside_count(), fresh.outside_count());
  EXPECT_EQ(deposit(kept, value), deposit(fresh, value));
  const Values field = random_field(fresh.window().size());
  EXPECT_EQ(sample(kept, field), sample(fresh, field));
}

// Where shares are kept while particles stay near, they are those that are found anew: to the bit.
TEST(Weights, KeptSharesAreThoseFoundAnew) {
  const AnyLocator coarse = BlockLocator(drum(3)), fine = BlockLocator(drum(5));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(-1, 1);
  const auto way = [&] { return Vec3{along(random), along(random), along(random)}; };
  const int threads = omp_get_max_threads();
  for (const AnyKernel& kernel :
       {AnyKernel(Divided{}), AnyKernel(Centre{}), AnyKernel(Smoothed{})}) {
    Cloud cloud;
    for (int p = 0; p < 500; ++p) {
      cloud.position.push_back(Vec3{0, 0, 0.4} + 0.4 * way());
      cloud.radius.push_back(0.01 + 0.03 * p / 500);
      cloud.value.push_back(along(random));
    }
    std::vector<std::uint8_t> coupled(500, 1);
    Weights kept;
    const auto build = [&](const AnyLocator& locator) {
      Weights fresh;
      kept.build(kernel, locator, cloud.position, cloud.radius, coupled);
      fresh.build(kernel, locator, cloud.position, cloud.radius, coupled);
      EXPECT_GT(fresh.placed_count(), 150u);
      expect_same_shares(kept, fresh, cloud.value);
    };
    build(coarse);
    for (const double step : {0., 1e-5, 1e-4, 1e-3, 1e-2, 1e-1})
      for (int n = 0; n < 20; ++n) {
        for (Vec3& x : cloud.position)
          x += step * way();
        build(coarse);
      }
    std::reverse(cloud.radius.begin(), cloud.radius.end());
    build(coarse);
    std::reverse(cloud.position.begin(), cloud.position.end());
    build(coarse);
    build(fine);
    kept.build(Divided{}, LatticeLocator(sample_lattice({true, true, true})), cloud.position,
               cloud.radius);
    build(fine);
    kept.build(Divided{}, fine, cloud.position, cloud.radius);
    build(fine);
    for (int p = 0; p < 500; p += 3)
      coupled[std::size_t(p)] = 0;
    build(fine);
    coupled.assign(500, 1);
    omp_set_num_threads(3);
    build(fine);
    omp_set_num_threads(threads);
    build(fine);
    for (const std::size_t count : {450, 470, 490, 600}) { // of other ranks, or new
      for (auto* numbers : {&cloud.radius, &cloud.value})
        numbers->resize(count, 0.02);
      cloud.position.resize(count, cloud.position[7]), coupled.resize(count, 1);
      build(fine);
      std::swap(cloud.position.front(), cloud.position.back());
      build(fine);
    }
  }
}

} // namespace
