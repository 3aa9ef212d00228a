// SPDX-License-Identifier: Apache-2.0
// The parameters that the call gives: -p NAME:=VALUE, and the sections of --params-file.
#pragma once

#include <rcl/arguments.h>

#include <string>
#include <string_view>
#include <vector>

#include "coupler/host/ros/settings.hpp"

namespace coupler::host {

/// A parameter as YAML read it.
struct GivenParameter {
  enum class Kind { truth, whole, real, text, list };
  std::string name;  ///< "rate", "belt.address"
  Kind kind;
  std::string text;  ///< of a list its elements, separated by commas
};

class GivenParameters {
 public:
  /// Of one node, or of all that fit a pattern, as "/**".
  struct Section {
    std::string node;
    std::vector<GivenParameter> parameters;
  };

  explicit GivenParameters(std::vector<Section> sections) : sections_(std::move(sections)) {}
  /// Throws rcl::Error.
  static GivenParameters of(const rcl_arguments_t& arguments);

  /// What holds for a node, "/cell/press_driver", in the order in which it was given: the last one counts.
  /// An empty name: a node whose name is not known yet.
  std::vector<GivenParameter> for_node(std::string_view full_name) const;

  /// A node, not a pattern, whose parameters are those of a driver; empty: there is none.
  std::string driver_section() const;

  /// A line for each parameter of the node that is not a setting: misspelt ones do nothing. What is said of
  /// all nodes may be meant for others, so of that only what is nearly a setting. `devices`: the names of
  /// several, whose settings stand below them.
  std::vector<std::string> unknown(std::string_view full_name,
                                   const std::vector<std::string_view>& devices) const;

 private:
  std::vector<Section> sections_;
};

/// Settings among parameters, those that begin with `prefix`, of whichever type YAML made them. A text that
/// is empty says nothing. The error says how to spell the value.
tl::expected<Settings, std::string> settings_among(const std::vector<GivenParameter>& parameters,
                                                   std::string_view prefix);

}  // namespace coupler::host
