// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/node_status.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace coupler::tools {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr Connection where{"cell", 502, 1, std::chrono::milliseconds(1)};

NodeStatus node() {
  NodeStatus status;
  status.at = std::chrono::system_clock::time_point(std::chrono::milliseconds(1500));
  status.report = identity::Report{{0x0123456789ABCDEF, 300, 0xF409A1FE}, 2, 345, true, 93784, {}};
  std::uint32_t count = 1000;
  for (const identity::Counter& counter : identity::counters) status.report->counts.*counter.count = count++;
  status.further = {identity::machine_of("cell-7", 0xAB), {true, true}, 2000};
  status.identification = {{0, "OpenCoupler"}, {1, "press"}, {2, "0.1.0"}, {0x80, "x"}};
  return status;
}

const host::Certificates certificates{
    {"cell1", "operator", {{}, std::chrono::system_clock::time_point(std::chrono::hours(24))}},
    {"press", {}, {{}, std::chrono::system_clock::time_point(std::chrono::hours(1))}}};

NodeStatus foreign() {
  NodeStatus status;
  status.identification = {{0, "ACME\x1b[2J"}};
  return status;
}

TEST(StatusText, Everything_has_a_line) {
  const std::string text = status_text(node(), where);
  EXPECT_THAT(text, HasSubstr("the node at tcp://cell:502/1, 1970-01-01T00:00:01.500Z:\n"));
  for (const char* line :
       {"  map                                   press\n",
        "  fingerprint                           0123456789abcdef\n",
        "  size and CRC-32 of the map            300 bytes, f409a1fe\n",
        "  version of OpenCoupler                0.1.0\n", "  hostname                              cell-7\n",
        "  serial                                00000000000000ab\n",
        "  watchdog                              armed, 345 ms left\n",
        "  timeout of the watchdog               2000 ms\n",
        "  function codes of its own             65 (waiting for changes), 66 (outputs at a time)\n",
        "  uptime                                93784 s (1 d 2 h 3 min)\n",
        "  requests answered                     1000\n"})
    EXPECT_THAT(text, HasSubstr(line));
  for (const identity::Counter& counter : identity::counters)
    EXPECT_THAT(text, HasSubstr(std::string(counter.text)));
}

TEST(StatusText, With_TLS_it_names_the_certificates) {
  NodeStatus status = node();
  EXPECT_THAT(status_text(status, where), Not(HasSubstr("certificate")));
  status.certificates = certificates;
  EXPECT_THAT(
      status_text(status, where),
      HasSubstr("  certificate of this side              'cell1', until 1970-01-02 00:00 UTC, role operator\n"
                "  certificate of the node               'press', until 1970-01-01 01:00 UTC\n"));
  status.certificates->own.role.clear();
  EXPECT_THAT(status_text(status, where), HasSubstr("UTC, without a role\n"));
}

TEST(StatusText, What_a_node_does_not_say_is_unknown) {
  NodeStatus status = node();
  status.further = {};
  status.identification.clear();
  const std::string text = status_text(status, where);
  for (const char* what : {"map", "version of OpenCoupler", "hostname", "serial", "timeout of the watchdog"})
    EXPECT_THAT(text, testing::ContainsRegex(std::string("  ") + what + " +unknown\n"));
  EXPECT_THAT(text, testing::ContainsRegex("  function codes of its own +none\n"));
}

TEST(StatusText, A_node_without_a_watchdog_has_no_timeout) {
  NodeStatus status = node();
  status.report->watchdog_state = 0;
  status.further.watchdog_timeout = 0;
  EXPECT_THAT(status_text(status, where), testing::ContainsRegex("  timeout of the watchdog +none\n"));
}

TEST(StatusText, A_state_that_nobody_knows_is_a_number_and_the_longest_time_a_bound) {
  NodeStatus status = node();
  status.report->watchdog_state = 9;
  status.report->watchdog_left = 65535;
  EXPECT_THAT(status_text(status, where), HasSubstr(" 9, at least 65535 ms left\n"));
}

TEST(StatusText, Of_a_foreign_coupler_it_is_the_identification_made_harmless) {
  const std::string text = status_text(foreign(), where);
  EXPECT_THAT(text, HasSubstr("identification of tcp://cell:502/1 (FC 43/14):\n  VendorName "));
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
  EXPECT_THAT(status_text({}, where), IsEmpty());
}

TEST(StatusJson, Everything_has_a_key) {
  NodeStatus status = node();
  status.certificates = certificates;
  const auto report = ordered_json::parse(status_json(status, where));
  const auto expected = ordered_json::parse(R"({
    "device": "tcp://cell:502/1", "time": "1970-01-01T00:00:01.500Z", "trouble": null, "node": true,
    "name": "press", "version": "0.1.0", "fingerprint": "0123456789abcdef",
    "map": {"bytes": 300, "crc32": "f409a1fe"}, "hostname": "cell-7", "serial": "00000000000000ab",
    "watchdog": {"state": "armed", "left_ms": 345, "timeout_ms": 2000}, "functions": [65, 66], "uptime_s": 93784,
    "statistics": {"requests": 1000, "exceptions": 1001, "exceptions_01": 1002, "exceptions_02": 1003,
      "exceptions_03": 1004, "exceptions_04": 1005, "foreign_units": 1006, "connections": 1007,
      "connections_refused": 1008, "connections_evicted": 1009, "connections_bad_frames": 1010,
      "connections_timed_out": 1011, "hardware_errors": 1012, "events_lost": 1013, "watchdog_trips": 1014},
    "certificates": {"own": {"name": "cell1", "role": "operator", "ends": "1970-01-02T00:00:00.000Z"},
      "device": {"name": "press", "role": null, "ends": "1970-01-01T01:00:00.000Z"}},
    "identification": {"VendorName": "OpenCoupler", "ProductCode": "press", "MajorMinorRevision": "0.1.0",
      "object 80": "x"}})");
  EXPECT_EQ(report, expected) << report.dump(2);
}

TEST(StatusJson, What_a_node_does_not_have_is_null_or_empty) {
  NodeStatus status = node();
  status.further = {};
  const auto report = ordered_json::parse(status_json(status, where));
  EXPECT_TRUE(report.at("watchdog").at("timeout_ms").is_null());
  EXPECT_EQ(report.at("functions"), ordered_json::array());
}

TEST(StatusJson, Of_a_device_that_is_no_node_or_does_not_answer_the_keys_are_the_same) {
  NodeStatus silent;
  silent.error = host::Timeout{std::chrono::milliseconds(9)};
  const auto of_node = ordered_json::parse(status_json(node(), where));
  for (const NodeStatus& status : {foreign(), silent}) {
    const auto report = ordered_json::parse(status_json(status, where));
    EXPECT_EQ(report.at("node"), false);
    for (const auto& [key, value] : of_node.items()) EXPECT_TRUE(report.contains(key)) << key;
    EXPECT_TRUE(report.at("statistics").is_null());
  }
  EXPECT_EQ(ordered_json::parse(status_json(silent, where)).at("trouble"), "no reply within 9 ms");
}

}  // namespace
}  // namespace coupler::tools
