// SPDX-License-Identifier: Apache-2.0
// The driver's settings as parameters of its node: those that the call gives, and those that the node
// declares.
#pragma once

#include <rcl/arguments.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coupler/host/ros/map_sources.hpp"
#include "coupler/host/ros/settings.hpp"
#include "coupler/host/ros2/parameter_server.hpp"

namespace coupler::host {

/// A parameter as the YAML parser read it.
struct GivenParameter {
  enum class Kind { boolean, integer, real, text, list };
  std::string name;  ///< "rate", "belt.address"
  Kind kind;
  std::string text;  ///< of a list its elements, separated by commas
};

/// The parameters that the call gives: -p NAME:=VALUE, and the sections of --params-file.
class GivenParameters {
 public:
  /// The parameters of one node, or of all that match a pattern, as "/**".
  struct Section {
    std::string node;
    std::vector<GivenParameter> parameters;
  };

  explicit GivenParameters(std::vector<Section> sections) : sections_(std::move(sections)) {}
  /// Throws rcl::Error.
  static GivenParameters of(const rcl_arguments_t& arguments);

  /// Returns the parameters for a node, "/cell/press_driver", in the order in which they were given: the last
  /// one counts. An empty name is that of a node whose name is not known yet.
  std::vector<GivenParameter> for_node(std::string_view full_name) const;

  /// A node, not a pattern, whose parameters are those of a driver; empty: there is none.
  std::string driver_section() const;

  /// A line for each parameter of the node that is not a setting: misspelt ones do nothing. Those for all
  /// nodes may be meant for others: of them only what is nearly a setting. `devices`: the names of several,
  /// whose settings stand below them.
  std::vector<std::string> unknown(std::string_view full_name,
                                   const std::vector<std::string_view>& devices) const;

 private:
  std::vector<Section> sections_;
};

/// The settings among the parameters that begin with `prefix`, of whichever type YAML made them. An empty
/// text counts as not set. The error says how to spell the value.
tl::expected<Settings, std::string> settings_among(const std::vector<GivenParameter>& parameters,
                                                   std::string_view prefix);

/// Declares every setting as a parameter, with the value that was given.
void declare_settings(ParameterServer& server, const Settings& settings);

/// Declares the values in use, once the maps are known: of a single device each setting, of several those of
/// each below its name.
void declare_devices(ParameterServer& server, const Devices& devices);

}  // namespace coupler::host
