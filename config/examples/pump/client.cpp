// SPDX-License-Identifier: Apache-2.0
// Starts the pump of pump.yaml and tells what it does: pump_control HOST PORT
#include <cstdio>
#include <cstdlib>

#include "pump_client.hpp"

using namespace std::chrono_literals;

namespace {

/// Returns whether the pump took the value, and says so if it did not.
bool is_taken(const char* what, coupler::client::PendingWrite pending) {
  const coupler::client::SetResult result = pending.get();
  std::printf("%s: %s\n", what, result.text.c_str());
  return static_cast<bool>(result);
}

/// The node's own timer stops it, even if this program has ended by then. Here the outcome is waited for.
bool stops_in(std::chrono::seconds time, coupler::maps::pump::Client& pump) {
  auto stop = pump.run.schedule(false, std::chrono::steady_clock::now() + time);
  std::printf("stop in %d s: %s\n", static_cast<int>(time.count()), stop.text().c_str());
  const auto result = stop.wait(time + 10s);
  if (!result) return false;
  std::printf("it %s\n", *result ? "has stopped" : result->reason.c_str());
  return static_cast<bool>(*result);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("pump_control HOST PORT, as in: pump_control 127.0.0.1 1502\n", stderr);
    return 2;
  }
  coupler::client::Options options;
  options.address = argv[1];
  options.port = static_cast<std::uint16_t>(std::atoi(argv[2]));
  options.on_report = [](coupler::client::Level, const std::string& text) {
    std::fprintf(stderr, "%s\n", text.c_str());
  };
  coupler::maps::pump::Client pump(options);
  pump.running.on_change([](bool turns) { std::printf("the motor %s\n", turns ? "turns" : "stands"); });
  pump.connect();
  if (!pump.wait_online(10s)) return 3;

  is_taken("set the speed to 7000 %", pump.speed.set(7000.0));  // refused here: no such value
  is_taken("set the speed to 5 %", pump.speed.set(5.0));        // refused there: the firmware's rule
  if (!is_taken("open the valve", pump.valve.set(true)) || !is_taken("start", pump.run.set(true)) ||
      !is_taken("set the speed to 80 %", pump.speed.set(80.0)))
    return 1;
  is_taken("close the valve", pump.valve.set(false));  // not while it runs

  for (int tries = 0; tries < 100; ++tries) {
    const auto pressure = pump.pressure.wait(10s);
    const auto starts = pump.starts.wait(10s);
    const auto running = pump.running.wait(10s);
    if (!pressure || !starts || !running) {
      std::fputs("the pump does not tell how it is\n", stderr);
      return 3;
    }
    if (running->value && pressure->value > 4) {
      std::printf("%.2f bar after %u starts\n", pressure->value, starts->value);
      return stops_in(5s, pump) ? 0 : 1;
    }
    std::this_thread::sleep_for(20ms);
  }
  std::fputs("no pressure builds up\n", stderr);
  return 1;
}
