// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/device_recording.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/node_address.hpp"

namespace coupler::host {

std::unique_ptr<DeviceRecording> DeviceRecording::start(const Map& map, const ValueTable& values,
                                                        const std::string& path,
                                                        const Recorder::Report& report) {
  auto file = RecordFile::open(path, {});
  if (!file) {
    report(Level::error, fmt::format("{}; nothing is recorded", file.error()));
    return nullptr;
  }
  report(Level::info, "recording to " + path);
  return std::unique_ptr<DeviceRecording>(new DeviceRecording(map, values, *std::move(file), report));
}

DeviceRecording::DeviceRecording(const Map& map, const ValueTable& values, RecordFile file,
                                 const Recorder::Report& report)
    : recorder_(map, values, node_address_text(map.connection), *format_, std::chrono::steady_clock::now(),
                [](Level, const std::string&) {}),  // the driver has logged it
      thread_(recorder_, std::move(file), report) {}

std::string recording_path(const std::string& path, std::string_view device, bool is_alone) {
  const std::filesystem::path given(path);
  if (is_alone) return path;
  std::string name(device);
  std::replace(name.begin(), name.end(), '/', '_');
  return (given.parent_path() /
          fmt::format("{}-{}{}", given.stem().string(), name, given.extension().string()))
      .string();
}

}  // namespace coupler::host
