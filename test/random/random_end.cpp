// SPDX-License-Identifier: Apache-2.0
// A generated end of a random map as a program of its own. Reads commands, a line each, and answers "ok" or
// what is wrong, until the input ends.
//   random_end client NAME PORT           "set ROUND": sets all outputs; "get ROUND": waits for all that can
//   be read;
//                                         "get ROUND outputs": only for those that can be written, too
//   random_end firmware NAME OPTIONS…     a node; "show ROUND": what clients read of points with hooks
#include <chrono>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <sstream>
#include <thread>

#include "coupler/device/node/program.hpp"
#include "test/random/subject.hpp"

namespace coupler::random {
namespace {

using namespace std::chrono_literals;
constexpr auto soon = 120s;  // tells hanging from working

struct Command {
  std::string what;
  std::size_t round = 0;
  std::string which;
};

/// `answer(command)` gives what is wrong, or nothing.
template <class Answer>
void obey(Answer answer) {
  for (std::string line; std::getline(std::cin, line);) {
    Command command;
    std::istringstream(line) >> command.what >> command.round >> command.which;
    const std::string wrong = answer(command);
    std::cout << (wrong.empty() ? "ok" : wrong) << std::endl;
  }
}

std::string set_all(const Map& map, ClientEnd& client, std::size_t round) {
  std::string wrong;
  for (std::uint32_t i = 0; i < map.points.size(); ++i) {
    const test_vectors::Cases cases = test_vectors::cases_of(map.points[i]);
    const test_vectors::Case& sent = pick(cases, i, round);
    if (!is_settable(map.points[i]) || sent.only_read) continue;
    if (const auto result = client.set(i, sent.values).get(); !result)
      wrong += std::string(map.points[i].name) + " " + result.text + "; ";
  }
  return wrong;
}

std::string wait_for_all(const Map& map, ClientEnd& client, const Command& command) {
  std::string wrong;
  const auto end = std::chrono::steady_clock::now() + soon;
  for (std::uint32_t i = 0; i < map.points.size(); ++i) {
    const test_vectors::Cases cases = test_vectors::cases_of(map.points[i]);
    const test_vectors::Case& wanted = pick(cases, i, command.round);
    const bool asked = command.which != "outputs" || is_settable(map.points[i]);
    if (!is_readable(map.points[i]) || !asked) continue;
    std::optional<Values> got = client.get(i);
    while (!(got && same_bits(*got, wanted.values)) && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(1ms);
      got = client.get(i);
    }
    if (!got || !same_bits(*got, wanted.values))
      wrong += std::string(map.points[i].name) + " is " + (got ? to_string(*got) : "not there") + ", not " +
               to_string(wanted.values) + "; ";
  }
  return wrong;
}

int run_client(const Subject& subject, const char* port) {
  client::Options options;
  options.address = "127.0.0.1";
  options.port = static_cast<std::uint16_t>(std::atoi(port));
  options.on_report = [](client::Level, const std::string& text) { std::cerr << text << std::endl; };
  const auto client = subject.client(std::move(options));
  client->session().connect();
  if (!client->session().wait_online(soon)) return 3;
  obey([&](const Command& command) {
    return command.what == "set" ? set_all(*subject.map, *client, command.round)
                                 : wait_for_all(*subject.map, *client, command);
  });
  return 0;
}

/// For as long as the process that serves lives.
[[noreturn]] void show(const Subject& subject, FirmwareEnd& firmware) {
  obey([&](const Command& command) {
    std::string wrong;
    for (std::uint32_t i = 0; i < subject.map->points.size(); ++i) {
      const test_vectors::Cases cases = test_vectors::cases_of(subject.map->points[i]);
      const test_vectors::Case& shown = pick(cases, i, command.round);
      if (is_set_by_firmware(subject.map->points[i]) && !shown.only_read && !firmware.put(i, shown.values))
        wrong += std::string(subject.map->points[i].name) + " is refused; ";
    }
    return wrong;
  });
  for (;;) std::this_thread::sleep_for(1h);
}

int run_firmware(const Subject& subject, int argc, char** argv) {
  const auto firmware = subject.firmware();
  firmware->when_serving = [&] { std::thread(show, std::cref(subject), std::ref(*firmware)).detach(); };
  return device::main_with(*subject.map, firmware->hooks(), argc, argv);
}

}  // namespace
}  // namespace coupler::random

int main(int argc, char** argv) {
  using namespace coupler::random;
  if (argc < 4) return 2;
  for (const Subject& subject : subjects())
    if (subject.name == argv[2])
      return std::string(argv[1]) == "client" ? run_client(subject, argv[3])
                                              : run_firmware(subject, argc - 2, argv + 2);
  return 2;
}
