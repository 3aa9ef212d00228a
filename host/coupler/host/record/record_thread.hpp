// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "coupler/host/record/record_file.hpp"
#include "coupler/host/record/recorder.hpp"

namespace coupler::host {

/// Writes what a recorder has, four times a second, in a thread of its own: a disk may take its time. What
/// cannot be written is said in the next file that can.
class RecordThread {
 public:
  /// The recorder, which outlives it, reports to `report` what happens to the files.
  RecordThread(Recorder& recorder, RecordFile file, Recorder::Report report);
  /// Writes the rest.
  ~RecordThread() { end(); }
  RecordThread(const RecordThread&) = delete;
  RecordThread& operator=(const RecordThread&) = delete;
  /// Does what the destructor does, once. Returns false if something is missing at the end.
  bool end();

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t written() const { return written_; }  ///< bytes

 private:
  void run();
  void write_on();
  void write(Time now);
  bool take(const tl::expected<void, std::string>& outcome, Time now);
  void miss(const std::string& why);

  Recorder& recorder_;
  RecordFile file_;
  const Recorder::Report report_;
  const std::filesystem::path path_;
  std::atomic<std::uint64_t> written_{0};
  Time last_written_ = std::chrono::steady_clock::now();
  std::optional<Time> missing_since_;
  std::string why_missing_;
  Time retry_at_{};
  std::chrono::milliseconds retry_pause_{250};
  bool is_whole_ = true;  ///< once the thread has ended
  std::mutex mutex_;
  std::condition_variable ends_now_;
  bool ends_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace coupler::host
