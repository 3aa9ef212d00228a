// SPDX-License-Identifier: Apache-2.0
#include "host/ros/program.hpp"

int main(int argc, char** argv) { return coupler::driver::main_with(nullptr, argc, argv); }
