// SPDX-License-Identifier: Apache-2.0
// The names that people know types by, from C, from PLCs and from registers' lists. IEC 61131-3's own names
// hold before all others: INT has 16 bits and CHAR is a character.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/codec/format.hpp"

namespace coupler::codec {

/// Another name of a type, which says its width wherever it is used.
struct TypeName {
  std::string_view name;
  Type type;
};
Span<const TypeName> other_type_names();

/// A name that has one width in some manuals and another one in others.
struct AmbiguousTypeName {
  std::string_view name;
  Type one;
  Type other;
};
Span<const AmbiguousTypeName> ambiguous_type_names();

/// How names are compared: without case, blanks, '-' and '_'. "Unsigned Int" is "unsignedint".
std::string folded_type_name(std::string_view name);

/// The type of that name, IEC 61131-3's or another one.
std::optional<Type> parse_type(std::string_view name);

/// The name is IEC 61131-3's, in any case.
bool is_iec_name(std::string_view name);

/// nullptr if the name has one meaning, or none.
const AmbiguousTypeName* find_ambiguous_type(std::string_view name);

/// All names of the type, IEC 61131-3's first.
std::vector<std::string_view> names_of(Type type);

}  // namespace coupler::codec
