# SPDX-License-Identifier: Apache-2.0
"""An exported map as a program, and one direction of it. COUPLER is the program that exports."""
import os
import subprocess

from interpreter import Program

READ = {1: "coils", 2: "discrete_inputs", 3: "holding_registers", 4: "input_registers"}
WRITTEN = {5: "coils", 6: "holding_registers", 15: "coils", 16: "holding_registers"}


def coupler(*arguments):
    return subprocess.run([os.environ["COUPLER"], *map(str, arguments)], capture_output=True, text=True,
                          encoding="utf-8", check=True)


def exported(file):
    return Program(coupler("export", file, "--to", "st").stdout)


class Side:
    """What is read, or what is written: variables, the image, and which request each part of it is."""

    def __init__(self, program, verb, values, block, tables):
        self.program = program
        self.block, = [name for name in program.blocks if name.endswith(block)]
        prefix = self.block.removesuffix(block)
        self.values, self.image = program.variables[prefix + values], program.variables[f"{prefix}_{verb}_image"]
        self.parts = []
        for name, cells in self.image.items():
            function, address, quantity = (program.constants[f"{prefix}_{verb}_{name}_{key}"].value
                                           for key in ("function", "address", "quantity"))
            self.parts.append((tables[function], address, quantity, cells))

    def run(self, **more):
        return self.program.call(self.block, image=self.image, values=self.values, **more)

    def part(self, table, address, count):
        """The cells that hold these addresses, which one request has, and where they begin there."""
        found = [(cells, address - first) for at, first, quantity, cells in self.parts
                 if at == table and first <= address and address + count <= first + quantity]
        return found[0]

    def put(self, table, address, raw, mask=0xFFFF):
        cells, at = self.part(table, address, len(raw))
        for i, value in enumerate(raw, at):
            if isinstance(value, int):
                cells[i // 8].value = cells[i // 8].value & ~(1 << i % 8) | value << i % 8
            else:
                cells[i].value = cells[i].value & ~mask | int(value, 16) & mask

    def get(self, table, address, raw):
        """As many as `raw` has, in its form."""
        cells, at = self.part(table, address, len(raw))
        return [cells[i // 8].value >> i % 8 & 1 if isinstance(value, int) else f"{cells[i].value:04X}"
                for i, value in enumerate(raw, at)]

    def fill(self, ones):
        for cells in self.image.values():
            for cell in cells:
                cell.value = 2**(8 if cell.kind == "BYTE" else 16) - 1 if ones else 0


def slots(variable):
    return variable if isinstance(variable, list) else [variable]
