# SPDX-License-Identifier: Apache-2.0
# Behind client.py in the file of a map whose coupler speaks RTU.


class RtuClient(Client):
    """The connection to a coupler that speaks RTU, here over TCP."""

    _may_tell_changes = False

    def _new_modbus(self) -> Any:
        framer: Any = inspect.signature(_ModbusTcpClient).parameters["framer"].default
        if isinstance(framer, enum.Enum):
            kinds: Any = type(framer)
            framer = kinds.RTU
        else:  # releases before 3.6 take a class
            framer = importlib.import_module("pymodbus.transaction").ModbusRtuFramer
        return self._on_socket(framer=framer)

    def _node_address(self) -> str:
        return "rtu+" + super()._node_address()

    def _has_id_of_request(self, reply: Any) -> bool:
        """There is no transaction number, but the unit."""
        for name in ("dev_id", "slave_id", "unit_id"):  # pymodbus has changed its mind
            if hasattr(reply, name):
                return bool(getattr(reply, name) == self.unit)
        return True

    def _ask(self, method: str, function: int, **request: Any) -> Any:
        try:
            return super()._ask(method, function, **request)
        except ExceptionReply:
            raise
        except BaseException:
            # The answer may still come, and nothing tells which request it is for.
            self._next_request = time.monotonic() + self.timeout
            raise


class SerialClient(RtuClient):
    """The connection to a coupler on a serial line."""

    rs485 = False  # the port's driver switches the direction

    def __init__(self, device: str, baud: int, parity: str, stop_bits: int, unit: int, timeout: float,
                 verify: Verify | str) -> None:
        if parity not in ("none", "even", "odd"):
            raise ValueError(f"parity {parity!r}: give 'none', 'even' or 'odd'")
        super().__init__("", 0, unit, timeout, verify)
        self.device, self.baud, self.parity, self.stop_bits = device, baud, parity, stop_bits

    def _new_modbus(self) -> Any:
        try:
            ModbusSerialClient: Any = importlib.import_module("pymodbus.client").ModbusSerialClient
            serial: Any = importlib.import_module("serial")
            rs485: Any = importlib.import_module("serial.rs485")
        except ImportError as missing:
            raise NotConnected("pyserial is needed for a serial line; install it with `apt install python3-serial` or `pip "
                               "install pyserial`") from missing
        modbus = ModbusSerialClient(self.device, baudrate=self.baud, parity=self.parity[0].upper(), stopbits=self.stop_bits,
                                    bytesize=8, timeout=self.timeout, retries=0)
        if hasattr(modbus, "params"):
            modbus.params.timeout = self.timeout  # 3.0 cuts it to whole seconds
        if not modbus.connect():
            serial.Serial(self.device, exclusive=True).close()  # raises the reason, which pymodbus keeps to itself
            raise OSError("the port cannot be opened; the log of pymodbus has the reason")
        modbus.socket.exclusive = True  # some releases share the port
        if self.rs485:
            modbus.socket.rs485_mode = rs485.RS485Settings()
        return modbus

    def _place(self) -> str:
        return self.device

    def _advice(self) -> str:
        return "that the port is there, that nobody else uses it, and that you may: `sudo adduser $USER dialout`"

    def _node_address(self) -> str:
        return f"'rtu:{self.device}/{self.unit}?baud={self.baud}&parity={self.parity}&stop_bits={self.stop_bits}'"
