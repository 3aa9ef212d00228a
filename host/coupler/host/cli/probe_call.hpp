// SPDX-License-Identifier: Apache-2.0
// The command line of `coupler probe`, and what it means.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/host/scan/known_value.hpp"
#include "coupler/host/scan/scan.hpp"
#include "coupler/map/map.hpp"

namespace coupler::cli {

struct ProbeArguments {
  std::string host;
  std::vector<std::string> units;
  std::uint32_t from = scan::Task{}.window.start();
  std::uint32_t to = scan::Task{}.window.last();
  std::uint32_t stride = scan::Task{}.stride;
  double rate = scan::Task{}.rate;
  double timeout = 1;  ///< s
  std::vector<std::string> known;
  std::string out;
  bool force = false;
};

/// What it means. Not to be moved: `connection` is a view of `address`.
struct ProbeCall {
  std::string address;
  Connection connection;
  scan::Task task;
  std::vector<scan::KnownValue> known;
};

/// Why a call is none, and what to do.
struct WrongCall {
  std::string what;
  std::string remedy;
};

tl::expected<std::unique_ptr<ProbeCall>, WrongCall> understand(const ProbeArguments& arguments);

}  // namespace coupler::cli
