// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tl/expected.hpp>

#include "coupler/device/core/edge_points.hpp"
#include "coupler/device/core/hardware.hpp"
#include "coupler/device/core/image.hpp"
#include "coupler/device/core/statistics.hpp"
#include "coupler/device/core/watchdog.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/server.hpp"

namespace coupler::device {

/// Carries out requests, one at a time and each as a whole: everything is validated, then the hardware is
/// driven, then the image is changed, then the reply is made. What fails leaves no trace. Allocates nothing.
class Handler {
 public:
  /// All of them outlive the handler. The image shows outputs as the lines are driven. `links` has
  /// node_memory().links elements.
  Handler(const Map& map, Image& image, Hardware hardware, Statistics& statistics, OutputWatchdog& watchdog,
          Span<EdgePoints::Link> links);

  /// Which machine the node says that it runs on; until then it says that it does not know.
  void set_machine(const identity::Machine& machine);

  /// Answers a request PDU (at least one byte) with a reply PDU in `reply` (at least max_pdu_size bytes);
  /// returns its size; `session` sent it. Exceptions: those of parse_request(); 02 an address that is not
  /// mapped, not readable or not writable; 03 a value that does not reset the watchdog, that the
  /// map does not allow, or that an output cannot take; 04 hardware that cannot be read or driven, or an
  /// output that the watchdog keeps in its safe state.
  std::size_t handle(modbus::Bytes request, ClientSession& session, TimePoint now, Span<std::uint8_t> reply);

  /// Drives the outputs to their safe state if the watchdog is due. handle() does so too.
  void tick(TimePoint now);
  /// How long tick() need not be called; nullopt: not before the next request.
  std::optional<std::chrono::milliseconds> time_until_due(TimePoint now) const;

 private:
  using Answer = tl::expected<std::size_t, modbus::Exception>;
  /// A request on its way to its answer.
  struct Call {
    modbus::Bytes request;
    TimePoint now;
    Span<std::uint8_t> reply;
  };

  Answer answer(const Call& call);
  Answer carry_out(const modbus::Read& read, const Call& call);
  Answer carry_out(const modbus::WriteBits& write, const Call& call);
  Answer carry_out(const modbus::WriteRegisters& write, const Call& call);
  Answer carry_out(const modbus::MaskWrite& write, const Call& call);
  Answer carry_out(const modbus::ReadWriteRegisters& both, const Call& call);
  Answer carry_out(const modbus::FileGroups& groups, const Call& call);
  Answer carry_out(const modbus::Echo& echo, const Call& call);
  Answer carry_out(const modbus::ReadDeviceIdentification& wanted, const Call& call);

  Answer reset_watchdog(const modbus::WriteRegisters& write, const Call& call);
  Answer hardware_failed();
  /// Empty if one is not mapped, not writable, or holds in part a value that is only written as a whole: a
  /// counter's, or that of an analogue output.
  Span<std::uint16_t> writable_registers(modbus::Range range) const;
  /// What next_ says would give a point of the range a value that the map does not allow.
  bool is_forbidden(Table table, modbus::Range written) const;
  bool is_forbidden(const Point& point, modbus::Range written) const;
  void put_next(const modbus::WriteRegisters& write);
  /// Drives the outputs of the range, then stores in its cells: what next_ says.
  tl::expected<void, modbus::Exception> store(Table table, modbus::Range range, Span<std::uint16_t> cells,
                                              TimePoint now);
  void show_outputs();

  const Map& map_;
  identity::Machine machine_{};
  Image& image_;
  Hardware hardware_;
  Statistics& statistics_;
  OutputWatchdog& watchdog_;
  EdgePoints edge_points_;
  bool limits_values_;                                        ///< the map does, of a point that is written
  bool wrote_output_ = false;                                 ///< the request that is being answered has
  std::array<std::uint16_t, modbus::max_write_bits> next_{};  ///< what a write stores, before it is committed
};

}  // namespace coupler::device
