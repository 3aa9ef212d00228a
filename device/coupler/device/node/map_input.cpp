// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/map_input.hpp"

#include <filesystem>
#include <system_error>

#include "coupler/map/loader/load.hpp"

namespace coupler::device {

MapPtr MapInput::read() const {
  const LoadResult loaded = load_map_file(path_);
  for (const Diagnostic& diagnostic : loaded.diagnostics) log_.tell(diagnostic);
  return loaded.map;
}

ReadMap MapInput::first() const {
  return {[this] { return read(); }, log_.descriptor()};
}

ReadMap MapInput::again() const {
  if (path_ == "-") return {};
  const auto read = [this]() -> MapPtr {
    for (const std::string& path : {path_, path_ + ".lock"})
      if (!is_regular(path)) return nullptr;
    return this->read();
  };
  return {read, log_.descriptor()};
}

/// What is not there, or cannot be looked at, is told when it is read.
bool MapInput::is_regular(const std::string& path) const {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return true;
  log_.tell({Diagnostic::Severity::error, path, 0, 0, "it is not a regular file",
             "a node that runs reads only such: write the map to one, or start the node anew"});
  return false;
}

}  // namespace coupler::device
