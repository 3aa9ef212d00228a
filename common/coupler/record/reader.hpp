// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/record/lines.hpp"

namespace coupler::record {

struct Value {
  std::string point;
  std::vector<std::uint16_t> registers;  ///< as on the wire; of bit tables 0 or 1 each
};
struct NoValue {
  std::string point;
  std::string quality;
  std::uint8_t exception = 0;
};
struct DeviceState {
  bool online = false;
  bool is_foreign = false;  ///< no node of this project, as far as that was asked
};
/// The clock was set, something is missing, the end: nothing of a device.
struct Remark {};

struct Line {
  Moment at;
  std::variant<Value, NoValue, DeviceState, Remark> what;
};

/// Reads a recording, a line at a time.
class Reader {
 public:
  /// `file` names it in errors. Error: it is no recording, or of a newer version.
  static tl::expected<Reader, std::string> open(std::istream& text, std::string file);

  const Head& head() const { return head_; }
  /// The time in the head.
  Moment begin() const { return begin_; }
  /// nullopt: the end; also a last line that is cut short, as a process leaves it that was killed. The error
  /// names the line.
  tl::expected<std::optional<Line>, std::string> next();

 private:
  Reader(std::istream& text, std::string file) : text_(&text), file_(std::move(file)) {}
  std::string error(std::string_view what) const;

  std::istream* text_;
  std::string file_;
  std::size_t number_ = 1;
  Head head_;
  Moment begin_;
};

}  // namespace coupler::record
