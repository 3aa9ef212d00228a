// SPDX-License-Identifier: Apache-2.0
// The subcommands of `coupler`, one file each. Each function adds one to the program; when the user calls it,
// `exit` tells how it went.
#pragma once

#include "common/cli/exit.hpp"

namespace CLI {
class App;
}

namespace coupler::cli {

void add_check(CLI::App& program, Exit& exit);
void add_diff(CLI::App& program, Exit& exit);
void add_dump(CLI::App& program, Exit& exit);
void add_export(CLI::App& program, Exit& exit);
void add_generate(CLI::App& program, Exit& exit);
void add_import(CLI::App& program, Exit& exit);
void add_init(CLI::App& program, Exit& exit);
void add_plan(CLI::App& program, Exit& exit);
void add_probe(CLI::App& program, Exit& exit);
void add_schema(CLI::App& program, Exit& exit);

}  // namespace coupler::cli
