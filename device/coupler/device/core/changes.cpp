// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/changes.hpp"

#include <algorithm>
#include <cassert>

#include "coupler/device/core/clock.hpp"

namespace coupler::device {
namespace {

using modbus::Change;
using modbus::Range;

std::uint8_t code_of(Table table) {
  return static_cast<std::uint8_t>(table == Table::coils ? modbus::Function::read_coils
                                                         : modbus::Function::read_discrete_inputs);
}

}  // namespace

void Changes::begin(std::uint32_t epoch) {
  assert(image_ != nullptr && told_.size() == image_->bits().size());
  const auto bits = image_->bits();
  std::copy(bits.begin(), bits.end(), told_.begin());
  ring_.begin(epoch);
}

/// Returns the levels of the cells that were told last.
Span<std::uint16_t> Changes::told(Span<const std::uint16_t> cells) const {
  return told_.sub(static_cast<std::size_t>(cells.begin() - image_->bits().begin()), cells.size());
}

bool Changes::differs(Table table, Range range) const {
  if (!are_told() || !holds_bits(table)) return false;
  const auto cells = image_->find(table, range);
  return !cells.empty() && !std::equal(cells.begin(), cells.end(), told(cells).begin());
}

void Changes::compare(Table table, Range range) {
  if (!differs(table, range)) return;
  const auto cells = image_->find(table, range);
  const auto told = this->told(cells);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] == told[i]) continue;
    told[i] = cells[i];
    tell(table, range.start() + static_cast<std::uint32_t>(i), cells[i], now_);
  }
}

void Changes::compare_all() {
  if (!are_told()) return;
  for (const Table table : {Table::coils, Table::discrete_inputs})
    for (const Image::Area& area : image_->mapped(table))
      compare(table, Range::of(area.start, area.end - area.start));
}

void Changes::set_level(std::uint16_t input, bool level, TimePoint at) {
  if (!are_told()) return;
  const auto cell = image_->find(Table::discrete_inputs, Range::of(input, 1));
  if (cell.empty()) return;
  std::uint16_t& last = told(cell)[0];
  cell[0] = level ? 1 : 0;
  if (last == cell[0]) return;
  last = cell[0];
  tell(Table::discrete_inputs, input, last, at);
}

void Changes::tell(Table table, std::uint32_t address, std::uint16_t level, TimePoint at) {
  ring_.add({code_of(table), level != 0 ? Change::Kind::on : Change::Kind::off,
             static_cast<std::uint16_t>(address), node_time(at)});
}

void Changes::add_outcome(const Change& outcome, const ClientSession* owner) {
  if (are_told()) ring_.add(outcome, owner);
}

void Changes::lose(std::uint32_t count) {
  if (are_told()) ring_.lose(count);
}

std::size_t Changes::reply_to(ClientSession& session, const Rights& rights, TimePoint now,
                              Span<std::uint8_t> pdu) const {
  modbus::ChangesReply reply = ClientChanges(ring_, rights, session).reply();
  reply.arrived = node_time(session.wait->arrived);
  reply.replied = node_time(now);
  return modbus::reply_changes(reply, pdu);
}

}  // namespace coupler::device
