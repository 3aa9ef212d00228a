// SPDX-License-Identifier: Apache-2.0
// What the command line of `coupler probe` means.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/host/scan/known_value.hpp"
#include "coupler/host/scan/scan.hpp"
#include "coupler/map/map.hpp"
#include "coupler/tools/place_argument.hpp"

namespace coupler::tools {

/// The arguments as they were typed.
struct ProbeArguments {
  std::string host;
  TlsTexts tls;
  std::vector<std::string> units;
  std::uint32_t from = scan::Task{}.window.start();
  std::uint32_t to = scan::Task{}.window.last();
  std::uint32_t stride = scan::Task{}.stride;
  double rate = scan::Task{}.rate;
  double timeout = 0;  ///< s; 0: not given
  std::vector<std::string> bauds;
  std::vector<std::string> parities;
  std::vector<std::string> known;
  std::string out;
  bool force = false;
  bool scan = false;  ///< a node, too, is scanned
};

struct ProbeCall {
  Connection connection;
  std::vector<Serial> lines;  ///< to try until a unit answers; one without a device: it is reached by TCP
  scan::Task task;
  std::vector<scan::KnownValue> known;
  int ended_by = 0;  ///< the signal that has ended the scan; 0 if none has
};

/// The connection is that of `place`, which must outlive the result.
tl::expected<ProbeCall, Failure> understand(const ProbeArguments& arguments, const Place& place);

}  // namespace coupler::tools
