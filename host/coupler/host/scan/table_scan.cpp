// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/table_scan.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace coupler::scan {

TableFindings::TableFindings(Table table, modbus::Range window)
    : table_(table), window_(window), seen_(window.count(), Seen::not_asked), values_(window.count()) {}

void TableFindings::add_values(modbus::Range range, const std::uint16_t* values) {
  const auto first = static_cast<std::ptrdiff_t>(range.start() - window_.start());
  std::fill_n(seen_.begin() + first, range.count(), Seen::readable);
  std::copy_n(values, range.count(), values_.begin() + first);
}

std::uint32_t TableFindings::count(Seen seen) const {
  return static_cast<std::uint32_t>(std::count(seen_.begin(), seen_.end(), seen));
}

std::vector<modbus::Range> TableFindings::readable() const {
  std::vector<modbus::Range> ranges;
  for (std::uint32_t at = window_.start(); at < window_.end();) {
    const std::uint32_t start = at++;
    if (seen(start) != Seen::readable) continue;
    while (at < window_.end() && seen(at) == Seen::readable && seams_.count(at) == 0) ++at;
    ranges.push_back(modbus::Range::of(start, at - start));
  }
  return ranges;
}

std::vector<modbus::Range> TableFindings::holes() const {
  std::vector<modbus::Range> ranges;
  const std::vector<modbus::Range> known = readable();
  for (std::size_t i = 1; i < known.size(); ++i) {
    const std::uint32_t start = known[i - 1].end();
    const auto all_refused = [this](std::uint32_t from, std::uint32_t to) {
      while (from < to && seen(from) == Seen::refused) ++from;
      return from == to;
    };
    if (start < known[i].start() && all_refused(start, known[i].start()))
      ranges.push_back(modbus::Range::of(start, known[i].start() - start));
  }
  return ranges;
}

TableScan::TableScan(Prober& prober, ScanProgress& progress, LargestReads& largest, std::uint32_t stride,
                     TableFindings& findings)
    : prober_(prober),
      progress_(progress),
      largest_(largest.of(findings.table())),
      stride_(stride),
      findings_(findings) {}

bool TableScan::run() {
  progress_.begins(to_string(findings_.table()));
  const modbus::Range window = findings_.window();
  for (std::uint32_t start = window.start(); start < window.end() && !ended();) {
    const auto block = modbus::Range::of(start, std::min(window.end() - start, largest_.count));
    look_at(block);
    start = block.end();
  }
  look_around();
  return !over_;
}

/// Makes the request, and notes what the reply shows.
bool TableScan::reads(modbus::Range range) {
  if (ended()) return false;
  const Reply reply = prober_.read(findings_.table(), range, values_.data());
  const modbus::Range window = findings_.window();
  progress_.moved(static_cast<std::uint32_t>(range.start()) - window.start(), window.count(),
                  prober_.requests());
  over_ = reply.kind == Reply::Kind::over;
  if (reply.is_given()) findings_.add_values(range, values_.data());
  if (reply.is_given() || over_) return reply.is_given();
  findings_.absent =
      reply.exception == modbus::Exception::illegal_function && findings_.count(Seen::readable) == 0;
  if (reply.timed_out && ++timeouts_ == most_timeouts) findings_.gave_up_at = range.start();
  if (range.count() == 1 && !findings_.absent) findings_.add_refused(range.start());
  return false;
}

bool TableScan::is_readable(std::uint32_t address) {
  if (findings_.seen(address) == Seen::not_asked) reads(address, 1);
  return findings_.seen(address) == Seen::readable;
}

void TableScan::look_at(modbus::Range block) {
  if (reads(block) || ended()) return;
  const std::uint32_t start = findings_.window().start();
  if (stride_ == 1)
    walk(block);
  else if (block.start() == start)
    walk(modbus::Range::of(start, std::min(block.count(), first_addresses)));
  if (try_some(block)) walk(block);
}

/// Tries some addresses of a block. Returns whether there were any, and all of them can be read.
bool TableScan::try_some(modbus::Range block) {
  std::uint32_t tried = 0;
  std::uint32_t given = 0;
  for (std::uint32_t at = block.start(); at < block.end() && !ended(); ++at) {
    if (!is_tried(at)) continue;
    ++tried;
    given += is_readable(at) ? 1U : 0U;
  }
  return tried > 0 && tried == given;
}

bool TableScan::is_tried(std::uint32_t address) const { return address % stride_ == 0 || address % 100 <= 1; }

void TableScan::look_around() {
  auto ranges = surroundings();
  if (ranges.empty() || ended()) return;
  progress_.begins(fmt::format("{}, around what was found", to_string(findings_.table())));
  for (; !ranges.empty() && !ended(); ranges = surroundings())
    for (const modbus::Range range : ranges) walk(range);
}

/// The neighbourhoods of all that can be read, joined, where something was not asked for yet.
std::vector<modbus::Range> TableScan::surroundings() const {
  const modbus::Range window = findings_.window();
  std::vector<modbus::Range> ranges;
  std::uint32_t start = window.start();
  std::uint32_t end = window.start();
  bool is_open = false;  // something in [start, end) was not asked for
  const auto close = [&] {
    if (is_open) ranges.push_back(modbus::Range::of(start, end - start));
    is_open = false;
  };
  for (std::uint32_t at = window.start(); at < window.end(); ++at) {
    if (findings_.seen(at) != Seen::readable) continue;
    const std::uint32_t reach = std::min(at + neighbourhood + 1, window.end());
    std::uint32_t from = end;
    if (at > end + neighbourhood) {
      close();
      start = from = at - neighbourhood;
    }
    for (; from < reach; ++from) is_open |= findings_.seen(from) == Seen::not_asked;
    end = reach;
  }
  close();
  return ranges;
}

/// Reads all of the range, one address at a time where they are refused, and more after each that can be
/// read.
void TableScan::walk(modbus::Range range) {
  for (std::uint32_t at = range.start(); at < range.end() && !ended();) {
    if (!is_readable(at)) {
      ++at;
      continue;
    }
    while (at + 1 < range.end() && findings_.seen(at + 1) == Seen::readable) ++at;
    at = extend(at, range.end());
  }
}

/// One past what can be read together with `start`, which is readable, before `end`.
std::uint32_t TableScan::extend(std::uint32_t start, std::uint32_t end) {
  std::uint32_t refused = std::min(largest_.count, end - start);
  for (std::uint32_t i = 1; i < refused; ++i)
    if (findings_.seen(start + i) == Seen::refused) refused = i;
  if (refused == 1 || reads(start, refused)) return start + refused;
  std::uint32_t given = 1;
  while (2 * given < refused && reads(start, 2 * given)) given *= 2;
  refused = std::min(refused, 2 * given);
  while (refused - given > 1 && !ended()) {
    const std::uint32_t middle = given + (refused - given) / 2;
    (reads(start, middle) ? given : refused) = middle;
  }
  if (!ended() && is_readable(start + given)) explain(start, given, end);
  return start + given;
}

/// Finds out why `count` can be read from `start` on and one more cannot, though it can be read by itself.
void TableScan::explain(std::uint32_t start, std::uint32_t count, std::uint32_t end) {
  const bool is_count =
      count > 1 ? reads(start + 1, count) : start + 2 < end && is_readable(start + 2) && !reads(start + 1, 2);
  if (ended()) return;
  if (is_count)
    largest_ = {count, true};
  else
    findings_.add_seam(start + count);
}

}  // namespace coupler::scan
