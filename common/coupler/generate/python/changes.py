# SPDX-License-Identifier: Apache-2.0
# Behind client.py in a generated file: waiting for changes, docs/time.md.

_WAIT = struct.Struct(">BBHIQ")           # function code, version, wait in ms, epoch, number of the last change
_WAITED = struct.Struct(">BBIQQQIB")      # code, version, epoch, times of arrival and reply, newest number, lost, how many
_TOLD = struct.Struct(">BBHQ")            # table, the new level, address, time
_TABLES = {1: "coils", 2: "discrete_inputs"}


class Change(NamedTuple):
    """A point has another value."""

    point: Input[Any]
    value: Any   # None if the device has none
    time: float  # since when, as time.time(); of a point that is polled, when it was read


class Changes(Iterator[Change]):
    """What Client.changes() returns. After an error the next change may be asked for again, which connects again."""

    def __init__(self, client: Client, points: dict[str, Input[Any]], period: float) -> None:
        self._client, self._points, self._period = client, points, period
        self._values: dict[str, Any] = {}
        self._ready: collections.deque[Change] = collections.deque()
        self._bits = {(point.spec.table, point.spec.read_from + i): (name, i) for name, point in points.items()
                      if point.spec.table in _TABLES.values() for i in range(point.spec.count)}
        self._registers = [name for name, point in points.items() if point.spec.table not in _TABLES.values()]
        self._socket: Any = None  # waits for changes, so that other threads may use the client meanwhile
        self._begun = self._closed = False
        self._epoch = self._number = 0
        self._next_poll = 0.0

    def __next__(self) -> Change:
        while not self._closed:
            if self._ready:
                return self._ready.popleft()
            try:
                self._look()
            except BaseException as error:
                self._end()
                if not (self._closed and isinstance(error, CouplerError)):
                    raise
        self._end()
        raise StopIteration

    def close(self) -> None:
        """Ends the iteration, from any thread: one that waits returns, at the latest after a `period` or a second."""
        self._closed = True
        waiting = self._socket
        if waiting is not None:
            with contextlib.suppress(OSError):
                waiting.shutdown(socket.SHUT_RDWR)

    def _look(self) -> None:
        """Waits for what comes first: a change that the node tells, or the time to poll."""
        if not self._begun:
            self._begin()
            return
        left = self._next_poll - time.monotonic() if self._registers or self._socket is None else 1.0
        if self._socket is None:
            time.sleep(max(0.0, min(left, 1.0)))
        elif not self._hear(min(max(left, 0.0), 1.0)):
            self._poll(list(self._points))  # changes were lost, or the node began anew
        if time.monotonic() >= self._next_poll:
            self._poll(self._registers if self._socket is not None else list(self._points))

    def _begin(self) -> None:
        """Reads everything, after the number of the newest change: what changes meanwhile is told."""
        if self._client._tells_changes():
            self._socket = self._client._connected_modbus().socket
            self._hear(0.0)
        self._begun = True
        self._poll(list(self._points))

    def _poll(self, names: list[str]) -> None:
        self._next_poll = time.monotonic() + self._period
        values, now = self._client._read_some(names), time.time()
        for name in names:
            self._note(name, values[name], now)

    def _note(self, name: str, value: Any, since: float) -> None:
        if name not in self._values or self._values[name] != value:
            self._values[name] = value
            self._ready.append(Change(self._points[name], value, since))

    def _hear(self, wait: float) -> bool:
        """Asks the node, which answers when a bit changes, or after the wait. False: everything has to be read."""
        reply = self._exchange(_WAIT.pack(0x41, 1, int(1000 * wait), self._epoch, self._number), wait)
        now = time.time()
        if reply[0] == 0xC1 and len(reply) == 2:
            raise ExceptionReply(reply[1], "waiting for changes: ")
        if len(reply) < _WAITED.size or len(reply) != _WAITED.size + _TOLD.size * reply[_WAITED.size - 1]:
            raise Lost("malformed reply: it is not that to a wait for changes")
        _, _, epoch, _, replied, newest, lost, count = _WAITED.unpack_from(reply)
        if epoch != self._epoch or lost:
            self._epoch, self._number = epoch, newest
            return False
        self._number += count
        for table, level, address, at in _TOLD.iter_unpack(reply[_WAITED.size:]):
            if level in (0, 1) and (_TABLES.get(table, ""), address) in self._bits:
                name, index = self._bits[_TABLES[table], address]
                value: Any = bool(level)
                if self._points[name].spec.count > 1:
                    value = [*self._values[name][:index], value, *self._values[name][index + 1:]]
                self._note(name, value, now - (replied - at) / 1e9)
        return True

    def _exchange(self, request: bytes, wait: float) -> bytes:
        self._socket.settimeout(wait + self._client.timeout)
        try:
            self._socket.sendall(struct.pack(">HHHB", 0, 0, 1 + len(request), self._client.unit) + request)
            _, protocol, length, _ = struct.unpack(">HHHB", self._receive(7))
            if protocol != 0 or not 2 <= length <= 254:
                raise Lost("malformed reply: not a frame of Modbus/TCP")
            return self._receive(length - 1)
        except OSError as error:
            raise Lost(f"connection lost: {error}") from error

    def _receive(self, size: int) -> bytes:
        data = b""
        while len(data) < size:
            piece: bytes = self._socket.recv(size - len(data))
            if not piece:
                raise ConnectionResetError(errno.ECONNRESET, "the device has closed the connection")
            data += piece
        return data

    def _end(self) -> None:
        waiting, self._socket = self._socket, None
        if waiting is not None:
            waiting.close()
        self._begun, self._epoch, self._number = False, 0, 0
