// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/link.hpp"

#include <algorithm>
#include <array>

#include "coupler/map/functions.hpp"
#include "coupler/modbus/file_record.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::host {
namespace {

template <class Taken>
Result<> result(const Taken& taken, modbus::Bytes asked, modbus::Bytes came) {
  if (taken) return {};
  return tl::make_unexpected(error_of(taken.error(), asked, came));
}

}  // namespace

Result<> Link::read(Table table, modbus::Range range, std::uint16_t* values) {
  const modbus::ReadRequest request(read_function(table), range);
  const auto reply = exchange(request.pdu());
  if (!reply) return tl::make_unexpected(reply.error());
  return result(modbus::take_values(request, *reply, values), request.pdu(), *reply);
}

Result<> Link::read_as_mapped(const Map& map, Table table, modbus::Range range, std::uint16_t* values) {
  const modbus::Range extent = plan::read_extent(map, table, range);
  if (extent == range) return read(table, range, values);
  std::array<std::uint16_t, modbus::max_read_bits> all{};
  if (auto answer = read(table, extent, all.data()); !answer) return answer;
  std::copy_n(&all[range.start() - std::size_t{extent.start()}], range.count(), values);
  return {};
}

Result<bool> Link::read_if_mapped(Table table, modbus::Range range, std::uint16_t* values) {
  may_be_refused_ = true;
  const Result<> answer = read(table, range, values);
  may_be_refused_ = false;
  if (answer) return true;
  if (is_unit_refusal(answer.error())) return false;
  return tl::make_unexpected(answer.error());
}

Result<> Link::read_file_record(std::uint16_t file, std::uint16_t record, Span<std::uint16_t> registers) {
  std::array<std::uint8_t, modbus::file_request_size> pdu{};
  modbus::build_file_request({file, record, static_cast<std::uint16_t>(registers.size())}, pdu);
  const auto reply = exchange(pdu);
  if (!reply) return tl::make_unexpected(reply.error());
  return result(modbus::parse_file_reply(*reply, registers), pdu, *reply);
}

Result<modbus::ScheduleReply> Link::schedule(const modbus::ScheduleRequest& request) {
  const auto reply = exchange(request.pdu());
  if (!reply) return tl::make_unexpected(reply.error());
  const auto parsed = modbus::parse_schedule_reply(*reply);
  if (!parsed) return tl::make_unexpected(error_of(parsed.error(), request.pdu(), *reply));
  return *parsed;
}

Result<> Link::ask(const TableRange& place) {
  std::array<std::uint16_t, modbus::max_read_bits> ignored;
  Result<> answer = read(place.table, place.range, ignored.data());
  if (!answer && is_unit_refusal(answer.error())) return {};
  return answer;
}

Result<> Link::keep_alive(const Map& map) {
  const auto found = std::find_if(map.points.begin(), map.points.end(), is_readable);
  const Point* const point = found == map.points.end() ? map.points.begin() : found;
  return map.points.empty() ? ask({Table::coils, modbus::Range::of(0, 1)})
                            : ask({point->table, plan::read_extent(map, *point)});
}

}  // namespace coupler::host
