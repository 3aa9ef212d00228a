// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/base/descriptor.hpp"
#include "coupler/credentials/credentials.hpp"
#include "coupler/map/map.hpp"

namespace coupler::device {

/// The settings of the process that does TLS. They go there in memory of its own, which no other process
/// maps: the process with the lines never has the key.
struct TlsSettings {
  Credentials credentials;
  std::vector<std::string> allow;  ///< as Service::allow
  std::vector<std::string> roles;
};

/// Those of a map with TLS; reads its files. The error is one line.
tl::expected<TlsSettings, std::string> tls_settings_of(const Map& map);

/// Memory that is only reached by its descriptor. Not open: errno says why.
Descriptor make_settings_memory();
/// False: there is no room for them.
[[nodiscard]] bool write_settings(int memory, const TlsSettings& settings);
/// nullopt: there are none.
std::optional<TlsSettings> read_settings(int memory);

}  // namespace coupler::device
