// SPDX-License-Identifier: Apache-2.0
#include "coupler/codec/type_name.hpp"

#include <algorithm>

namespace coupler::codec {
namespace {

/// A row is here only if every manual that uses the name means that width. "double" alone is a
/// double-precision number everywhere; "single", "short" and "long long" have one width in C, C#, Pascal and
/// OPC servers.
constexpr TypeName others[] = {
    {"bit", Type::BOOL},
    {"boolean", Type::BOOL},
    // Bit strings. bitfieldN is SunSpec's.
    {"word16", Type::WORD},
    {"bitfield16", Type::WORD},
    {"bitmap16", Type::WORD},
    {"word32", Type::DWORD},
    {"doubleword", Type::DWORD},
    {"bitfield32", Type::DWORD},
    {"bitmap32", Type::DWORD},
    {"word64", Type::LWORD},
    {"qword", Type::LWORD},
    {"bitfield64", Type::LWORD},
    // Signed numbers. sunssf is SunSpec's.
    {"int8", Type::SINT},
    {"int8_t", Type::SINT},
    {"i8", Type::SINT},
    {"s8", Type::SINT},
    {"sint8", Type::SINT},
    {"int8s", Type::SINT},
    {"signed8", Type::SINT},
    {"integer8", Type::SINT},
    {"sbyte", Type::SINT},
    {"int16", Type::INT},
    {"int16_t", Type::INT},
    {"i16", Type::INT},
    {"s16", Type::INT},
    {"sint16", Type::INT},
    {"int16s", Type::INT},
    {"signed16", Type::INT},
    {"integer16", Type::INT},
    {"short", Type::INT},
    {"sunssf", Type::INT},
    {"int32", Type::DINT},
    {"int32_t", Type::DINT},
    {"i32", Type::DINT},
    {"s32", Type::DINT},
    {"sint32", Type::DINT},
    {"int32s", Type::DINT},
    {"signed32", Type::DINT},
    {"integer32", Type::DINT},
    {"doubleint", Type::DINT},
    {"int64", Type::LINT},
    {"int64_t", Type::LINT},
    {"i64", Type::LINT},
    {"s64", Type::LINT},
    {"sint64", Type::LINT},
    {"int64s", Type::LINT},
    {"signed64", Type::LINT},
    {"integer64", Type::LINT},
    {"longlong", Type::LINT},
    // Unsigned numbers. intNu is Schneider's, unsignedN CANopen's, enumN and accN SunSpec's.
    {"uint8", Type::USINT},
    {"uint8_t", Type::USINT},
    {"u8", Type::USINT},
    {"ui8", Type::USINT},
    {"int8u", Type::USINT},
    {"unsigned8", Type::USINT},
    {"uint16", Type::UINT},
    {"uint16_t", Type::UINT},
    {"u16", Type::UINT},
    {"ui16", Type::UINT},
    {"int16u", Type::UINT},
    {"unsigned16", Type::UINT},
    {"ushort", Type::UINT},
    {"unsignedshort", Type::UINT},
    {"enum16", Type::UINT},
    {"acc16", Type::UINT},
    {"uint32", Type::UDINT},
    {"uint32_t", Type::UDINT},
    {"u32", Type::UDINT},
    {"ui32", Type::UDINT},
    {"int32u", Type::UDINT},
    {"unsigned32", Type::UDINT},
    {"enum32", Type::UDINT},
    {"acc32", Type::UDINT},
    {"uint64", Type::ULINT},
    {"uint64_t", Type::ULINT},
    {"u64", Type::ULINT},
    {"ui64", Type::ULINT},
    {"int64u", Type::ULINT},
    {"unsigned64", Type::ULINT},
    {"ulonglong", Type::ULINT},
    {"unsignedlonglong", Type::ULINT},
    {"acc64", Type::ULINT},
    // Floating-point numbers.
    {"float", Type::REAL},
    {"float32", Type::REAL},
    {"f32", Type::REAL},
    {"fp32", Type::REAL},
    {"real32", Type::REAL},
    {"single", Type::REAL},
    {"double", Type::LREAL},
    {"float64", Type::LREAL},
    {"f64", Type::LREAL},
    {"fp64", Type::LREAL},
    {"real64", Type::LREAL},
    {"longreal", Type::LREAL},
    // Texts.
    {"str", Type::STRING},
    {"text", Type::STRING},
};

/// LONG is 32 bits in the manuals of Rockwell and of OPC servers and 64 in C, C# and Java; INTEGER is 16 bits
/// in Modicon's and 32 in C's; SHORTINT is Pascal's 8 bits and C's "short int".
constexpr AmbiguousTypeName ambiguous[] = {
    {"integer", Type::INT, Type::DINT},
    {"signed", Type::INT, Type::DINT},
    {"signedint", Type::INT, Type::DINT},
    {"signedinteger", Type::INT, Type::DINT},
    {"unsigned", Type::UINT, Type::UDINT},
    {"unsignedint", Type::UINT, Type::UDINT},
    {"unsignedinteger", Type::UINT, Type::UDINT},
    {"uinteger", Type::UINT, Type::UDINT},
    {"enum", Type::UINT, Type::UDINT},
    {"long", Type::DINT, Type::LINT},
    {"longint", Type::DINT, Type::LINT},
    {"longinteger", Type::DINT, Type::LINT},
    {"slong", Type::DINT, Type::LINT},
    {"signedlong", Type::DINT, Type::LINT},
    {"ulong", Type::UDINT, Type::ULINT},
    {"unsignedlong", Type::UDINT, Type::ULINT},
    {"longword", Type::DWORD, Type::LWORD},
    {"shortint", Type::SINT, Type::INT},
    {"bitmap", Type::WORD, Type::DWORD},
    {"bitfield", Type::WORD, Type::DWORD},
};

std::optional<Type> iec_type(const std::string& folded) {
  for (const Word<Type>& each : enumeration_of<Type>.words)
    if (folded_type_name(each.word) == folded) return each.value;
  return std::nullopt;
}

}  // namespace

Span<const TypeName> other_type_names() { return others; }

Span<const AmbiguousTypeName> ambiguous_type_names() { return ambiguous; }

std::string folded_type_name(std::string_view name) {
  std::string result;
  for (const char c : name)
    if (c != ' ' && c != '-' && c != '_')
      result += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

std::optional<Type> parse_type(std::string_view name) {
  const std::string folded = folded_type_name(name);
  if (const auto type = iec_type(folded)) return type;
  for (const TypeName& other : others)
    if (folded_type_name(other.name) == folded) return other.type;
  return std::nullopt;
}

bool is_iec_name(std::string_view name) {
  const auto type = iec_type(folded_type_name(name));
  return type && to_string(*type).size() == name.size();
}

const AmbiguousTypeName* find_ambiguous_type(std::string_view name) {
  const std::string folded = folded_type_name(name);
  const auto* found = std::find_if(std::begin(ambiguous), std::end(ambiguous),
                                   [&](const AmbiguousTypeName& each) { return each.name == folded; });
  return found == std::end(ambiguous) ? nullptr : found;
}

std::vector<std::string_view> names_of(Type type) {
  std::vector<std::string_view> names{to_string(type)};
  for (const TypeName& other : others)
    if (other.type == type) names.push_back(other.name);
  return names;
}

}  // namespace coupler::codec
