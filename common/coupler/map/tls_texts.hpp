// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/map/security.hpp"

namespace coupler {

/// A copy of Tls that owns its texts.
struct TlsTexts {
  std::string certificate{};
  std::string key{};
  std::string ca{};
  std::string name{};
  std::string pin{};
  std::string folder{};

  static TlsTexts of(const Tls& tls) {
    return {std::string(tls.certificate), std::string(tls.key), std::string(tls.ca),
            std::string(tls.name),        std::string(tls.pin), std::string(tls.folder)};
  }
  Tls view() const { return {certificate, key, ca, name, pin, folder}; }
};

/// Puts what `given` has in the place of what `tls` says: an authority in that of a pin, too, and a pin in
/// that of an authority. Paths that are not absolute still begin in the folder of `tls`.
constexpr void overlay(Tls& tls, const Tls& given) {
  const auto put = [](std::string_view from, std::string_view& to) {
    if (!from.empty()) to = from;
  };
  put(given.certificate, tls.certificate);
  put(given.key, tls.key);
  put(given.ca, tls.ca);
  put(given.name, tls.name);
  put(given.pin, tls.pin);
  if (given.ca.empty() && !given.pin.empty()) tls.ca = {};
  if (given.pin.empty() && !given.ca.empty()) tls.pin = {};
}

}  // namespace coupler
