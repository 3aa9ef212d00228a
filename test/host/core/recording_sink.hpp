// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "coupler/host/core/sink.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host::test {

/// Keeps what it is told.
class RecordingSink : public Sink {
 public:
  explicit RecordingSink(const Map& map);
  ~RecordingSink() override;

  std::map<std::string, std::vector<std::uint16_t>>
      values;  ///< first register or bit of each sample, by point
  std::vector<bool> online;
  std::vector<std::string> reports;

  void on_bits(const ReadSpan& span, Span<const std::uint8_t> bits, Time) override;
  void on_registers(const ReadSpan& span, Span<const std::uint16_t> registers, Time) override;
  void on_online(bool now) override { online.push_back(now); }
  void on_report(Level, const std::string& text) override { reports.push_back(text); }

  /// How many reports contain the text.
  int reported(const std::string& text) const;

 private:
  Map map_;
};

}  // namespace coupler::host::test
