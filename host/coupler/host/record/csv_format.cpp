// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdlib>

#include <fmt/format.h>

#include "coupler/base/csv_cell.hpp"
#include "coupler/base/utc_text.hpp"
#include "coupler/host/core/value_text.hpp"
#include "coupler/host/record/record_format.hpp"

namespace coupler::host {
namespace {

using record::Moment;
using record::Nanoseconds;

double seconds(Nanoseconds time) { return std::chrono::duration<double>(time).count(); }

/// A text of the device is no formula; a number may begin with a sign.
std::string cell(std::string_view text) {
  char* end = nullptr;
  const std::string number(text);
  std::strtod(number.c_str(), &end);
  const bool is_number = end == number.c_str() + number.size();
  return csv_cell(!is_number && would_be_run(text) ? fmt::format("'{}", text) : number);
}

std::string row(Moment at, std::string_view point, std::string_view value, std::string_view quality,
                std::string_view uncertainty = {}) {
  return fmt::format("{:.6f},{},{},{},{},{}\n", seconds(at.since_start), utc_text(at.wall), point,
                     cell(value), cell(quality), uncertainty);
}

/// Lines that do not belong to a point have their words in the column of the quality.
class CsvFormat final : public RecordFormat {
 public:
  std::string head(const record::Head& /*head*/, Moment /*at*/) const override {
    return "t,utc,point,value,quality,u\n";
  }
  std::string value(Moment at, const Point& point, Span<const std::uint16_t> registers,
                    Nanoseconds uncertainty, PointQuality::State quality) const override {
    const bool is_good = quality == PointQuality::State::good;
    return row(at, point.name, is_good ? format_value(registers.data(), point) : std::string(),
               to_string(quality), fmt::format("{:.6f}", seconds(uncertainty)));
  }
  std::string no_value(Moment at, const Point& point, PointQuality::State quality,
                       unsigned exception) const override {
    return row(at, point.name, {},
               exception == 0 ? std::string(to_string(quality))
                              : fmt::format("{}: exception {:02X}", to_string(quality), exception));
  }
  std::string online(Moment at, std::optional<bool>) const override { return row(at, {}, {}, "online"); }
  std::string lost(Moment at, std::string_view why) const override {
    return row(at, {}, {}, fmt::format("lost: {}", why));
  }
  std::string clock(Moment at, Nanoseconds set_by) const override {
    return row(at, {}, {}, fmt::format("the clock was set by {:.3f} s", seconds(set_by)));
  }
  std::string missing(Moment at, Nanoseconds since, std::string_view why) const override {
    return row(at, {}, {}, fmt::format("missing since {:.6f}: {}", seconds(since), why));
  }
  std::string end(Moment at) const override { return row(at, {}, {}, "end"); }
};

}  // namespace

std::unique_ptr<RecordFormat> csv_format() { return std::make_unique<CsvFormat>(); }

}  // namespace coupler::host
