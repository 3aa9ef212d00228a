// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/record/record_format.hpp"
#include "coupler/host/record/value_json.hpp"
#include "coupler/json/json_text.hpp"

namespace coupler::host {
namespace {

using record::Moment;
using record::Nanoseconds;

class JsonFormat final : public RecordFormat {
 public:
  std::string head(const record::Head& head, Moment at) const override { return record::head_line(head, at); }
  std::string value(Moment at, const Point& point, Span<const std::uint16_t> registers,
                    Nanoseconds uncertainty, PointQuality::State quality) const override {
    const bool is_good = quality == PointQuality::State::good;
    return record::value_line(
        at, point.name, is_good ? json_text(value_json(registers.data(), point)) : std::string("null"),
        uncertainty, holds_bits(point.table) ? Span<const std::uint16_t>() : registers, to_string(quality));
  }
  std::string no_value(Moment at, const Point& point, PointQuality::State quality,
                       unsigned exception) const override {
    return record::no_value_line(at, point.name, to_string(quality), exception);
  }
  std::string online(Moment at, std::optional<bool> is_node) const override {
    return record::online_line(at, is_node);
  }
  std::string lost(Moment at, std::string_view why) const override { return record::lost_line(at, why); }
  std::string clock(Moment at, Nanoseconds set_by) const override { return record::clock_line(at, set_by); }
  std::string missing(Moment at, Nanoseconds since, std::string_view why) const override {
    return record::missing_line(at, since, why);
  }
  std::string end(Moment at) const override { return record::end_line(at); }
};

}  // namespace

std::unique_ptr<RecordFormat> json_format() { return std::make_unique<JsonFormat>(); }

}  // namespace coupler::host
