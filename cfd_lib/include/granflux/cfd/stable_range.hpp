// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace granflux::cfd {

/// A number that a run stays stable by, or is true by, with what it must keep to.
struct Bound {
  static constexpr double none = std::numeric_limits<double>::infinity();

  std::string name;
  double limit = none;   ///< none: the scheme is stable whatever the number is
  double advised = none; ///< from here on to the limit it is close
  bool least = false;    ///< the limit is a lower one
  /// What brings the number back: the keyword, with a value where one follows from the number.
  std::function<std::string(double number)> cure;
};

enum class Standing { ok, close, beyond, no_limit, unknown };
[[nodiscard]] std::string_view name_of(Standing standing);

/// The numbers of a run beside their limits (docs/reference/stable_range.md). Plain data of one
/// rank: hand in what has been reduced.
class StableRange {
public:
  /// Returns the row of the bound.
  std::size_t add(Bound bound);
  /// `name`: of the row from here on, where it names what the number belongs to.
  void set(std::size_t row, double number) { rows_[row].number = number; }
  void rename(std::size_t row, std::string name) { rows_[row].bound.name = std::move(name); }
  /// Why the number is not known; it is forgotten.
  void forget(std::size_t row, std::string why);

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] Standing standing(std::size_t row) const;
  /// Number over limit, or limit over number where the limit is a lower one: above 1 is beyond. 0
  /// where there is no limit or no number.
  [[nodiscard]] double share(std::size_t row) const;

  /// One line a row: number, limit, standing, cure; `title` over them.
  [[nodiscard]] std::string table(std::string_view title) const;
  /// "gas Courant number is 0.7, its limit 0.5: cure"
  [[nodiscard]] std::string sentence(std::size_t row) const;
  /// A sentence for each row that is beyond its limit, once in the life of this. Cheap where none.
  [[nodiscard]] std::vector<std::string> new_warnings();
  /// Of these rows that are beyond their limit the one that was so first, as it was then (of
  /// several at once the furthest beyond); empty where none is.
  [[nodiscard]] std::string likely_cause(const std::vector<std::size_t>& rows) const;

private:
  struct Row {
    Bound bound;
    std::optional<double> number;
    std::string why_unknown = "not known yet";
    // Of the first time that it was beyond its limit.
    int crossed = 0; ///< how many calls of new_warnings() that took; 0: never
    double share = 0;
    std::string sentence;
  };
  std::vector<Row> rows_;
  int looks_ = 0;
};

} // namespace granflux::cfd
