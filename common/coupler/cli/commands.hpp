// SPDX-License-Identifier: Apache-2.0
// The subcommands of `coupler`, one file each. Each function adds one to the program; when the user calls it,
// `exit` tells how it went.
#pragma once

#include "coupler/cli/exit.hpp"
#include "coupler/command_line/command_line.hpp"

namespace coupler::cli {

using command_line::Program;

void add_check(Program& program, Exit& exit);
void add_diff(Program& program, Exit& exit);
void add_dump(Program& program, Exit& exit);
void add_export(Program& program, Exit& exit);
void add_generate(Program& program, Exit& exit);
void add_import(Program& program, Exit& exit);
void add_init(Program& program, Exit& exit);
void add_plan(Program& program, Exit& exit);
void add_probe(Program& program, Exit& exit);
void add_schema(Program& program, Exit& exit);
void add_status(Program& program, Exit& exit);

}  // namespace coupler::cli
