// SPDX-License-Identifier: Apache-2.0
// How key_table.cpp writes its rows down.
#pragma once

#include "coupler/base/enumeration.hpp"
#include "coupler/map/loader/keys.hpp"

namespace coupler::loader {

/// A row of the table, built from its essentials and what is added to them.
struct Row : Key {
  constexpr Row within(double from, double to) const {
    Row row = *this;
    row.least = from;
    row.most = to;
    return row;
  }
  template <class E>
  constexpr Row one_of() const {
    return one_of(JoinedWords<E>::text());
  }
  constexpr Row one_of(std::string_view words) const {
    Row row = *this;
    row.choices = words;
    return row;
  }
  /// Beside its words, the value may be a list of on and off.
  constexpr Row or_bits() const {
    Row row = *this;
    row.bits = true;
    return row;
  }
  constexpr Row spells(std::string_view other) const {
    Row row = *this;
    row.same_as = other;
    return row;
  }
  /// The value may be a map with the keys of that section.
  constexpr Row holds(Section section) const {
    Row row = *this;
    row.inside = section;
    return row;
  }
  constexpr Row lists(Section section) const {
    Row row = holds(section);
    row.several = true;
    return row;
  }
  constexpr Row needed() const {
    Row row = *this;
    row.required = true;
    return row;
  }
  constexpr Row needed_with(std::string_view other) const {
    Row row = *this;
    row.required_with = other;
    return row;
  }
  constexpr Row only_for(std::string_view point_types) const {
    Row row = *this;
    row.types = point_types;
    return row;
  }
  constexpr Row otherwise(std::string_view value) const {
    Row row = *this;
    row.fallback = value;
    return row;
  }
};

constexpr Row row(Owner owner, std::string_view name, Section sections, ValueKind kind,
                  std::string_view example, std::string_view summary) {
  Row made;
  made.name = name;
  made.sections = sections;
  made.kind = kind;
  made.example = example;
  made.summary = summary;
  made.owner = owner;
  return made;
}
constexpr Row origin(std::string_view name, Section sections, ValueKind kind, std::string_view example,
                     std::string_view summary) {
  return row(Owner::origin, name, sections, kind, example, summary);
}
constexpr Row project(std::string_view name, Section sections, ValueKind kind, std::string_view example,
                      std::string_view summary) {
  return row(Owner::project, name, sections, kind, example, summary);
}

}  // namespace coupler::loader
