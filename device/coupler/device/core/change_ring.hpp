// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "coupler/base/span.hpp"
#include "coupler/modbus/changes.hpp"

namespace coupler::device {

struct ClientSession;

/// The newest changes, in the order in which they became known. They are numbered from 1 within an epoch;
/// what is overwritten before a client has asked for it is lost to that client.
class ChangeRing {
 public:
  struct Entry {
    std::uint64_t number = 0;
    modbus::Change change{};
    const ClientSession* owner = nullptr;  ///< who scheduled what came to this; of a bit nobody
  };

  /// Keeps as many changes as there are places, which outlive it.
  explicit ChangeRing(Span<Entry> places = {}) : places_(places) {}

  /// Forgets everything. The epoch is not 0, and another one than before.
  void begin(std::uint32_t epoch);
  /// 0: it has not begun, and nothing is to be added.
  std::uint32_t epoch() const { return epoch_; }

  void add(const modbus::Change& change, const ClientSession* owner = nullptr);
  /// At least so many changes happened that nobody saw. They have numbers, too.
  void lose(std::uint32_t count) { newest_ += count; }
  /// Number of the newest change; 0: there was none.
  std::uint64_t newest() const { return newest_; }

  /// Returns whether there is something to tell a client: changes, or that its numbers mean nothing here.
  bool has_news(const modbus::ChangesRequest& request) const {
    return begins_anew(request) || newest_ > request.seen;
  }
  /// The reply but for its times. To a client whose numbers mean nothing it tells the newest number.
  modbus::ChangesReply reply_to(const modbus::ChangesRequest& request) const;
  /// The oldest change after that number which is kept; null: there is none.
  const Entry* next_after(std::uint64_t number) const;

 private:
  /// Its numbers are of another epoch, or were never given.
  bool begins_anew(const modbus::ChangesRequest& request) const {
    return request.epoch != epoch_ || request.seen > newest_;
  }
  const Entry& kept(std::size_t i) const { return places_[(first_ + i) % places_.size()]; }
  std::size_t first_after(std::uint64_t seen) const;

  Span<Entry> places_;
  std::size_t first_ = 0;  ///< place of the oldest that is kept
  std::size_t count_ = 0;  ///< how many are kept
  std::uint32_t epoch_ = 0;
  std::uint64_t newest_ = 0;
};

}  // namespace coupler::device
