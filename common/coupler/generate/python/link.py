# SPDX-License-Identifier: Apache-2.0
# Behind tls.py in a generated file: how requests are made.


@functools.lru_cache(maxsize=None)
def _names_of_unit(method: str) -> tuple[str, ...]:
    """pymodbus calls the unit id `slave` at first and `device_id` since 3.10. Where a call takes any name (FC 22 of the first
    releases) it is `unit` or `slave`, and the other one has no meaning."""
    parameters = inspect.signature(getattr(_ModbusTcpClient, method)).parameters
    return tuple(name for name in ("device_id", "slave") if name in parameters) or ("unit", "slave")


class _Link:
    """The connection that a client makes its requests on, by pymodbus."""

    _request_gap = 0.0    # seconds between a reply and the next request
    _connect_delay = 0.0  # seconds between connecting and the first request

    def __init__(self, address: str, port: int, unit: int, timeout: float, tls: Tls | ssl.SSLContext | None) -> None:
        self.address, self.port, self.unit, self.timeout = address, port, unit, timeout
        self._tls = tls
        self._modbus: Any = None
        self._next_request = 0.0

    @property
    def online(self) -> bool:
        """There is a connection, as far as is known, and the maps fit."""
        return self._modbus is not None

    def _open(self) -> None:
        """Connects. Raises NotConnected."""
        self._modbus = self._connected_modbus()
        self._next_request = max(self._next_request, time.monotonic() + self._connect_delay)

    def _connected_modbus(self) -> Any:
        """Returns a client of pymodbus that is connected. Raises NotConnected."""
        try:
            return self._new_modbus()
        except NotConnected:
            raise
        except (OSError, ValueError) as error:
            why = getattr(error, "strerror", None) or error
            raise NotConnected(f"cannot connect to {self._place()}: {why}; check {self._advice()}",
                               _number_of(error)) from error

    def _new_modbus(self) -> Any:
        return self._on_socket()

    def _on_socket(self, **options: Any) -> Any:
        """The socket is made here, since pymodbus keeps to itself why it cannot connect. It repeats no requests: it would
        connect for them by itself, and nobody would compare the maps."""
        modbus = _ModbusTcpClient(self.address, port=self.port, timeout=self.timeout, retries=0, **options)
        if hasattr(modbus, "params"):
            modbus.params.timeout = self.timeout  # 3.0 cuts it to whole seconds
        context = self._tls.context() if isinstance(self._tls, Tls) else self._tls
        modbus.socket = socket.create_connection((self.address, self.port), timeout=self.timeout)
        if context is not None:
            self._shake_hands(modbus, context)
        return modbus

    def _shake_hands(self, modbus: Any, context: ssl.SSLContext) -> None:
        tls = self._tls if isinstance(self._tls, Tls) else None
        plain = modbus.socket
        try:
            modbus.socket = context.wrap_socket(plain, server_hostname=tls.name if tls and tls.name else self.address)
            if tls:
                tls.check_pin(modbus.socket.getpeercert(binary_form=True))
        except BaseException:
            plain.close()
            modbus.close()
            raise
        modbus.recv = functools.partial(_receive, modbus, self.timeout)

    def _place(self) -> str:
        return f"{self.address} port {self.port}"

    def _advice(self) -> str:
        if self._tls is None:
            return "that the device runs, and its address and port"
        return "that the device runs, its address and its port for TLS, and that both certificates are of the right authority"

    def _ask(self, method: str, function: int, **request: Any) -> Any:
        """Makes a request of pymodbus and waits for the answer, for the timeout at most."""
        time.sleep(max(0.0, self._next_request - time.monotonic()))
        call = getattr(self._modbus, method)
        began = time.monotonic()
        try:
            # A copy: pymodbus 3.9 fills up the list of bits.
            reply = call(**copy.deepcopy(request), **{name: self.unit for name in _names_of_unit(method)})
        except BaseException as error:
            # Its late answer must never be taken for that to the next request.
            self._drop()
            if not isinstance(error, Exception):
                raise
            raise self._lost(began, error) from error  # whatever pymodbus ran into
        self._next_request = time.monotonic() + self._request_gap
        if isinstance(reply, Exception):
            self._drop()
            raise self._lost(began, reply) from reply
        if not self._answers(reply, function, request):
            self._drop()
            raise Lost("malformed reply: the reply to another request")
        code = getattr(reply, "exception_code", 0)
        if code:
            if code in _UNIT_AWAY:
                self._drop()  # another unit may come back: the maps are compared again
            raise ExceptionReply(code)
        if reply.isError():
            self._drop()
            raise self._lost(began, reply)
        return reply

    def _answers(self, reply: Any, function: int, request: dict[str, Any]) -> bool:
        """The reply is that to this request. pymodbus does not see to it: 3.0 compares no ids, and no release the rest."""
        if not self._has_id_of_request(reply):
            return False
        if reply.function_code & 0x7F != function:
            return False
        if reply.function_code & 0x80:
            return True  # an exception says no more
        if function in (1, 2):
            return len(reply.bits) == int(request["count"] + 7) // 8 * 8
        if function in (3, 4):
            return len(reply.registers) == int(request["count"])
        if reply.address != request["address"]:
            return False
        if function in (15, 16):
            return len(request["values"]) == int(reply.count)
        if function == 22:
            return (reply.and_mask, reply.or_mask) == (request["and_mask"], request["or_mask"])
        # 5 and 6; later releases have no `value`.
        values = [reply.value] if hasattr(reply, "value") else reply.bits if function == 5 else reply.registers
        return list(values) == [request["value"]]

    def _has_id_of_request(self, reply: Any) -> bool:
        transaction = getattr(self._modbus, "transaction", None)
        asked = getattr(transaction, "tid", getattr(transaction, "next_tid", None))  # later releases have the second
        return asked is None or bool(reply.transaction_id == asked)

    def _lost(self, began: float, why: Any) -> Lost:
        if time.monotonic() - began >= 0.99 * self.timeout:
            return Lost(f"no reply within {1000 * self.timeout:.0f} ms")
        return Lost(f"connection lost: {why}")

    def _drop(self) -> None:
        modbus, self._modbus = self._modbus, None
        if modbus is not None:
            modbus.close()
