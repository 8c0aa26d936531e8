// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <granflux/cfd/error.hpp>
#include <granflux/coupling/drag/laws.hpp>
#include <granflux/coupling/kernel/kernels.hpp>
#include <granflux/coupling/read_coupling.hpp>

namespace {

using namespace granflux;

coupling::CouplingOptions read(const std::string& lines) {
  cfd::CaseFile file = cfd::CaseFile::parse("[coupling]\n" + lines, "bed.toml");
  const coupling::CouplingOptions options = coupling::read_coupling(file);
  file.finish();
  return options;
}

std::string complaint(const std::string& lines) {
  try {
    read(lines);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(ReadCoupling, DefaultsHoldForAnEmptyTable) {
  const auto options = read("");
  EXPECT_EQ(options.drag, "gidaspow");
  EXPECT_EQ(options.void_fraction, "trilinear");
  EXPECT_EQ(options.smoothing_width, 3);
  EXPECT_EQ(options.model, coupling::MomentumModel::a);
  EXPECT_EQ(options.void_fraction_floor, 0.05);
  EXPECT_EQ(options.drag_treatment, coupling::DragTreatment::implicit_in_both);
  EXPECT_EQ(options.coarse_graining, 1);
}

TEST(ReadCoupling, TakesEveryKey) {
  const auto options = read("drag = \"di_felice\"\nvoid_fraction = \"divided\"\n"
                            "smoothing_width = 2.5\nmodel = \"b\"\nvoid_fraction_floor = 0.2\n"
                            "drag_treatment = \"explicit\"\ncoarse_graining = 2.5\n");
  EXPECT_EQ(options.drag, "di_felice");
  EXPECT_EQ(options.void_fraction, "divided");
  EXPECT_EQ(options.smoothing_width, 2.5);
  EXPECT_EQ(options.model, coupling::MomentumModel::b);
  EXPECT_EQ(options.void_fraction_floor, 0.2);
  EXPECT_EQ(options.drag_treatment, coupling::DragTreatment::explicit_in_both);
  EXPECT_EQ(options.coarse_graining, 2.5);
}

TEST(ReadCoupling, AnswersAnUnknownNameWithTheKnownOnes) {
  const std::string drag = complaint("drag = \"newton\"");
  for (const auto name : coupling::DragLaws::names)
    EXPECT_NE(drag.find(name), std::string::npos) << drag;
  const std::string kernel = complaint("void_fraction = \"gaussian\"");
  for (const auto name : coupling::VoidFractionKernels::names)
    EXPECT_NE(kernel.find(name), std::string::npos) << kernel;
  for (const std::string& text : {drag, kernel})
    EXPECT_NE(text.find("bed.toml"), std::string::npos) << text;
}

TEST(ReadCoupling, RefusesWhatIsOutOfRange) {
  EXPECT_NE(complaint("smoothing_width = -1"), "");
  EXPECT_NE(complaint("void_fraction_floor = 0.0"), "");
  EXPECT_NE(complaint("void_fraction_floor = 1.0"), "");
  EXPECT_NE(complaint("model = \"c\""), "");
  EXPECT_NE(complaint("smoothing = 3"), "");
  EXPECT_NE(complaint("coarse_graining = 0.5").find("coarse_graining"), std::string::npos);
  const std::string treatment = complaint("drag_treatment = \"exact\"");
  for (const char* name : {"explicit", "semi_implicit", "implicit"})
    EXPECT_NE(treatment.find(name), std::string::npos) << treatment;
}

} // namespace
