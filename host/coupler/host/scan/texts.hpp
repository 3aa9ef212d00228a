// SPDX-License-Identifier: Apache-2.0
// Texts in a device's registers.
#pragma once

#include <string>
#include <vector>

#include "coupler/codec/format.hpp"
#include "coupler/host/scan/table_scan.hpp"

namespace coupler::scan {

/// A place that holds a text of ASCII.
struct FoundText {
  Table table;
  modbus::Range range;
  codec::Format format;  ///< STRING, with the likelier order
  std::string text;
  std::string other;  ///< what it reads as in the other order, if that is as likely
};

/// The texts of at least six characters, most of them letters, digits and blanks, by table and address. A
/// text ends at a byte that is not printable.
std::vector<FoundText> find_texts(const std::vector<TableFindings>& tables);

/// A point as a map has it: "{address: 40, type: STRING, length: 12, order: AB}".
std::string point_text(const FoundText& text);

/// Returns the text, and the text in the other byte order if that may be the right one.
std::string value_text(const FoundText& text);

}  // namespace coupler::scan
