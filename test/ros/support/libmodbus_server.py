# SPDX-License-Identifier: Apache-2.0
"""A unit on a serial line, served by libmodbus."""
import ctypes
import threading

from support.patience import PATIENCE

LONGEST = 256  # bytes of a frame
LOOK = 100000  # microseconds from a look whether it shall end to the next

# pylint: disable=too-few-public-methods


class _Mapping(ctypes.Structure):
    """modbus_mapping_t"""
    _fields_ = [(f"{what}_{table}", ctypes.c_int) for table in ("bits", "input_bits", "input_registers", "registers")
                for what in ("nb", "start")] + [
        ("bits", ctypes.POINTER(ctypes.c_uint8)), ("input_bits", ctypes.POINTER(ctypes.c_uint8)),
        ("input_registers", ctypes.POINTER(ctypes.c_uint16)), ("registers", ctypes.POINTER(ctypes.c_uint16))]


def _library():
    """OSError: it is not installed."""
    library = ctypes.CDLL("libmodbus.so.5", use_errno=True)
    library.modbus_new_rtu.restype = ctypes.c_void_p
    library.modbus_new_rtu.argtypes = [ctypes.c_char_p, ctypes.c_int, ctypes.c_char, ctypes.c_int, ctypes.c_int]
    library.modbus_mapping_new.restype = ctypes.POINTER(_Mapping)
    library.modbus_set_slave.argtypes = [ctypes.c_void_p, ctypes.c_int]
    library.modbus_set_indication_timeout.argtypes = [ctypes.c_void_p, ctypes.c_uint32, ctypes.c_uint32]
    library.modbus_receive.argtypes = [ctypes.c_void_p, ctypes.c_char_p]
    library.modbus_reply.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int, ctypes.POINTER(_Mapping)]
    library.modbus_mapping_free.argtypes = [ctypes.POINTER(_Mapping)]
    for name in ("connect", "close", "free"):
        getattr(library, f"modbus_{name}").argtypes = [ctypes.c_void_p]
    return library


class LibmodbusServer:
    """`unit` has `size` of everything."""

    def __init__(self, unit, device, size=100):
        self._library = _library()
        self._context = self._library.modbus_new_rtu(device.encode(), 115200, b"N", 8, 1)
        self._library.modbus_set_slave(self._context, unit)
        self._library.modbus_set_indication_timeout(self._context, 0, LOOK)
        if self._library.modbus_connect(self._context) != 0:
            raise OSError(ctypes.get_errno(), f"libmodbus cannot open {device}")
        self._mapping = self._library.modbus_mapping_new(size, size, size, size)
        self._over = False
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def _serve(self):
        request = ctypes.create_string_buffer(LONGEST)
        while not self._over:
            length = self._library.modbus_receive(self._context, request)  # -1: silence, or a damaged frame; 0: of others
            if length > 0:
                self._library.modbus_reply(self._context, request, length, self._mapping)

    def set(self, _unit, function, address, values):
        tables = self._mapping.contents
        table = {1: tables.bits, 2: tables.input_bits, 3: tables.registers, 4: tables.input_registers}[function]
        for i, value in enumerate(values):
            table[address + i] = value

    def end(self):
        self._over = True
        self._thread.join(PATIENCE)
        self._library.modbus_close(self._context)
        self._library.modbus_free(self._context)
        self._library.modbus_mapping_free(self._mapping)
