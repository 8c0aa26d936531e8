// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/read_coupling.hpp>

#include <granflux/coupling/drag/laws.hpp>
#include <granflux/coupling/kernel/kernels.hpp>
#include <granflux/coupling/nusselt/laws.hpp>

namespace granflux::coupling {

namespace {

template <class List> std::vector<std::string> names_of() {
  return {List::names.begin(), List::names.end()};
}

/// How gas and particles exchange heat: by a law, or with a given coefficient.
void read_heat_transfer(cfd::CaseFile& file, const cfd::CaseTable& table,
                        CouplingOptions& options) {
  if (!file.has("energy")) {
    for (const char* key : {"nusselt", "heat_transfer_coefficient"})
      table.refuse(key, "the case has no [energy] table");
    return;
  }
  if (table.has("heat_transfer_coefficient")) {
    table.refuse("nusselt", "the case gives a heat_transfer_coefficient");
    options.heat_transfer_coefficient =
        table.number("heat_transfer_coefficient", cfd::positive, "W/(m2 K)");
  }
  options.nusselt = table.word("nusselt", options.nusselt, names_of<NusseltLaws>());
}

} // namespace

CouplingOptions read_coupling(cfd::CaseFile& file) {
  const cfd::CaseTable table = file.table("coupling");
  constexpr cfd::NumberRange open_share{
      .low = 0, .high = 1, .low_included = false, .high_included = false};
  CouplingOptions options;
  options.drag = table.word("drag", options.drag, names_of<DragLaws>());
  options.void_fraction =
      table.word("void_fraction", options.void_fraction, names_of<VoidFractionKernels>());
  read_heat_transfer(file, table, options);
  options.smoothing_width = table.number("smoothing_width", options.smoothing_width,
                                         cfd::not_negative, "particle diameters");
  options.model =
      table.choice("model", options.model, {{"a", MomentumModel::a}, {"b", MomentumModel::b}});
  options.drag_treatment = table.choice("drag_treatment", options.drag_treatment,
                                        {{"explicit", DragTreatment::explicit_in_both},
                                         {"semi_implicit", DragTreatment::implicit_in_gas},
                                         {"implicit", DragTreatment::implicit_in_both}});
  options.coarse_graining =
      table.number("coarse_graining", options.coarse_graining, cfd::NumberRange{.low = 1}, "");
  options.void_fraction_floor =
      table.number("void_fraction_floor", options.void_fraction_floor, open_share, "");
  return options;
}

} // namespace granflux::coupling
