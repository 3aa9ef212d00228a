// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/device/node/map_reading.hpp"
#include "coupler/device/node/stderr_log.hpp"

namespace coupler::device {

/// The map file of a node. What is wrong with it is said in the log.
class MapInput {
 public:
  /// `path` may be "-", standard input, which can be read once. The log outlives it.
  MapInput(std::string path, StderrLog& log) : path_(std::move(path)), log_(log) {}

  /// Any file will do, a pipe too.
  ReadMap first() const;
  /// For a node that runs: only a regular file is opened, others may have no end, or none that comes soon.
  ReadMap again() const;

 private:
  MapPtr read() const;
  bool is_regular(const std::string& path) const;

  std::string path_;
  StderrLog& log_;
};

}  // namespace coupler::device
