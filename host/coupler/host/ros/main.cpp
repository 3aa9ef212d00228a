// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/program.hpp"

int main(int argc, char** argv) { return coupler::host::main_with(nullptr, argc, argv); }
