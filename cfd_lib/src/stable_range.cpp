// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/stable_range.hpp>

#include <cmath>
#include <tuple>

#include <fmt/core.h>

namespace granflux::cfd {

std::string_view name_of(Standing standing) {
  switch (standing) {
  case Standing::ok:
    return "OK";
  case Standing::close:
    return "CLOSE";
  case Standing::beyond:
    return "BEYOND";
  case Standing::no_limit:
    return "free";
  case Standing::unknown:
    break;
  }
  return "-";
}

std::size_t StableRange::add(Bound bound) {
  rows_.emplace_back().bound = std::move(bound);
  return rows_.size() - 1;
}

void StableRange::forget(std::size_t row, std::string why) {
  rows_[row].number.reset();
  rows_[row].why_unknown = std::move(why);
}

Standing StableRange::standing(std::size_t row) const {
  const Bound& bound = rows_[row].bound;
  const std::optional<double>& number = rows_[row].number;
  if (!number)
    return Standing::unknown;
  if (std::isinf(bound.limit))
    return Standing::no_limit;
  const bool within = bound.least ? *number >= bound.limit : *number <= bound.limit;
  if (!within) // not-a-number too
    return Standing::beyond;
  const bool well = bound.least ? *number >= bound.advised : *number <= bound.advised;
  return well ? Standing::ok : Standing::close;
}

double StableRange::share(std::size_t row) const {
  const Bound& bound = rows_[row].bound;
  const std::optional<double>& number = rows_[row].number;
  if (!number || std::isinf(bound.limit))
    return 0;
  return bound.least ? bound.limit / *number : *number / bound.limit;
}

std::string StableRange::table(std::string_view title) const {
  std::string text =
      fmt::format("{:<44} {:>10} {:>10}  {:<7} {}\n", title, "number", "limit", "", "cured by");
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const auto& [bound, number, why, crossed, at, sentence] = rows_[r];
    const std::string limit = std::isinf(bound.limit) ? "none" : fmt::format("{:.3g}", bound.limit);
    text += fmt::format("  {:<42} {:>10} {:>10}  {:<7} {}\n", bound.name,
                        number ? fmt::format("{:.3g}", *number) : "-", limit, name_of(standing(r)),
                        number ? bound.cure(*number) : why);
  }
  return text;
}

std::string StableRange::sentence(std::size_t row) const {
  const Bound& bound = rows_[row].bound;
  const double number = rows_[row].number.value_or(0);
  return fmt::format("{} is {:.3g}, its {} {:.3g}: {}", bound.name, number,
                     bound.least ? "least" : "limit", bound.limit, bound.cure(number));
}

std::vector<std::string> StableRange::new_warnings() {
  ++looks_;
  std::vector<std::string> said;
  for (std::size_t r = 0; r < rows_.size(); ++r)
    if (Row& row = rows_[r]; row.crossed == 0 && standing(r) == Standing::beyond) {
      row.crossed = looks_;
      row.share = share(r);
      row.sentence = sentence(r);
      said.push_back(row.sentence);
    }
  return said;
}

std::string StableRange::likely_cause(const std::vector<std::size_t>& rows) const {
  const Row* found = nullptr;
  for (const std::size_t r : rows) {
    const Row& row = rows_[r];
    if (row.crossed > 0 && standing(r) == Standing::beyond &&
        (!found || std::tuple(row.crossed, -row.share) < std::tuple(found->crossed, -found->share)))
      found = &row;
  }
  return found ? found->sentence : "";
}

} // namespace granflux::cfd
