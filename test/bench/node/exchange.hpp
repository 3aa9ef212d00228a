// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

namespace coupler::bench {

/// Bytes of an ADU.
using Adu = std::vector<std::uint8_t>;

/// The ADU around a PDU and the data that follows it, to or from unit 255.
Adu adu(std::initializer_list<std::uint8_t> pdu, const Adu& data = {});

/// A request and the only right reply to it. Their transaction id is 0.
struct Exchange {
  Adu request;
  Adu reply;
};

/// What one connection asks for, again and again.
struct Case {
  /// Makes the values that the replies are to show; asked once, first.
  std::optional<Exchange> preparation;
  /// Asked in turn.
  std::vector<Exchange> exchanges;
};

/// "fc3": 10 holding registers from 0. "fc1": 32 coils from 0. "fc5": coil 32, on and off in turn.
/// nullopt: no such case.
std::optional<Case> find_case(std::string_view name);

}  // namespace coupler::bench
