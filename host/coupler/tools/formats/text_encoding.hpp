// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace coupler::formats {

/// The encoding in which a text was written.
enum class WrittenIn { utf8, utf16, windows_1252 };

struct Utf8 {
  std::string text;
  WrittenIn from = WrittenIn::utf8;
};

/// The bytes of a file as UTF-8. With a byte order mark of UTF-16 it is that; what is no valid UTF-8 is taken
/// for Windows-1252, which is Latin-1 with characters in place of C1's controls: what Excel saves as CSV.
Utf8 to_utf8(std::string_view bytes);

}  // namespace coupler::formats
