// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "coupler/host/core/point_quality.hpp"
#include "coupler/map/point.hpp"
#include "coupler/record/lines.hpp"

namespace coupler::host {

/// How a recording is written. Each text is a line, or several, with its newline.
class RecordFormat {
 public:
  virtual ~RecordFormat() = default;
  /// Returns the beginning of a file.
  virtual std::string head(const record::Head& head, record::Moment at) const = 0;
  /// `registers`: those of range(point). `quality`: good, or invalid or fault, then there is no value.
  virtual std::string value(record::Moment at, const Point& point, Span<const std::uint16_t> registers,
                            record::Nanoseconds uncertainty, PointQuality::State quality) const = 0;
  virtual std::string no_value(record::Moment at, const Point& point, PointQuality::State quality,
                               unsigned exception) const = 0;
  virtual std::string online(record::Moment at, std::optional<bool> is_node) const = 0;
  virtual std::string lost(record::Moment at, std::string_view why) const = 0;
  virtual std::string clock(record::Moment at, record::Nanoseconds set_by) const = 0;
  virtual std::string missing(record::Moment at, record::Nanoseconds since, std::string_view why) const = 0;
  virtual std::string end(record::Moment at) const = 0;
};

/// The lines of coupler/record/lines.hpp, which can be played.
std::unique_ptr<RecordFormat> json_format();
/// Comma-separated values (RFC 4180), for spreadsheets.
std::unique_ptr<RecordFormat> csv_format();

}  // namespace coupler::host
