# SPDX-License-Identifier: Apache-2.0
"""The parameters of a node as `ros2 param` asks for them."""
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import (DescribeParameters, GetParameters, GetParameterTypes, ListParameters, SetParameters,
                                SetParametersAtomically)

from support.process import write_map
from support.topics import service

BOOL, WHOLE, REAL = ParameterType.PARAMETER_BOOL, ParameterType.PARAMETER_INTEGER, ParameterType.PARAMETER_DOUBLE
TEXT, TEXTS, UNSET = ParameterType.PARAMETER_STRING, ParameterType.PARAMETER_STRING_ARRAY, ParameterType.PARAMETER_NOT_SET

FIELDS = {BOOL: "bool_value", WHOLE: "integer_value", REAL: "double_value", TEXT: "string_value",
          TEXTS: "string_array_value"}
SERVICES = {
    "describe_parameters": DescribeParameters, "get_parameter_types": GetParameterTypes, "get_parameters": GetParameters,
    "list_parameters": ListParameters, "set_parameters": SetParameters,
    "set_parameters_atomically": SetParametersAtomically,
}


def value_of(message):
    return getattr(message, FIELDS[message.type]) if message.type != UNSET else None


def parameter(name, kind, value):
    return Parameter(name=name, value=ParameterValue(type=kind, **{FIELDS[kind]: value}))


class Parameters:
    def __init__(self, node):
        self._node = node

    def call(self, name, *arguments):
        return service(f"{self._node}/{name}", SERVICES[name])(*arguments)

    def list(self, *prefixes, depth=0):
        return self.call("list_parameters", list(prefixes), depth).result

    def describe(self, *names):
        return self.call("describe_parameters", list(names)).descriptors

    def types(self, *names):
        return list(self.call("get_parameter_types", list(names)).types)

    def get(self, *names):
        return [value_of(value) for value in self.call("get_parameters", list(names)).values]

    def set(self, *parameters):
        return self.call("set_parameters", list(parameters)).results

    def set_all(self, *parameters):
        return self.call("set_parameters_atomically", list(parameters)).result


def write_parameters(sections):
    """A file for --params-file: {node: the lines of its parameters}."""
    text = ""
    for node, lines in sections.items():
        text += f"{node}:\n  ros__parameters:\n" + "".join(f"    {line}\n" for line in lines.strip().splitlines())
    return write_map(text)
