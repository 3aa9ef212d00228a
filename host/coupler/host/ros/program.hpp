// SPDX-License-Identifier: Apache-2.0
#pragma once

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
