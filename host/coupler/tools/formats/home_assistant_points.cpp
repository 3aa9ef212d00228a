// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/home_assistant_points.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {

using loader::Entry;
using loader::Problems;
using loader::shown;

namespace {

/// Reads a number that YAML 1.1, which Home Assistant uses, takes for octal: 010, but neither "010" in quotes
/// nor 08.
std::optional<unsigned> octal(const Entry& given, Problems& problems) {
  constexpr std::size_t longest = 9;
  const std::string& text = given.text;
  if (given.quoted || text.size() < 2 || text.size() > longest || text[0] != '0' ||
      text.find_first_not_of("01234567") != std::string::npos)
    return std::nullopt;
  unsigned number = 0;
  for (const char digit : text) number = number * 8 + static_cast<unsigned>(digit - '0');
  problems.warning(
      given.at,
      fmt::format("{} is an octal number in Home Assistant's YAML, so it is read as {}", text, number),
      fmt::format("write {}, or the number that is meant without a zero before it", number));
  return number;
}

unsigned read_place(const FoundPoint& point) { return point.read_address.value_or(point.address); }

constexpr std::string_view type_keys[] = {"type", "order", "length", "count", "offset", "bit"};

bool is_type_key(std::string_view key) {
  return std::find(std::begin(type_keys), std::end(type_keys), key) != std::end(type_keys);
}

bool is_same(const Entry* a, const Entry* b) {
  if (a == nullptr || b == nullptr) return a == b;
  return a->text == b->text && a->children.size() == b->children.size() &&
         std::equal(a->children.begin(), a->children.end(), b->children.begin(),
                    [](const Entry& x, const Entry& y) { return x.key == y.key && is_same(&x, &y); });
}

/// The two read the same bits and make the same number of them.
bool have_same_value(const FoundPoint& a, const FoundPoint& b) {
  return a.use != PointUse::write && b.use != PointUse::write && read_place(a) == read_place(b) &&
         a.size == b.size && a.mask == b.mask &&
         std::all_of(std::begin(type_keys), std::end(type_keys), [&](std::string_view key) {
           return is_same(loader::child(a.entry, key), loader::child(b.entry, key));
         });
}

/// Gives the point that stays what it may take from the one that goes. Returns what the warning says of it.
std::string merge(FoundPoint& stays, const FoundPoint& goes) {
  std::vector<std::string> taken;
  std::vector<std::string> lost;
  const bool same_value = have_same_value(stays, goes);
  const bool same_scale =
      same_value && is_same(loader::child(stays.entry, "scale"), loader::child(goes.entry, "scale"));
  for (const Entry& key : goes.entry.children) {
    const Entry* other = loader::child(stays.entry, key.key);
    if (is_type_key(key.key) || is_same(other, &key)) continue;
    const bool is_free = other == nullptr && key.key != "scale";
    // Units are of the scaled value, and names of one that has no scale.
    const bool is_of_scale = key.key == "units" || key.key == "values";
    const bool fits = is_of_scale ? same_scale : same_value;
    (is_free && fits ? taken : lost).push_back(fmt::format("'{}'", key.key));
    if (is_free && fits) stays.entry.children.push_back(key);
  }
  if (same_value && !same_scale && loader::child(goes.entry, "scale") == nullptr)
    lost.emplace_back("that it has no 'scale'");
  if (!same_value && stays.use != PointUse::write) lost.emplace_back("its type or size");
  const bool is_faster = goes.interval > 0 && (stays.interval == 0 || goes.interval < stays.interval);
  if (is_faster && goes.use != PointUse::write && stays.use != PointUse::write) {
    stays.interval = goes.interval;
    taken.push_back(fmt::format("'scan_interval: {}'", goes.interval));
  }
  std::string text;
  if (!taken.empty())
    text += fmt::format("; {} takes over {}", shown(stays.entry.key), fmt::join(taken, ", "));
  if (!lost.empty()) text += fmt::format("; lost: {}", fmt::join(lost, ", "));
  return text;
}

}  // namespace

std::optional<unsigned> whole_of(const Entry& given, unsigned most, Problems& problems) {
  if (given.kind != Entry::Kind::scalar) return std::nullopt;
  std::optional<std::uint64_t> number = octal(given, problems);
  if (!number) number = loader::parse_unsigned(given.text);
  if (!number || *number > most) return std::nullopt;
  return static_cast<unsigned>(*number);
}

const Entry* Settings::find(std::string_view key) {
  used_.emplace(key);
  const Entry* entry = loader::child(given_, key);
  return entry == nullptr || entry->kind == Entry::Kind::null ? nullptr : entry;
}

std::string Settings::text(std::string_view key, std::string_view fallback) {
  const Entry* entry = find(key);
  if (entry == nullptr) return std::string(fallback);
  if (entry->kind == Entry::Kind::scalar) return entry->text;
  problems_.error(entry->at, fmt::format("'{}' is not a single value", key), "write one value");
  return std::string(fallback);
}

std::optional<unsigned> Settings::whole(std::string_view key, unsigned most) {
  const Entry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  if (const auto number = whole_of(*entry, most, problems_)) return number;
  problems_.error(entry->at, fmt::format("'{}' is not a whole number from 0 to {}", key, most),
                  "write such a number");
  return std::nullopt;
}

std::optional<double> Settings::number(std::string_view key) {
  const Entry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  if (const auto whole = octal(*entry, problems_)) return *whole;
  const auto number = loader::parse_number(entry->text);
  if (entry->kind == Entry::Kind::scalar && number) return number;
  problems_.error(entry->at, fmt::format("'{}' is not a number", key), "write a number");
  return std::nullopt;
}

bool Settings::flag(std::string_view key) {
  const Entry* entry = find(key);
  if (entry == nullptr) return false;
  const auto value = loader::parse_boolean(entry->text);
  if (entry->kind == Entry::Kind::scalar && value) return *value;
  problems_.error(entry->at, fmt::format("'{}' is neither true nor false", key), "write true or false");
  return false;
}

void Settings::report_rest() const {
  for (const Entry& entry : given_.children)
    if (used_.find(entry.key) == used_.end())
      problems_.warning(entry.key_at,
                        fmt::format("{} is not carried over: a map has no key for it", shown(entry.key)),
                        "no action is needed if Home Assistant itself does it");
}

FoundPoint* UnitPoints::owner_of(const Owners& owners, const FoundPoint& point, unsigned address) {
  for (unsigned i = 0; i < point.size; ++i)
    if (const auto found = owners.find({point.table, address + i}); found != owners.end())
      for (const Owner& owner : found->second)
        if ((owner.mask & point.mask) != 0) return &points_[owner.point];
  return nullptr;
}

void UnitPoints::claim(Owners& owners, const FoundPoint& point, unsigned address) const {
  for (unsigned i = 0; i < point.size; ++i)
    owners[{point.table, address + i}].push_back({point.mask, points_.size()});
}

void UnitPoints::add(FoundPoint point, Problems& problems) {
  if (std::max(point.address, read_place(point)) + point.size > 65536)
    problems.error(point.entry.key_at,
                   fmt::format("{} does not end before address 65536", shown(point.entry.key)),
                   "give it a smaller address");
  else
    added_.push_back(std::move(point));
}

void UnitPoints::settle(Problems& problems) {
  const auto rank = [](const FoundPoint& point) {
    const loader::Position at = point.entry.key_at;
    return point.use == PointUse::read ? std::tuple(1, at.line, at.column) : std::tuple(0, 0, 0);
  };
  std::stable_sort(added_.begin(), added_.end(),
                   [&](const FoundPoint& a, const FoundPoint& b) { return rank(a) < rank(b); });
  for (FoundPoint& point : std::exchange(added_, {})) give_place(std::move(point), problems);
}

void UnitPoints::give_place(FoundPoint point, Problems& problems) {
  const unsigned read_at = read_place(point);
  FoundPoint* owner = point.use == PointUse::write ? nullptr : owner_of(read_, point, read_at);
  if (owner == nullptr && point.use != PointUse::read) owner = owner_of(written_, point, point.address);
  if (owner != nullptr) {
    const int line = owner->entry.key_at.line;
    problems.warning(point.entry.key_at,
                     fmt::format("{} is at the same place as {} in line {}, so it is left out{}",
                                 shown(point.entry.key), shown(owner->entry.key), line, merge(*owner, point)),
                     "a map has one point for a place; rename it or change its type in the map");
    return;
  }
  if (point.use != PointUse::write) claim(read_, point, read_at);
  if (point.use != PointUse::read) claim(written_, point, point.address);
  points_.push_back(std::move(point));
}

std::vector<Entry> UnitPoints::take(loader::Position at) {
  unsigned fastest = 0;
  for (const FoundPoint& point : points_)
    if (point.interval > 0 && point.use != PointUse::write)
      fastest = fastest == 0 ? point.interval : std::min(fastest, point.interval);
  const auto rate = [](unsigned interval) { return fmt::format("{:.4g}", 1.0 / interval); };
  Entry mapping = section("mapping", at);
  for (FoundPoint& point : points_) {
    std::vector<Entry>& keys = point.entry.children;
    const loader::Position place = point.entry.key_at;
    keys.insert(keys.begin(), scalar("address", fmt::to_string(point.address), place));
    if (is_writable(point.table) && point.use != PointUse::both)
      keys.push_back(scalar("access", point.use == PointUse::read ? "read" : "write", place));
    if (point.read_address && *point.read_address != point.address)
      keys.push_back(scalar("read_address", fmt::to_string(*point.read_address), place));
    if (point.write_multiple && is_writable(point.table) && point.use != PointUse::read)
      keys.push_back(scalar("write_function", "multiple", place));
    if (point.interval > fastest && point.use != PointUse::write)
      keys.push_back(scalar("rate", rate(point.interval), place));
    make_section(mapping, to_string(point.table), place).children.push_back(std::move(point.entry));
  }
  std::vector<Entry> out;
  if (fastest > 0) out.push_back(scalar("rate", rate(fastest), at));
  out.push_back(std::move(mapping));
  return out;
}

}  // namespace coupler::formats
