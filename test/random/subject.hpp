// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "coupler/test_vectors/cases.hpp"
#include "test/random/client_end.hpp"
#include "test/random/firmware_end.hpp"

namespace coupler::random {

/// A random map, and what was generated from it.
struct Subject {
  std::string name;  ///< of the map's file in the folder of the maps, without ".yaml"
  const Map* map;
  std::unique_ptr<ClientEnd> (*client)(client::Options options);
  std::unique_ptr<FirmwareEnd> (*firmware)();
};

/// All that are linked.
std::vector<Subject>& subjects();

/// What a point has in a round: each point another case, so that those that share registers differ.
inline const test_vectors::Case& pick(const test_vectors::Cases& cases, std::uint32_t point,
                                      std::size_t round) {
  return cases.cases[(round + point) % cases.cases.size()];
}

/// Whether a client's write is read back as it was: a latched point is set by its input only.
inline bool is_settable(const Point& point) { return is_writable(point) && !point.latched.present(); }

/// At static initialization.
struct Registered {
  explicit Registered(Subject subject) { subjects().push_back(std::move(subject)); }
};

template <class Client>
std::unique_ptr<ClientEnd> make_client(client::Options options) {
  return std::make_unique<GeneratedClient<Client>>(std::move(options));
}

template <class Firmware>
std::unique_ptr<FirmwareEnd> make_firmware() {
  return std::make_unique<Firmware>();
}

}  // namespace coupler::random
