// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/base/descriptor.hpp"
#include "coupler/base/log_line_limit.hpp"
#include "coupler/device/core/log.hpp"
#include "coupler/device/supervisor/shared_memory.hpp"
#include "coupler/map/diagnostic.hpp"

namespace coupler::device {

/// Stderr, without waiting for whoever reads it: a terminal that was stopped, a pipe that is full. Other
/// programs that use it see no difference: O_NONBLOCK of a descriptor that they share would be theirs, too.
class LogStream {
 public:
  /// Stderr as it is now.
  LogStream();

  /// Returns how much of the text was written: what stderr takes at once.
  std::size_t write(std::string_view text) const;
  /// That write() needs besides stderr; -1: none.
  int descriptor() const { return own_.get(); }

 private:
  std::size_t write_some(std::string_view text) const;

  /// A descriptor of the same pipe or terminal that does not block. It is closed if there can be none, or if
  /// none is needed.
  Descriptor own_;
  bool is_socket_ = false;
};

/// The log on stderr: "coupler-node: …" for people; for systemd's journal, which knows who writes, a priority
/// instead (sd-daemon(3): "<4>…").
class StderrLog : public Log {
 public:
  /// `journal_stream`: the value of JOURNAL_STREAM, "device:inode" of the socket that leads to the journal;
  /// null: there is none.
  explicit StderrLog(const char* journal_stream);

  void write(std::string_view line) override;
  void warn(std::string_view line) override;
  void fail(std::string_view line) override;
  void write_limited(std::string_view kind, std::string_view line) override;
  void warn_limited(std::string_view kind, std::string_view line) override;
  /// Until it is called nothing is held back: a process that serves no clients need not call it.
  std::optional<std::chrono::milliseconds> tick(TimePoint now) override;
  /// Prints problems as compilers do, for editors.
  void tell(const Diagnostic& diagnostic);

  /// From now on nothing waits for the reader of stderr: a line that cannot be written at once is dropped,
  /// and the next one that can is preceded by one that tells how many were. So it is in processes forked from
  /// this one, which count together.
  void never_wait();
  bool is_journal() const { return to_journal_; }
  /// That it needs besides stderr; -1: none.
  int descriptor() const { return stream_.descriptor(); }

 private:
  struct Dropped {
    std::atomic<unsigned> lines{0};
    std::atomic<bool> in_the_middle{false};  ///< of a line: the rest of it is missing
  };

  struct Kind {
    LogLineLimit limit;
    int priority;  ///< of the newest line
  };

  void put_limited(int priority, std::string_view kind, std::string_view line);
  void put(int priority, std::string_view who, std::string_view line);
  std::string line_of(int priority, std::string_view who, std::string_view line) const;
  bool write_at_once(std::string_view text);
  bool tell_dropped();

  LogStream stream_;
  SharedArray<Dropped> dropped_{1};
  bool to_journal_;
  bool waits_ = true;
  std::map<std::string, Kind, std::less<>> kinds_;
  std::optional<TimePoint> now_;  ///< of the last tick()
};

}  // namespace coupler::device
