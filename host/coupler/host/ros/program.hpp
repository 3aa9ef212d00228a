// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <string_view>

#include "coupler/host/ros/options.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

// The exit codes of a driver, besides 0.
constexpr int wrong_input = 1;  ///< the map or a parameter is wrong, or something else has failed
constexpr int wrong_call = 2;   ///< the arguments are wrong
constexpr int not_safe = 3;     ///< an output should have its safe value at the end and has not

/// The whole of a driver program, for the ROS that it is built for: coupler_driver (without a built-in map)
/// and generated ones. Returns the exit code; 0 after one of coupler::ending_signals. After SIGQUIT it does
/// not return, but leaves a core.
int main_with(const Map* built_in, int argc, char** argv);

/// How coupler::ending_signals (SIGINT, SIGTERM, SIGHUP, …) end a driver.
struct Shutdown {
  static std::atomic<bool> requested;  ///< by a signal, or a failed thread; every wait looks at it
  static std::atomic<bool> has_failed_thread;

  /// Before an output may be driven: from now on the shutdown must be orderly. Does not return if a second
  /// signal ends the program at this moment.
  static void begin_driving();
  /// Returns whether begin_driving() was called.
  static bool is_driving();

  /// The rest takes as long as devices, ROS and disks take. After `patience` a signal, SIGALRM too, exits
  /// with this code, but not sooner, since a launch tool may pass on a signal that the terminal has sent,
  /// too.
  static void begin_to_end(int exit_code, std::chrono::seconds patience);

  /// A signal exits with status 0, as long as nothing has been started that would have to be stopped.
  static void exit_on_signals();
  /// A signal calls this; a second one exits, since ROS may wait for a master that does not answer.
  static void unregister_on_signals(void (*shut_down)());
  /// A signal sets `requested`. While nothing has been driven a second one exits at once, so that nobody has
  /// to wait for a device or a ROS master that does not answer.
  static void request_on_signals();
};

/// Does what a driver has to do first. A signal exits until Shutdown::request_on_signals().
void begin_program();

/// From now on no thread waits for whoever reads standard output and standard error, and none ends the
/// program by going away.
void never_wait_for_readers();

/// An exception that no thread has caught is told and, once an output may be driven, requests the shutdown;
/// its thread stands still, with the locks that it holds. The main thread's ends the program at once.
void end_safely_on_uncaught_exceptions();

/// Prints the text of arguments that end the program, and returns the exit code.
int end_of(const Options& arguments);

/// To standard error, for what happens before there is a node; escaped as Node::log() does.
void print_message(std::string_view text);

}  // namespace coupler::host
