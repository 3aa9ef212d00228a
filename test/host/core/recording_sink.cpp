// SPDX-License-Identifier: Apache-2.0
#include "test/host/core/recording_sink.hpp"

namespace coupler::host::test {

RecordingSink::RecordingSink(const Map& map) : map_(map) {}
RecordingSink::~RecordingSink() = default;

void RecordingSink::on_bits(const ReadSpan& span, Span<const std::uint8_t> bits, Time) {
  for (const auto i : span.points)
    values[std::string(map_.points[i].name)].push_back(
        bits[read_range(map_.points[i]).start() - std::size_t{span.range.start()}]);
}

void RecordingSink::on_registers(const ReadSpan& span, Span<const std::uint16_t> registers, Time) {
  for (const auto i : span.points)
    values[std::string(map_.points[i].name)].push_back(
        registers[read_range(map_.points[i]).start() - std::size_t{span.range.start()}]);
}

int RecordingSink::reported(const std::string& text) const {
  int count = 0;
  for (const std::string& report : reports) count += report.find(text) != std::string::npos ? 1 : 0;
  return count;
}

}  // namespace coupler::host::test
