// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/diagnostic.hpp"
#include "device/core/log.hpp"

namespace coupler::node {

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
  /// As compilers tell them, for editors.
  void tell(const Diagnostic& diagnostic);

 private:
  void put(int priority, std::string_view who, std::string_view line) const;

  bool to_journal_;
};

}  // namespace coupler::node
