// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/write_batch.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "coupler/map/functions.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::host {
namespace {

using modbus::Range;
using modbus::WriteRequest;
using Function = HostOptions::WriteFunction;

bool is_neighbour(Range a, Range b) { return a.end() == b.start() || b.end() == a.start(); }

Result<> write_batch(const WriteBatch& batch, const Map& map, Link& link,
                     std::vector<RejectedValue>& rejected) {
  Result<> answer = send(batch, map, link);
  if (answer) answer = link.receive();
  const ExceptionReply* exception = answer ? nullptr : exception_in(answer.error());
  if (exception == nullptr || is_unit_away(answer.error())) return answer;
  if (batch.writes().size() == 1) {
    rejected.push_back({batch.writes().front().point, *exception});
    return {};
  }
  for (const Write& write : batch.writes()) {  // one of them may be to blame, or their being together
    WriteBatch alone(map);
    alone.add(write);
    if (auto one = write_batch(alone, map, link, rejected); !one) return one;
  }
  return {};
}

Result<> read_point(const Map& map, const Point& point, Link& link, std::uint16_t* values) {
  return link.read_as_mapped(map, point.table, read_range(point), values);
}

}  // namespace

bool needs_read(const Map& map, const Point& point) { return is_partial(point) && !map.limits.mask_write; }

bool WriteBatch::merges(const Write& write) const {
  const Point& which = point(write);
  return !is_partial(which) && which.host.write_function != Function::single &&
         which.host.write_queue != HostOptions::WriteQueue::every;
}

bool WriteBatch::add(const Write& write) {
  const Range own = range(point(write));
  if (writes_.empty()) {
    range_ = own;
  } else {
    const Point& first = point(writes_.front());
    if (point(write).table != first.table || !is_neighbour(own, range_)) return false;
    if (!merges(writes_.front()) || !merges(write)) return false;
    const auto both = Range::of(std::min(own.start(), range_.start()), own.count() + range_.count());
    if (both.count() > (holds_bits(first.table) ? map_->limits.write_bits : map_->limits.write_registers))
      return false;
    range_ = both;
  }
  writes_.push_back(write);
  return true;
}

WriteRequest WriteBatch::part_request(std::uint16_t before) const {
  const Point& which = point(writes_.front());
  const std::uint16_t mask = codec::mask(which.format);
  const auto others = static_cast<std::uint16_t>(~mask);
  const std::uint16_t value = writes_.front().registers[0];
  if (map_->limits.mask_write) return WriteRequest::mask(which.address, others, value);
  const auto word = static_cast<std::uint16_t>((before & others) | (value & mask));
  if (write_function(which.table, 1, which.host.write_function) == modbus::Function::write_multiple_registers)
    return WriteRequest::registers(which.address, {&word, 1});
  return WriteRequest::register_value(which.address, word);
}

WriteRequest WriteBatch::request(std::uint16_t before) const {
  assert(!empty());
  const Point& first = point(writes_.front());
  const Write& only = writes_.front();
  if (is_partial(first)) return part_request(before);
  const modbus::Function function = write_function(first.table, range_.count(), first.host.write_function);
  if (function == modbus::Function::write_single_coil) return WriteRequest::coil(first.address, only.bit(0));
  if (function == modbus::Function::write_single_register)
    return WriteRequest::register_value(first.address, only.registers[0]);
  const bool coils = function == modbus::Function::write_multiple_coils;
  std::array<std::uint16_t, modbus::max_write_bits> values{};
  for (const Write& write : writes_) {
    const Range own = range(point(write));
    std::uint16_t* const to = &values[own.start() - std::size_t{range_.start()}];
    for (std::size_t i = 0; i < own.count(); ++i) to[i] = coils ? write.bit(i) : write.registers[i];
  }
  const Span<const std::uint16_t> used(values.data(), range_.count());
  return coils ? WriteRequest::coils(range_.start(), used) : WriteRequest::registers(range_.start(), used);
}

Result<> send(const WriteBatch& batch, const Map& map, Link& link) {
  std::uint16_t before = 0;
  const Point& point = map.points[batch.writes().front().point];
  if (needs_read(map, point))
    if (auto read = read_point(map, point, link, &before); !read) return tl::make_unexpected(read.error());
  const modbus::WriteRequest request = batch.request(before);
  return link.send(request);
}

Result<std::vector<RejectedValue>> write_values(const std::vector<Write>& writes, const Map& map, Link& link,
                                                std::vector<Write>* broken) {
  std::vector<RejectedValue> rejected;
  WriteBatch batch(map);
  const auto write_all = [&]() -> Result<> {
    Result<> written = batch.empty() ? Result<>{} : write_batch(batch, map, link, rejected);
    if (!written && broken != nullptr) *broken = batch.writes();
    batch.clear();
    return written;
  };
  for (const Write& write : writes) {
    if (batch.add(write)) continue;
    if (auto written = write_all(); !written) return tl::make_unexpected(written.error());
    batch.add(write);
  }
  if (auto written = write_all(); !written) return tl::make_unexpected(written.error());
  return rejected;
}

Result<> ReadBack::read(const Write& write, const Map& map, Link& link) {
  const Point& point = map.points[write.point];
  count_ = read_range(point).count();
  if (auto read = read_point(map, point, link, found_.data()); !read) return read;
  const auto mask = own_bits(point);
  for (std::size_t i = 0; i < count_; ++i) {
    written_[i] = point.table == Table::coils ? write.bit(i) : write.registers[i] & mask;
    found_[i] = found_[i] & mask;
  }
  return {};
}

bool ReadBack::is_equal() const {
  return std::equal(written_.begin(), written_.begin() + static_cast<std::ptrdiff_t>(count_), found_.begin());
}

}  // namespace coupler::host
