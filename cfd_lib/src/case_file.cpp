// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/case_file.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <toml++/toml.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/nearest_name.hpp>

namespace granflux::cfd {

/// The parsed text, and for each table who asked for what.
struct CaseText {
  struct Table {
    const toml::table* content; ///< null where the file has no such table
    std::string label;          ///< as in messages: [fluid], [[boundary]] 2 "top"; empty: the root
    std::vector<std::string> known;
  };
  std::string name;
  toml::table root;
  std::vector<Table> tables; ///< 0 is the root

  const toml::node* find(std::size_t table, const std::string& key) {
    auto& known = tables[table].known;
    if (std::find(known.begin(), known.end(), key) == known.end())
      known.push_back(key);
    return tables[table].content ? tables[table].content->get(key) : nullptr;
  }
  std::size_t add(const toml::table* content, std::string label) {
    for (std::size_t t = 0; t < tables.size(); ++t)
      if (tables[t].label == label)
        return t;
    tables.push_back({content, std::move(label), {}});
    return tables.size() - 1;
  }
  /// Of a key that is missing, or whose table is: the one that may have been meant for it.
  [[nodiscard]] std::string misspelt(std::size_t table, const std::string& key) const {
    if (tables[table].content)
      return unknown_near(table, key);
    const std::string& label = tables[table].label;
    return unknown_near(0, label.substr(1, label.size() - 2));
  }
  [[nodiscard]] std::string unknown_near(std::size_t table, const std::string& wanted) const {
    const auto& known = tables[table].known;
    std::size_t least = std::string::npos;
    std::string text;
    for (const auto& [key, node] : *tables[table].content) {
      const std::string found(key.str());
      const std::string hint = name_hint(found, {wanted});
      const std::size_t distance = edit_distance(found, wanted);
      if (distance >= least || std::ranges::find(known, found) != known.end() ||
          !hint.starts_with("did you mean"))
        continue;
      least = distance;
      text = fmt::format("; {} (line {}) is unknown: {}", found, key.source().begin.line, hint);
    }
    return text;
  }
  [[nodiscard]] std::string where(std::size_t table, const std::string& key) const {
    const std::string& label = tables[table].label;
    return label.empty() ? fmt::format("{}: {}", name, key)
                         : fmt::format("{}: {} {}", name, label, key);
  }
};

namespace {

/// A value as a message shows it.
std::string written(const toml::node& node) {
  if (const auto* number = node.as_floating_point())
    return fmt::format("{}", number->get());
  if (const auto* text = node.as_string())
    return fmt::format("\"{}\"", text->get());
  if (node.is_table())
    return "a table";
  if (node.is_array_of_tables())
    return "tables";
  if (const toml::array* array = node.as_array()) {
    constexpr std::size_t most = 6; // elements shown of a long one
    std::string text = "[";
    for (std::size_t i = 0; i < std::min(array->size(), most); ++i)
      text += (i ? ", " : "") + written((*array)[i]);
    return text + (array->size() > most ? ", ...]" : "]");
  }
  std::ostringstream out;
  node.visit([&](const auto& value) { out << value; });
  return out.str();
}

std::string described(const NumberRange& range, std::string_view unit, bool plural) {
  std::string text = plural ? "numbers" : "a number";
  if (std::isfinite(range.low))
    text += fmt::format(" {} {}", range.low_included ? ">=" : ">", range.low);
  if (std::isfinite(range.high))
    text += fmt::format("{} {} {}", std::isfinite(range.low) ? " and" : "",
                        range.high_included ? "<=" : "<", range.high);
  if (!unit.empty())
    text += fmt::format(" ({})", unit);
  return text;
}

std::string described(int low, int high, bool plural) {
  constexpr int unlimited = std::numeric_limits<int>::max();
  const char* noun = plural ? "integers" : "an integer";
  return high == unlimited ? fmt::format("{} >= {}", noun, low)
                           : fmt::format("{} from {} to {}", noun, low, high);
}

std::optional<double> finite_number(const toml::node& node, const NumberRange& range) {
  if (!node.is_number())
    return {};
  const std::optional<double> value = node.value<double>();
  if (!value || !std::isfinite(*value) || !range.contains(*value))
    return {};
  return value;
}

std::optional<int> whole_number(const toml::node& node, int low, int high) {
  const auto* integer = node.as_integer();
  if (!integer || integer->get() < low || integer->get() > high)
    return {};
  return int(integer->get());
}

/// All elements of an array through `element`; empty where one of them, or the number of them, is
/// wrong.
template <class Value, class Element>
std::optional<std::vector<Value>> elements(const toml::node& node, std::size_t least,
                                           std::size_t most, Element element) {
  const toml::array* array = node.as_array();
  if (!array || array->size() < least || array->size() > most)
    return {};
  std::vector<Value> values;
  for (const toml::node& item : *array) {
    const std::optional<Value> value = element(item);
    if (!value)
      return {};
    values.push_back(*value);
  }
  return values;
}

/// What rank 0 read, or why it could not.
struct ReadResult {
  std::string content, failure;
};

ReadResult read_whole(const std::string& path) {
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  std::ostringstream content;
  if (in && in.peek() != std::ifstream::traits_type::eof())
    content << in.rdbuf();
  if (!in.is_open() || in.bad() || content.fail()) // a folder opens, but does not read
    return {{}, std::generic_category().message(errno ? errno : EIO)};
  return {content.str(), {}};
}

void broadcast(std::string& text, MPI_Comm comm) {
  unsigned long long size = text.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, 0, comm);
  text.resize(size);
  MPI_Bcast(text.data(), int(size), MPI_CHAR, 0, comm);
}

void collect_leftovers(const CaseText& text, std::size_t table, std::string& leftovers) {
  const CaseText::Table& asked = text.tables[table];
  if (!asked.content)
    return;
  for (const auto& [key, node] : *asked.content) {
    const std::string name(key.str());
    if (std::find(asked.known.begin(), asked.known.end(), name) != asked.known.end())
      continue;
    const bool is_table = node.is_table() || node.is_array_of_tables();
    const std::string shown = !is_table                   ? name
                              : node.is_array_of_tables() ? "[[" + name + "]]"
                                                          : "[" + name + "]";
    leftovers += fmt::format("{}{} (line {}): unknown {}; {}", leftovers.empty() ? "" : "\n",
                             text.where(table, shown), key.source().begin.line,
                             is_table ? "table" : "key", name_hint(name, asked.known));
  }
}

} // namespace

bool CaseTable::has(const std::string& key) const {
  return text_->find(table_, key) != nullptr;
}

void CaseTable::fail(const std::string& key, const std::string& must_be) const {
  const std::string where = text_->where(table_, key);
  if (const toml::node* node = text_->find(table_, key))
    throw ConfigError(fmt::format("{} = {}: must be {}", where, written(*node), must_be));
  throw ConfigError(
      fmt::format("{} is missing: must be {}{}", where, must_be, text_->misspelt(table_, key)));
}

void CaseTable::refuse(const std::string& key, const std::string& why) const {
  if (const toml::node* node = text_->find(table_, key))
    throw ConfigError(
        fmt::format("{} = {}: not allowed: {}", text_->where(table_, key), written(*node), why));
}

double CaseTable::number(const std::string& key, NumberRange range, std::string_view unit) const {
  const toml::node* node = text_->find(table_, key);
  const std::optional<double> value = node ? finite_number(*node, range) : std::nullopt;
  if (!value)
    fail(key, described(range, unit, false));
  return *value;
}

double CaseTable::number(const std::string& key, double absent, NumberRange range,
                         std::string_view unit) const {
  return has(key) ? number(key, range, unit) : absent;
}

int CaseTable::integer(const std::string& key, int low, int high) const {
  const toml::node* node = text_->find(table_, key);
  const std::optional<int> value = node ? whole_number(*node, low, high) : std::nullopt;
  if (!value)
    fail(key, described(low, high, false));
  return *value;
}

int CaseTable::integer(const std::string& key, int absent, int low, int high) const {
  return has(key) ? integer(key, low, high) : absent;
}

bool CaseTable::flag(const std::string& key, bool absent) const {
  const toml::node* node = text_->find(table_, key);
  if (!node)
    return absent;
  if (!node->is_boolean())
    fail(key, "true or false");
  return node->as_boolean()->get();
}

std::string CaseTable::text(const std::string& key) const {
  const toml::node* node = text_->find(table_, key);
  if (!node || !node->is_string() || node->as_string()->get().empty())
    fail(key, "a text in quotes");
  return node->as_string()->get();
}

std::string CaseTable::text(const std::string& key, const std::string& absent) const {
  return has(key) ? text(key) : absent;
}

Vec3 CaseTable::vector(const std::string& key, NumberRange range, std::string_view unit) const {
  const toml::node* node = text_->find(table_, key);
  const auto values =
      node ? elements<double>(*node, 3, 3,
                              [&](const toml::node& item) { return finite_number(item, range); })
           : std::nullopt;
  if (!values)
    fail(key, "three " + described(range, unit, true) + ", as [x, y, z]");
  return {(*values)[0], (*values)[1], (*values)[2]};
}

Vec3 CaseTable::vector(const std::string& key, Vec3 absent, NumberRange range,
                       std::string_view unit) const {
  return has(key) ? vector(key, range, unit) : absent;
}

std::array<int, 3> CaseTable::integers(const std::string& key, int low, int high) const {
  const toml::node* node = text_->find(table_, key);
  const auto values =
      node ? elements<int>(*node, 3, 3,
                           [&](const toml::node& item) { return whole_number(item, low, high); })
           : std::nullopt;
  if (!values)
    fail(key, "three " + described(low, high, true) + ", as [x, y, z]");
  return {(*values)[0], (*values)[1], (*values)[2]};
}

std::array<bool, 3> CaseTable::flags(const std::string& key, std::array<bool, 3> absent) const {
  const toml::node* node = text_->find(table_, key);
  if (!node)
    return absent;
  const auto values =
      elements<bool>(*node, 3, 3, [](const toml::node& item) -> std::optional<bool> {
        if (const auto* flag = item.as_boolean())
          return flag->get();
        return {};
      });
  if (!values)
    fail(key, "three of true or false, as [x, y, z]");
  return {(*values)[0], (*values)[1], (*values)[2]};
}

std::vector<double> CaseTable::numbers(const std::string& key, std::size_t least, NumberRange range,
                                       std::string_view unit) const {
  const toml::node* node = text_->find(table_, key);
  auto values =
      node ? elements<double>(*node, least, std::numeric_limits<std::size_t>::max(),
                              [&](const toml::node& item) { return finite_number(item, range); })
           : std::nullopt;
  if (!values)
    fail(key, fmt::format("an array of {} or more {}", least, described(range, unit, true)));
  return std::move(*values);
}

std::string CaseTable::word(const std::string& key, const std::vector<std::string>& allowed) const {
  const toml::node* node = text_->find(table_, key);
  const bool is_text = node && node->is_string();
  const std::string found = is_text ? node->as_string()->get() : std::string();
  if (is_text && std::find(allowed.begin(), allowed.end(), found) != allowed.end())
    return found;
  std::string must_be = "one of";
  for (const std::string& name : allowed)
    must_be += (&name == &allowed.front() ? " \"" : ", \"") + name + '"';
  if (const std::string hint = is_text ? name_hint(found, allowed) : std::string();
      hint.starts_with("did you mean"))
    must_be += "; " + hint;
  fail(key, must_be);
}

std::string CaseTable::word(const std::string& key, const std::string& absent,
                            const std::vector<std::string>& allowed) const {
  return has(key) ? word(key, allowed) : absent;
}

CaseFile::CaseFile(std::unique_ptr<CaseText> text) : text_(std::move(text)) {}
CaseFile::CaseFile(CaseFile&&) noexcept = default;
CaseFile& CaseFile::operator=(CaseFile&&) noexcept = default;
CaseFile::~CaseFile() = default;

CaseFile CaseFile::read(const std::string& path, MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  constexpr std::size_t largest = std::size_t{64} << 20;
  ReadResult result;
  if (rank == 0) {
    result = read_whole(path);
    if (result.content.size() > largest)
      result = {{}, "larger than 64 MiB"};
  }
  broadcast(result.failure, comm);
  if (!result.failure.empty())
    throw ConfigError(fmt::format("case file \"{}\" cannot be read: {}", path, result.failure));
  broadcast(result.content, comm);
  return parse(result.content, path);
}

CaseFile CaseFile::parse(const std::string& text, const std::string& name) {
  auto parsed = std::make_unique<CaseText>();
  parsed->name = name;
  try {
    parsed->root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    throw ConfigError(
        fmt::format("{}: line {}, column {}: {}", name, at.line, at.column, error.description()));
  }
  parsed->tables.push_back({&parsed->root, "", {}});
  return CaseFile(std::move(parsed));
}

bool CaseFile::has(const std::string& table) const {
  return text_->find(0, table) != nullptr;
}

CaseTable CaseFile::table(const std::string& name) {
  const toml::node* node = text_->find(0, name);
  if (node && !node->is_table())
    throw ConfigError(
        fmt::format("{}: {} = {}: must be a table [{}]", text_->name, name, written(*node), name));
  return {*text_, text_->add(node ? node->as_table() : nullptr, "[" + name + "]")};
}

std::vector<CaseTable> CaseFile::tables(const std::string& name) {
  const toml::node* node = text_->find(0, name);
  std::vector<CaseTable> found;
  if (!node)
    return found;
  if (!node->is_array_of_tables())
    throw ConfigError(
        fmt::format("{}: {} = {}: must be tables [[{}]]", text_->name, name, written(*node), name));
  for (const toml::node& item : *node->as_array()) {
    const toml::table& content = *item.as_table();
    std::string label = fmt::format("[[{}]] {}", name, found.size() + 1);
    if (const auto title = content["name"].value<std::string>())
      label += fmt::format(" \"{}\"", *title);
    found.push_back({*text_, text_->add(&content, std::move(label))});
  }
  return found;
}

void CaseFile::skip(const std::string& table) {
  text_->find(0, table);
}

void CaseFile::finish() const {
  std::string leftovers;
  for (std::size_t table = 0; table < text_->tables.size(); ++table)
    collect_leftovers(*text_, table, leftovers);
  if (!leftovers.empty())
    throw ConfigError(leftovers);
}

const std::string& CaseFile::name() const {
  return text_->name;
}

} // namespace granflux::cfd
