// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/base/span.hpp"
#include "coupler/codec/format.hpp"

namespace coupler::codec {

/// How many bytes of UTF-8 the text of a STRING has at most.
constexpr std::size_t max_text_size(const Format& format) {
  return format.encoding == Encoding::latin1 ? std::size_t{2} * format.length : format.length;
}

/// Writes the text of a STRING, as UTF-8, and returns its size: at most max_text_size() bytes, no NUL behind
/// them. It ends at the first NUL or at `format.length` bytes. Bytes that the encoding does not know become
/// '?' (ascii) or stay as they are (utf-8). No heap.
std::size_t decode_text(const std::uint16_t* registers, const Format& format, char* text);

/// The same, but `text` is always UTF-8: bytes that are not are escaped, as "\xff". `text` keeps its capacity
/// from call to call.
void decode_text(const std::uint16_t* registers, const Format& format, std::string& text);

/// Returns the first byte of a STRING, up to its end, that its encoding does not know.
std::optional<std::uint8_t> first_unknown_byte(const std::uint16_t* registers, const Format& format);

/// Returns whether a text is UTF-8 (RFC 3629) without control characters: those below U+0020, and U+007F to
/// U+009F.
bool is_plain_text(std::string_view text);

/// Why a text does not fit into a STRING.
enum class TextError : std::uint8_t {
  none,
  too_long,       ///< more than `format.length` bytes once encoded
  not_encodable,  ///< a character that ascii or latin-1 does not have, or not UTF-8 at all
  has_nul         ///< a NUL character, which would end it for those who read it
};

/// Writes UTF-8 `text`, padded with NUL, into codec::registers(format) registers; nothing is written on an
/// error. No heap.
TextError encode_text(std::string_view text, const Format& format, std::uint16_t* registers);

}  // namespace coupler::codec
