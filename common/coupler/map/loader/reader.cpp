// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/reader.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "coupler/map/loader/colon_slip.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/loader/synonyms.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::loader {
namespace {

std::string_view canonical(const Key& key) { return key.same_as.empty() ? key.name : key.same_as; }

bool is_bare(const Entry& value) { return value.kind == Entry::Kind::scalar && !value.quoted; }

/// "UTF_8" and "utf-8" are the same word in the files of ros-modbus-device-driver, not in this project's
/// keys.
std::string folded(std::string_view word, Owner owner) {
  std::string result(word);
  if (owner == Owner::project) return result;
  result.erase(std::remove_if(result.begin(), result.end(), [](char c) { return c == '-' || c == '_'; }),
               result.end());
  return lower(result);
}

std::string range_text(const Key& key, std::string_view unit) {
  const bool has_least = key.least != std::numeric_limits<double>::lowest();
  return has_least ? fmt::format(" from {} to {}{}", key.least, key.most, unit) : std::string();
}

bool fits(const std::string& text, const Key& key) {
  const auto value = parse_duration(text);
  const double in_seconds = value ? std::chrono::duration<double>(*value).count() : -1;
  return in_seconds >= key.least && in_seconds <= key.most;
}

/// "500" -> "'500ms' or '500s'", "3 sec" -> "'3s'", as far as they are good values of the key. Empty: nothing
/// is.
std::string mended_duration(std::string_view text, const Key& key) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 15> spellings{{{"us", "us"},
                                                                                     {"µs", "us"},
                                                                                     {"ms", "ms"},
                                                                                     {"msec", "ms"},
                                                                                     {"millisecond", "ms"},
                                                                                     {"milliseconds", "ms"},
                                                                                     {"s", "s"},
                                                                                     {"sec", "s"},
                                                                                     {"secs", "s"},
                                                                                     {"second", "s"},
                                                                                     {"seconds", "s"},
                                                                                     {"m", "min"},
                                                                                     {"min", "min"},
                                                                                     {"minute", "min"},
                                                                                     {"minutes", "min"}}};
  const std::size_t end = std::min(text.find_first_not_of("0123456789."), text.size());
  const std::string number(text.substr(0, end));
  if (!parse_number(number)) return {};
  const std::size_t at = text.find_first_not_of(' ', end);
  const std::string unit = at == std::string_view::npos ? std::string() : lower(text.substr(at));
  std::vector<std::string> good;
  const auto add = [&](const std::string& duration) {
    if (fits(duration, key)) good.push_back('\'' + duration + '\'');
  };
  if (unit.empty())
    for (const std::string_view each : {"ms", "s"}) add(number + std::string(each));
  for (const auto& [spelling, right] : spellings)
    if (unit == spelling) add(number + std::string(right));
  return fmt::to_string(fmt::join(good, " or "));
}

}  // namespace

Reader::Reader(const Entry& map, Section section, const Context& context)
    : section_(section), context_(context) {
  if (map.kind != Entry::Kind::map) return;
  for (const Entry& entry : map.children) check_key(entry);
}

void Reader::check_key(const Entry& entry) {
  const Key* key = find_key(entry.key, section_);
  if (key == nullptr) return unknown(entry);
  const Field* first = field(canonical(*key));
  if (first != nullptr)
    return context_.problems.error(
        entry.key_at,
        fmt::format("'{}' is given twice, first in line {}", key->name, first->value->key_at.line),
        "keep one of the two", {{first->value->key_at, "the first is here"}});
  fields_.push_back({key, &entry});
}

const Reader::Field* Reader::field(std::string_view key) const {
  const auto found =
      std::find_if(fields_.begin(), fields_.end(), [&](const Field& f) { return canonical(*f.key) == key; });
  return found == fields_.end() ? nullptr : &*found;
}

const Entry* Reader::find(std::string_view key) const {
  assert(find_key(key, section_) != nullptr);
  const Field* found = field(key);
  return found == nullptr ? nullptr : found->value;
}

bool Reader::misspells(std::string_view key) const {
  return std::find(misspelt_.begin(), misspelt_.end(), key) != misspelt_.end();
}

std::string_view Reader::missing() const {
  std::string_view found;
  for (const Key& key : all_keys()) {
    if (!key.required || !overlap(key.sections, section_)) continue;
    if (lacks(key.name)) return key.name;
    if (found.empty() && !has(key.name)) found = key.name;
  }
  return found;
}

std::optional<Reader> Reader::inside(std::string_view key, std::string_view expected) const {
  const Entry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  if (entry->kind == Entry::Kind::map) return Reader(*entry, field(key)->key->inside, context_);
  wrong(key, expected);
  return std::nullopt;
}

void Reader::wrong(std::string_view key, std::string_view expected) const {
  const Field& f = *field(key);
  context_.problems.error(f.value->at,
                          fmt::format("'{}' must be {}, not {}", f.key->name, expected, shown(*f.value)),
                          fmt::format("write it as in '{}: {}'", f.key->name, f.key->example));
}

void Reader::refuse(std::string_view key, std::string what, std::string remedy) const {
  context_.problem(context_.served, field(key)->value->key_at, std::move(what), std::move(remedy));
}

std::optional<std::int64_t> Reader::integer_in_range(std::string_view key) const {
  const Entry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const Key& known = *field(key)->key;
  const auto value = is_bare(*entry) ? parse_integer(entry->text) : std::nullopt;
  if (value && static_cast<double>(*value) >= known.least && static_cast<double>(*value) <= known.most)
    return value;
  wrong(key, "a whole number" + range_text(known, ""));
  return std::nullopt;
}

void Reader::number(std::string_view key, double& out) const {
  const Entry* entry = find(key);
  if (entry == nullptr) return;
  const Key& known = *field(key)->key;
  const auto value = is_bare(*entry) ? parse_number(entry->text) : std::nullopt;
  if (value && *value >= known.least && *value <= known.most) {
    out = *value;
    return;
  }
  const std::chrono::microseconds none{0};
  const auto period = entry->kind == Entry::Kind::scalar ? parse_duration(entry->text).value_or(none) : none;
  if (known.name == "rate" && period > none)
    context_.problems.error(entry->at, fmt::format("'rate' must be a number of Hz, not {}", shown(*entry)),
                            fmt::format("write 'rate: {:.6g}'", 1e6 / static_cast<double>(period.count())));
  else
    wrong(key, "a number" + range_text(known, ""));
}

void Reader::boolean(std::string_view key, bool& out) const {
  const Entry* entry = find(key);
  if (entry == nullptr) return;
  const auto value = is_bare(*entry) ? parse_boolean(entry->text) : std::nullopt;
  if (value)
    out = *value;
  else
    wrong(key, "true or false");
}

void Reader::text(std::string_view key, std::string_view& out) const {
  const Entry* entry = find(key);
  if (entry == nullptr) return;
  if (entry->kind == Entry::Kind::scalar)
    out = context_.map.keep(entry->text);
  else
    wrong(key, "text");
}

std::optional<std::chrono::microseconds> Reader::duration_in_range(std::string_view key) const {
  const Entry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const Key& known = *field(key)->key;
  const bool seconds = known.kind == ValueKind::seconds;
  std::optional<std::chrono::microseconds> value;
  if (entry->kind == Entry::Kind::scalar) {
    const bool bare_number = seconds && !entry->quoted && parse_number(entry->text).has_value();
    value = parse_duration(bare_number ? entry->text + "s" : entry->text);
  }
  const double in_seconds = value ? std::chrono::duration<double>(*value).count() : -1;
  const bool bare = entry->kind == Entry::Kind::scalar && parse_number(entry->text).has_value();
  const bool in_range = in_seconds >= known.least && in_seconds <= known.most;
  // Milliseconds, most likely: no device is waited for that long.
  const bool doubtful = seconds && bare && in_seconds > most_bare_seconds && !context_.served;
  if (in_range && !doubtful) return value;
  std::string expected = fmt::format("a duration{} with its unit (us, ms, s, min)", range_text(known, " s"));
  if (seconds) expected += fmt::format(", or a number of seconds up to {}", most_bare_seconds);
  const std::string mended = entry->kind == Entry::Kind::scalar ? mended_duration(entry->text, known) : "";
  if (mended.empty())
    wrong(key, expected);
  else
    context_.problems.error(entry->at,
                            fmt::format("'{}' must be {}, not {}", known.name, expected, shown(*entry)),
                            "write " + mended);
  return std::nullopt;
}

std::string_view Reader::chosen_word(std::string_view key) const {
  const Entry* entry = find(key);
  if (entry == nullptr) return {};
  const Key& known = *field(key)->key;
  const auto choices = words(known.choices);
  const std::string given =
      entry->kind == Entry::Kind::scalar ? folded(entry->text, known.owner) : std::string();
  for (const std::string_view choice : choices)
    if (given == folded(choice, known.owner)) return choice;
  // YAML's other words for on and off, where these are among the choices.
  if (const auto truth = parse_boolean(given))
    for (const std::string_view choice : choices)
      if (parse_boolean(choice) == truth) return choice;
  const std::string_view meant =
      entry->kind == Entry::Kind::scalar ? remedy_for_choice(entry->text, known.name) : std::string_view{};
  context_.problems.error(
      entry->at,
      fmt::format("'{}' must be one of {}, not {}", known.name, fmt::join(choices, ", "), shown(*entry)),
      context_.unless_served(meant.empty()
                                 ? nearest_or(given, choices,
                                              or_update(fmt::format("write one of them, as in '{}: {}'",
                                                                    known.name, known.example)))
                                 : std::string(meant)));
  return {};
}

void Reader::too_fine(std::string_view key) const { wrong(key, "a whole number of milliseconds"); }

std::string shown(const Entry& value) {
  switch (value.kind) {
    case Entry::Kind::null: return "nothing";
    case Entry::Kind::list: return "a list";
    case Entry::Kind::map: return "a map";
    case Entry::Kind::scalar: break;
  }
  return (value.quoted ? "the text " : "") + shown(std::string_view(value.text));
}

bool is_entry_without_colon(const Entry& entry, const Context& context) {
  if (entry.kind != Entry::Kind::scalar || entry.quoted || entry.at.line <= entry.key_at.line) return false;
  auto slip = colon_slip(entry.text);
  if (!slip) return false;
  slip->value = slip->value.substr(0, slip->value.find(' '));  // YAML has joined the lines
  context.problems.error(entry.at, slip->what, slip->remedy());
  return true;
}

bool check_map(const Entry& entry, std::string_view expected, std::string_view remedy,
               const Context& context) {
  if (entry.kind == Entry::Kind::map || entry.kind == Entry::Kind::null) return true;
  if (is_entry_without_colon(entry, context)) return false;
  // A list in lines of its own.
  if (!entry.children.empty() && entry.kind == Entry::Kind::list &&
      entry.children[0].at.line > entry.at.line) {
    context.problems.error(entry.children[0].at, fmt::format("{}, not {}", expected, shown(entry)),
                           fmt::format("leave the '- ' out: {}", remedy));
    return false;
  }
  context.problems.error(entry.at, fmt::format("{}, not {}", expected, shown(entry)), std::string(remedy));
  return false;
}

bool has_only_inherited_keys(const Entry& root) {
  const auto named = [](const Entry& map, Section section, const auto& is) {
    return std::any_of(map.children.begin(), map.children.end(), [&](const Entry& entry) {
      const Key* key = find_key(entry.key, section);
      return key != nullptr && is(*key);
    });
  };
  const auto own = [](const Key& key) { return key.owner == Owner::project; };
  const auto address = [](const Key& key) { return key.name == "address"; };
  if (named(root, Section::map, own)) return false;
  for (const Entry& mapping : root.children) {
    if (mapping.key != "mapping") continue;
    for (const Entry& table : mapping.children)
      for (const Table which : tables) {
        if (table.key != to_string(which)) continue;
        for (const Entry& point : table.children)
          if (named(point, section_of(which), own) ||
              (point.kind != Entry::Kind::scalar && !named(point, section_of(which), address)))
            return false;
      }
  }
  return true;
}

}  // namespace coupler::loader
