// SPDX-License-Identifier: Apache-2.0
// Couplers that say in registers of their own what they are and what is on their terminals: no address need
// be guessed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/host/scan/prober.hpp"
#include "coupler/map/map.hpp"

namespace coupler::scan {

/// A coupler of a kind that has a preset.
struct Recognition {
  std::string kind;  ///< for people: "WAGO 750-352"
  std::string name;  ///< of its map: "wago_750_352"
  std::string_view preset;
  std::uint32_t outputs = 0;           ///< bits; as many as the preset's areas reach
  std::uint32_t inputs = 0;            ///< bits, likewise
  std::uint32_t analogue_outputs = 0;  ///< registers, likewise
  std::uint32_t analogue_inputs = 0;   ///< registers, likewise
  bool is_cut = false;                 ///< it has more than they reach
};

/// nullopt: none of them, or it has nothing on its terminals. A foreign device is asked for one register, a
/// coupler for eight.
std::optional<Recognition> recognise(Prober& prober);

/// "16 inputs, 8 outputs, 4 analogue inputs".
std::string channels_text(const Recognition& recognition);

/// A map in YAML with a point for each bit and for each register of its process image.
std::string recognised_map(const Recognition& recognition, const Connection& connection);

}  // namespace coupler::scan
