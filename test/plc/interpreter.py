# SPDX-License-Identifier: Apache-2.0
"""Runs Structured Text (IEC 61131-3) that blark has parsed: as much of the language as an exported map has. It is as strict as
the standard: no conversion but those that are written, no number outside its type. What the PLCs' compilers would convert or
wrap silently is an error here."""
import re
import struct

from blark import transform as ast
from blark.parse import parse_source_code

BITS = {"BOOL": 1, "BYTE": 8, "WORD": 16, "DWORD": 32, "LWORD": 64}
INTEGERS = {name: range(-2**(bits - 1), 2**(bits - 1)) for name, bits in (("SINT", 8), ("INT", 16), ("DINT", 32), ("LINT", 64))}
INTEGERS |= {name: range(2**bits) for name, bits in (("USINT", 8), ("UINT", 16), ("UDINT", 32), ("ULINT", 64))}
FLOATS = ("REAL", "LREAL")
INTEGER_LITERAL, REAL_LITERAL = "an integer literal", "a real literal"


class WrongProgram(Exception):
    """What a compiler would refuse, or what has no defined result."""


def require(condition, *what):
    if not condition:
        raise WrongProgram(*what)


def rounded(kind, number):
    return struct.unpack("f", struct.pack("f", number))[0] if kind == "REAL" else float(number)


def fitting(kind, number):
    require(kind not in INTEGERS or number in INTEGERS[kind], kind, number)
    require(kind not in BITS or 0 <= number < 2**BITS[kind], kind, number)
    return number


class Slot:
    """A variable of an elementary type."""

    def __init__(self, kind):
        require(kind in BITS or kind in INTEGERS or kind in FLOATS, "no such type", kind)
        self.kind = kind
        self.value = {"BOOL": False}.get(kind, 0.0 if kind in FLOATS else 0)

    def assign(self, value):
        self.value = converted_literal(value, self.kind)[1]


def converted_literal(value, kind):
    """A literal has the type that its place needs; all else has it already."""
    have, number = value
    if have == INTEGER_LITERAL and (kind in INTEGERS or kind in BITS and kind != "BOOL"):
        return kind, fitting(kind, number)
    if have == REAL_LITERAL and kind in FLOATS:
        return kind, rounded(kind, number)
    require(have == kind, have, "is not", kind)
    return value


def converted(have, want, number):
    """The standard's function HAVE_TO_WANT."""
    if have in BITS and want in BITS:
        return number & (2**BITS[want] - 1)
    if have in BITS and want in INTEGERS:
        size = INTEGERS[want].stop - INTEGERS[want].start
        return fitting(want, number - size if size == 2**BITS[have] and number not in INTEGERS[want] else number)
    if have in INTEGERS and want in BITS:
        require(INTEGERS[have].stop - INTEGERS[have].start == 2**BITS[want], have, want)
        return number % 2**BITS[want]
    if want in FLOATS:
        return rounded(want, number)
    return fitting(want, round(number))  # halves to the even number


def simple(specification):
    kind = specification
    while not isinstance(kind, str):
        kind = getattr(kind, "type", None) or kind.type_name
    return str(kind)


def flat(initial):
    """blark nests the elements of a list."""
    for element in initial.elements:
        yield from flat(element.element) if isinstance(element.element, ast.ArrayInitialization) else [element.element]


class Program:
    def __init__(self, text):
        self.types, self.functions, self.blocks, self.constants, self.variables = {}, {}, {}, {}, {}
        items = parse_source_code(text).transform().items
        for item in items:
            if isinstance(item, ast.DataTypeDeclaration):
                self.define(self.types, item.declaration.name, item.declaration)
            elif isinstance(item, ast.Function):
                self.define(self.functions, item.name, item)
            elif isinstance(item, ast.FunctionBlock):
                self.define(self.blocks, item.name, item)
        for item in (each for each in items if isinstance(each, ast.GlobalVariableDeclarations)):
            for each in item.items:
                name, = each.spec.variables
                self.define(self.constants if item.attrs else self.variables, name, self.make(each.init))
        names = [*self.types, *self.functions, *self.blocks, *self.constants, *self.variables]
        require(len(set(names)) == len(names), "a name is there twice")

    @staticmethod
    def define(where, name, what):
        key = str(name).lower()
        require(key not in where, name, "is there twice")
        where[key] = what

    def make(self, init):
        """A variable at start: a Slot, a list for an array, a dict for a structure."""
        spec = init.spec
        if isinstance(spec, ast.ArraySpecification):
            subrange, = spec.subranges
            require(int(subrange.start.value) == 0)
            slots = [Slot(simple(spec.type)) for _ in range(int(subrange.stop.value) + 1)]
            values = list(flat(init.value)) if init.value else []
            require(len(values) <= len(slots), "more values than elements")
            for slot, value in zip(slots, values):
                slot.assign(self.evaluate(value, {}))
            return slots
        name = simple(spec)
        if isinstance(spec, ast.StringTypeSpecification) or name.startswith("STRING"):
            return str(init.value.value)
        if name.lower() in self.types:
            members = {}
            for each in self.types[name.lower()].declarations:
                declared, = each.variables
                self.define(members, declared.variable.name, self.make(each.init))
            return members
        slot = Slot(name)
        if init.value is not None:
            slot.assign(self.evaluate(init.value, {}))
        return slot

    def call(self, block, **in_out):
        """Runs a function block on variables of the caller; returns its other variables."""
        block = self.blocks[block]
        local = dict(in_out)
        for declarations in block.declarations:
            for each in declarations.items:
                declared, = each.variables
                name = str(declared.variable.name).lower()
                if isinstance(declarations, ast.InputOutputDeclarations):
                    require(name in local and local[name].keys() == self.make(each.init).keys(), name)
                else:
                    self.define(local, name, self.make(each.init))
        self.run(block.body, local)
        return local

    def function(self, name, value):
        function = self.functions[name]
        local = {name: Slot(simple(function.return_type))}
        for declarations in function.declarations:
            for each in declarations.items:
                declared, = each.variables
                self.define(local, declared.variable.name, self.make(each.init))
                if isinstance(declarations, ast.InputDeclarations):
                    local[str(declared.variable.name).lower()].assign(value)
        self.run(function.body, local)
        return local[name].kind, local[name].value

    def slot(self, variable, local):
        if isinstance(variable, ast.SimpleVariable):
            return local[str(variable.name).lower()]
        found = local[str(variable.name.name).lower()]
        for element in variable.elements:
            if isinstance(element, ast.FieldSelector):
                found = found[str(element.field.name).lower()]
            else:
                subscript, = element.subscripts
                index = self.evaluate(subscript, local)[1]
                require(0 <= index < len(found), "no element", index)
                found = found[index]
        return found

    def run(self, body, local):
        for statement in body.statements if body else ():
            RUN[type(statement)](self, statement, local)

    def assign(self, statement, local):
        variable, = statement.variables
        self.slot(variable, local).assign(self.evaluate(statement.expression, local))

    def condition(self, expression, local):
        return converted_literal(self.evaluate(expression, local), "BOOL")[1]

    def run_if(self, statement, local):
        require(not statement.else_ifs)
        if self.condition(statement.if_expression, local):
            self.run(statement.statements, local)
        elif statement.else_clause:
            self.run(statement.else_clause.statements, local)

    def run_case(self, statement, local):
        kind, number = self.evaluate(statement.expression, local)
        for case in statement.cases:
            if number in [converted_literal(self.evaluate(match, local), kind)[1] for match in case.matches]:
                return self.run(case.statements, local)
        return self.run(statement.else_clause.statements, local)

    def run_for(self, statement, local):
        control = self.slot(statement.control, local)
        first, last = (converted_literal(self.evaluate(each, local), control.kind)[1] for each in (statement.from_, statement.to))
        for number in range(first, last + 1):
            control.value = number
            self.run(statement.statements, local)

    def run_while(self, statement, local):
        while self.condition(statement.expression, local):
            self.run(statement.statements, local)

    def evaluate(self, expression, local):
        """The type and the value."""
        if isinstance(expression, ast.ParenthesizedExpression):
            return self.evaluate(expression.expr, local)
        if isinstance(expression, ast.Boolean):
            return "BOOL", str(expression.value).upper() == "TRUE"
        if isinstance(expression, ast.Real):
            value = REAL_LITERAL, float(str(expression.value))
            return converted_literal(value, str(expression.type_name)) if expression.type_name else value
        if isinstance(expression, (ast.Integer, ast.BitString)):
            value = INTEGER_LITERAL, int(str(expression.value), expression.base)
            return converted_literal(value, str(expression.type_name)) if expression.type_name else value
        if isinstance(expression, ast.UnaryOperation):
            return self.unary(str(expression.op).upper(), *self.evaluate(expression.expr, local))
        if isinstance(expression, ast.BinaryOperation):
            sides = (self.evaluate(each, local) for each in (expression.left, expression.right))
            return self.binary(str(expression.op).upper(), *sides)
        if isinstance(expression, ast.FunctionCall):
            arguments = [self.evaluate(each.value, local) for each in expression.parameters]
            return self.evaluate_call(str(expression.name.name), *arguments)
        slot = self.slot(expression, local)
        return slot.kind, slot.value

    @staticmethod
    def unary(operator, kind, number):
        if operator == "NOT":
            require(kind in BITS, "NOT", kind)
            return kind, number ^ (2**BITS[kind] - 1)
        require(operator == "-" and kind not in BITS, operator, kind)
        return kind, -number

    @staticmethod
    def binary(operator, left, right):
        kind = next((each[0] for each in (left, right) if each[0] not in (INTEGER_LITERAL, REAL_LITERAL)), left[0])
        a, b = (value if value[0] == kind else converted_literal(value, kind) for value in (left, right))
        a, b = a[1], b[1]
        if operator in COMPARISONS:
            return "BOOL", COMPARISONS[operator](a, b)
        if operator in ("AND", "OR"):
            require(kind in BITS, operator, kind)
            return kind, a & b if operator == "AND" else a | b
        require(kind not in BITS, operator, kind)
        if kind in FLOATS:
            return kind, rounded(kind, a / b if operator == "/" else ARITHMETIC[operator](a, b))
        return kind, fitting(kind, ARITHMETIC[operator](a, b))

    def evaluate_call(self, name, value, *rest):
        kind, number = value
        if name.lower() in self.functions:
            return self.function(name.lower(), value)
        conversion = re.fullmatch("([A-Z]+)_TO_([A-Z]+)", name)
        if conversion:
            have, want = conversion.groups()
            require(kind == have, name, kind)
            return want, converted(have, want, number)
        (shift_kind, by), = rest
        require(shift_kind in (INTEGER_LITERAL, "INT") and kind in BITS and 0 <= by < BITS[kind], name, kind)
        wide = {"SHL": number << by, "SHR": number >> by, "ROL": number << by | number >> (BITS[kind] - by)}[name]
        return kind, wide & (2**BITS[kind] - 1)


COMPARISONS = {"=": lambda a, b: a == b, "<>": lambda a, b: a != b, "<": lambda a, b: a < b, ">": lambda a, b: a > b,
               "<=": lambda a, b: a <= b, ">=": lambda a, b: a >= b}
ARITHMETIC = {"+": lambda a, b: a + b, "-": lambda a, b: a - b, "*": lambda a, b: a * b,
              "/": lambda a, b: a // b, "MOD": lambda a, b: a % b}  # of integers that are not negative
RUN = {ast.AssignmentStatement: Program.assign, ast.IfStatement: Program.run_if, ast.CaseStatement: Program.run_case,
       ast.ForStatement: Program.run_for, ast.WhileStatement: Program.run_while}
