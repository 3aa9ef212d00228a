// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <chrono>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/map/loader/context.hpp"
#include "common/map/loader/entry.hpp"
#include "common/map/loader/keys.hpp"

namespace coupler::loader {

/// One map of the file, read by the table of keys. Whatever is wrong becomes a problem; the getters then
/// leave `out` as it was, as they do when the key is absent.
class Reader {
 public:
  /// Checks the keys: known in this section, given once. `map` must be a map, or nothing.
  Reader(const Entry& map, Section section, Context& context);

  /// The value of the key, or nullptr.
  const Entry* find(std::string_view key) const;
  bool has(std::string_view key) const { return find(key) != nullptr; }
  /// The first required key that is absent; empty if there is none. For sections without a type.
  std::string_view missing() const;
  std::string_view example(std::string_view key) const { return find_key(key, section_)->example; }

  template <class T>
  void integer(std::string_view key, T& out) const {
    if (const auto value = integer_in_range(key)) out = static_cast<T>(*value);
  }
  void number(std::string_view key, double& out) const;
  void boolean(std::string_view key, bool& out) const;
  /// Kept by the map under construction.
  void text(std::string_view key, std::string_view& out) const;
  /// Whole units of Duration.
  template <class Duration>
  void duration(std::string_view key, Duration& out) const {
    const auto value = duration_in_range(key);
    if (!value) return;
    const auto rounded = std::chrono::duration_cast<Duration>(*value);
    if (rounded == *value)
      out = rounded;
    else
      too_fine(key);
  }
  /// `values` stand for the words of Key::choices, in their order.
  template <class E>
  void choice(std::string_view key, std::initializer_list<E> values, E& out) const {
    if (const auto chosen = choice_index(key)) {
      assert(*chosen < values.size());
      out = values.begin()[*chosen];
    }
  }

  /// "'key' is …, not …", with the key's example as the remedy.
  void wrong(std::string_view key, std::string_view expected) const;
  /// The key says something that cannot be used here.
  void ignored(std::string_view key, std::string what, std::string remedy) const;

 private:
  struct Field {
    const Key* key;
    const Entry* value;
  };

  void check_key(const Entry& entry);
  void unknown(const Entry& entry) const;
  const Field* field(std::string_view key) const;
  std::optional<std::int64_t> integer_in_range(std::string_view key) const;
  std::optional<std::chrono::microseconds> duration_in_range(std::string_view key) const;
  std::optional<std::size_t> choice_index(std::string_view key) const;
  void too_fine(std::string_view key) const;

  Section section_;
  Context& context_;
  std::vector<Field> fields_;
};

/// The scalar's text as a message shows it; what else the value is ("a list") if it is no scalar.
std::string shown(const Entry& value);

/// The entry is a map, or nothing at all; otherwise a problem that says what `expected` is.
bool check_map(const Entry& entry, std::string_view expected, std::string_view remedy, Context& context);

/// Nothing in the file is this project's alone, as far as that can be seen without reading it: neither a key
/// nor a point that leaves its address out.
bool may_be_of_the_origin(const Entry& root);

}  // namespace coupler::loader
