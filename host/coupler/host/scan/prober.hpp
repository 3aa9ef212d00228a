// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coupler/host/core/clock.hpp"
#include "coupler/host/scan/ports.hpp"

namespace coupler::scan {

/// The reply to a request, or why there is none.
struct Reply {
  enum class Kind {
    given,
    refused,  ///< an exception
    none,     ///< no reply, a closed connection or a malformed reply
    over,     ///< not sent: the scan has to end
  };
  Kind kind = Kind::over;
  std::optional<modbus::Exception> exception{};  ///< if refused
  bool timed_out = false;                        ///< if none

  bool is_given() const { return kind == Kind::given; }
};

/// Makes requests gently: never more than `rate` a second, and again if the device is busy. A request without
/// a reply is repeated once, over a new connection, until it is certain that this is how the device refuses.
class Prober {
 public:
  /// `rate`: requests a second, above 0.
  Prober(Client& client, host::Clock& clock, const ScanProgress& progress, double rate);

  Result<> connect();
  void select(std::uint8_t unit) { client_.select(unit); }
  /// Without repetition if there is no reply.
  Reply try_read(Table table, modbus::Range range, std::uint16_t* values);
  Reply read(Table table, modbus::Range range, std::uint16_t* values);
  Reply identify(modbus::ReadDeviceIdentification wanted, IdentificationPage& page);

  std::uint64_t requests() const { return requests_; }
  /// Why the device can no longer be reached.
  const std::optional<host::Error>& broke_off() const { return broke_off_; }
  /// Each failure other than an exception, and how often it came: "no reply within 1000 ms (3 times)".
  std::vector<std::string> failures() const;

 private:
  bool is_ready();
  template <class Request>
  Reply attempt(Request&& request);
  template <class Request>
  Reply ask(Request&& request, bool once);
  bool reconnect();
  void pause();

  Client& client_;
  host::Clock& clock_;
  const ScanProgress& progress_;
  host::Duration gap_;
  host::Time ready_;
  bool connected_ = false;
  int confirmed_ = 0;  ///< requests in a row that got no reply twice
  std::uint64_t requests_ = 0;
  std::optional<host::Error> broke_off_;
  std::map<std::string, int> failures_;
};

}  // namespace coupler::scan
