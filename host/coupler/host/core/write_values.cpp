// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/write_values.hpp"

namespace coupler::host {
namespace {

Result<> write_batch(const WriteBatch& batch, const Map& map, Transport& transport,
                     std::vector<RefusedValue>& refused) {
  Result<> answer = exchange(batch, map, transport);
  const ExceptionReply* exception = answer ? nullptr : exception_in(answer.error());
  if (exception == nullptr) return answer;
  if (batch.writes().size() == 1) {
    refused.push_back({batch.writes().front().point, exception->code});
    return {};
  }
  for (const Write& write : batch.writes()) {  // one of them may be to blame, or their being together
    WriteBatch alone(map);
    alone.add(write);
    if (auto one = write_batch(alone, map, transport, refused); !one) return one;
  }
  return {};
}

std::optional<Write> safe_value(const Map& map, std::uint32_t index) {
  const Point& point = map.points[index];
  if (!is_writable(point) || point.safe == Safe::hold) return std::nullopt;
  if (point.table != Table::coils) {
    if (point.safe == Safe::on) return make_write(map, index, point.safe_value);
    return is_analogue(point) ? std::optional(make_write(map, index, {})) : std::nullopt;
  }
  Write write = make_write(map, index, point.safe_value);
  if (point.safe == Safe::on && point.safe_value.empty())
    for (std::size_t i = 0; i < point.count; ++i) write.set_bit(i);
  return write;
}

}  // namespace

Result<> exchange(const WriteBatch& batch, const Map& map, Transport& transport) {
  std::uint16_t before = 0;
  if (batch.needs_read()) {
    const Point& point = map.points[batch.writes().front().point];
    if (auto read = transport.read_registers(point.table, read_range(point), &before); !read) return read;
  }
  const modbus::WriteRequest request = batch.request(before);
  if (auto sent = transport.send(request); !sent) return sent;
  return transport.receive(request);
}

Result<std::vector<RefusedValue>> write_values(const std::vector<Write>& writes, const Map& map,
                                               Transport& transport) {
  std::vector<RefusedValue> refused;
  WriteBatch batch(map);
  for (const Write& write : writes) {
    if (batch.add(write)) continue;
    if (auto written = write_batch(batch, map, transport, refused); !written)
      return tl::make_unexpected(written.error());
    batch.clear();
    batch.add(write);
  }
  if (batch.empty()) return refused;
  if (auto written = write_batch(batch, map, transport, refused); !written)
    return tl::make_unexpected(written.error());
  return refused;
}

std::vector<Write> safe_values(const Map& map) {
  std::vector<Write> values;
  for (std::uint32_t i = 0; i < map.points.size(); ++i)
    if (const auto value = safe_value(map, i)) values.push_back(*value);
  return values;
}

}  // namespace coupler::host
