// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "coupler/host/record/record_thread.hpp"
#include "coupler/host/ros/follower.hpp"

namespace coupler::host {

/// The recording of a device that is driven: of what its one connection reads anyway. A build of the driver
/// needs no other.
class DeviceRecording final : public Follower {
 public:
  /// `path`: the file. Null, after it is reported, if it cannot be one: the device is driven all the same.
  /// The storage of `map`, and the table, must outlive it.
  static std::unique_ptr<DeviceRecording> start(const Map& map, const ValueTable& values,
                                                const std::string& path, const Recorder::Report& report);

  Sink& sink() override { return recorder_; }
  void end_comes() override { recorder_.end_comes(); }
  void end() override { thread_.end(); }

 private:
  DeviceRecording(const Map& map, const ValueTable& values, RecordFile file, const Recorder::Report& report);

  std::unique_ptr<RecordFormat> format_ = json_format();
  Recorder recorder_;
  RecordThread thread_;
};

/// Returns the file of one of several devices: press-NAME.jsonl in place of press.jsonl.
std::string recording_path(const std::string& path, std::string_view device, bool is_alone);

}  // namespace coupler::host
