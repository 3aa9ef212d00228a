// SPDX-License-Identifier: Apache-2.0
// In place of coupler/host/cli in a build without libmodbus.
#include <string>
#include <string_view>

#include "coupler/cli/live_device.hpp"

namespace coupler::cli {
namespace {

constexpr auto what = "this program was built without libmodbus and cannot ask a device";
constexpr auto remedy = "install libmodbus-dev and build it again";

void add_absent(Program& program, Exit& exit, const std::string& name, const std::string& summary) {
  auto command = program.add_command(name, summary + " (not in this build: no libmodbus).");
  command.allow_extras();
  command.callback([&exit, name] { exit = complain(name, failed, what, remedy); });
}

}  // namespace

tl::expected<MapPtr, NoLiveMap> fetch_live_map(const Connection& /*where*/) {
  return tl::make_unexpected(NoLiveMap{failed, what, std::string(remedy) + ", or give the map's file"});
}

tl::expected<FoundMap, NoLiveMap> map_of_unknown_device(std::string_view /*command*/,
                                                        const std::string& /*place*/,
                                                        const TlsTexts& /*tls*/) {
  return tl::make_unexpected(NoLiveMap{failed, what, remedy});
}

Exit dump(const Map& /*map*/, const DumpOptions& /*options*/) {
  return complain("dump", failed, what, remedy);
}

Exit record(const Map& /*map*/, const RecordOptions& /*options*/) {
  return complain("record", failed, what, remedy);
}

#ifdef COUPLER_WITH_TLS
void add_pin(Program& program, Exit& exit) {
  add_absent(program, exit, "pin", "Print the pin of a device's certificate");
}
#endif

void add_probe(Program& program, Exit& exit) {
  add_absent(program, exit, "probe", "Find out what a device answers to");
}

void add_status(Program& program, Exit& exit) {
  add_absent(program, exit, "status", "Show what a node says of itself");
}

}  // namespace coupler::cli
