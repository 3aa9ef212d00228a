# SPDX-License-Identifier: Apache-2.0
# Behind link.py in a generated file, and before what the map makes.


class Point:
    """What the points of a client have in common."""

    def __init__(self, client: Client, spec: Spec) -> None:
        self.spec = spec
        self._client = client
        client._points[spec.name] = self

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.spec.name}>"


class Input(Point, Generic[T]):
    """A point that can be read."""

    def read(self) -> T:
        """Asks the device for the value. Raises NoValue if the device has none."""
        value: T = self._client._read_point(self.spec)
        return value


class Command(Point, Generic[T]):
    """A point that can be written."""

    def write(self, value: T) -> None:
        """Writes the value, and returns when the device has taken it."""
        self._client._write_point(self.spec, self.spec.encode(value))


class Output(Input[T], Command[T]):
    """A point that can be read and written."""


class Client(_Link):
    """The connection to one coupler."""

    fingerprint: int
    # Requests that read every point: table, address, count, names.
    _plan: tuple[tuple[str, int, int, tuple[str, ...]], ...] = ()
    _may_tell_changes = True  # unless the map has `changes: off`, or the device speaks RTU

    def __init__(self, address: str, port: int, unit: int, timeout: float, verify: Verify | str,
                 tls: Tls | ssl.SSLContext | None = None) -> None:
        super().__init__(address, port, unit, timeout, tls)
        self.verify = Verify(verify)
        self._points: dict[str, Any] = {}
        self._lock = threading.RLock()
        self._wanted = False
        self._one_by_one: set[tuple[str, ...]] = set()  # the device rejects these in one request

    @property
    def points(self) -> dict[str, Any]:
        """All points by their names in the map."""
        return dict(self._points)

    def connect(self) -> None:
        """Connects, and compares the maps."""
        with self._lock:
            self._wanted = True
            self._connected()

    def disconnect(self) -> None:
        """Ends the connection. Outputs stay as they are."""
        with self._lock:
            self._wanted = False
            self._drop()

    def read_all(self) -> dict[str, Any]:
        """The values of all points that can be read, by their names in the map; None where the device has none."""
        return self._read_some(self._points)

    def changes(self, *points: Input[Any], period: float = 0.1) -> Changes:
        """Returns an iterator over the changes of these points, or of all: at first each with the value that it has, then
        what is new. A node tells each change of its coils and discrete inputs itself, with its time. The registers, and
        everything of another device, are read each `period`, in seconds."""
        readable = [name for _, _, _, names in self._plan for name in names]
        chosen = [point.spec.name for point in points] or readable
        for name in set(chosen) - set(readable):
            raise ValueError(f"{name} cannot be read, so it has no changes")
        return Changes(self, {name: self._points[name] for name in chosen}, period)

    def __enter__(self: C) -> C:
        self.connect()
        return self

    def __exit__(self, *_: Any) -> None:
        self.disconnect()

    def __setattr__(self, name: str, value: Any) -> None:
        if isinstance(self.__dict__.get(name), Point):
            raise AttributeError(f"{name} is a point; write to it with {name}.write(value)")
        if name == "verify":
            value = Verify(value)  # a word that is none of it must not pass for another one
        super().__setattr__(name, value)

    def _read_point(self, spec: Spec) -> Any:
        with self._lock:
            self._connected()
            known = self._with_exponent(spec)
            power = self._power_of(spec, known)
        words = known[spec.name]
        value = spec.decode(words, power)
        if value is None:
            raise NoValue(f"{spec.name} has no value: {spec.why_none(words)}")
        return value

    def _read_some(self, wanted: Collection[str]) -> dict[str, Any]:
        """The values of these points, and of what comes with them in one request."""
        words: dict[str, list[int]] = {}
        with self._lock:
            self._connected()
            for table, address, count, names in self._plan:
                if any(name in wanted for name in names):
                    words.update(self._read_together(table, address, count, names))
            specs = [self._points[name].spec for name in words]
            return {spec.name: spec.decode(words[spec.name], self._power_of(spec, words)) for spec in specs}

    def _tells_changes(self) -> bool:
        """The device is a node that answers function code 65."""
        with self._lock:
            self._connected()
            try:
                return (self._may_tell_changes and self._read("input_registers", _IDENTITY, 3) == _MAGIC and
                        self._read("input_registers", _FUNCTIONS, 1)[0] & 1 != 0)
            except ExceptionReply:
                return False

    def _with_exponent(self, spec: Spec) -> dict[str, list[int]]:
        """The registers of the point, and if one request has both those of the exponent of its scale."""
        for table, address, count, names in self._plan if spec.exponent_of else ():
            if spec.name in names and spec.exponent_of in names:
                return self._read_together(table, address, count, names)
        return {spec.name: self._read_words(spec)}

    def _read_words(self, spec: Spec) -> list[int]:
        try:
            return self._read_own(spec)
        except ExceptionReply as error:
            raise ExceptionReply(error.code, f"{spec.name}: ") from None

    def _read_own(self, spec: Spec) -> list[int]:
        """The point's registers, by a request for all that the device gives in one piece."""
        first, count = spec.whole or (spec.read_from, spec.count * spec.size)
        return self._read(spec.table, first, count)[spec.read_from - first:][:spec.count * spec.size]

    def _power_of(self, spec: Spec, known: dict[str, list[int]]) -> int | None:
        """The exponent of the scale; None if the device has none. `known`: registers that were read already."""
        if not spec.exponent_of:
            return 0
        exponent = self._points[spec.exponent_of].spec
        power = exponent.decode(known.get(exponent.name) or self._read_words(exponent))
        return power if power is not None and abs(power) <= _MOST_EXPONENT else None

    def _read_together(self, table: str, first: int, count: int, names: tuple[str, ...]) -> dict[str, list[int]]:
        """The registers or bits of each point."""
        specs = [self._points[name].spec for name in names]
        if names not in self._one_by_one:
            try:
                words = self._read(table, first, count)
            except ExceptionReply as error:
                if error.code not in _REJECTED:
                    raise ExceptionReply(error.code, f"{', '.join(names)}: ") from None
                self._one_by_one.add(names)
            else:
                return {spec.name: words[spec.read_from - first:][:spec.count * spec.size] for spec in specs}
        return {spec.name: self._read_words(spec) for spec in specs}

    def _write_point(self, spec: Spec, words: list[int]) -> None:
        with self._lock:
            self._connected()
            try:
                self._write(spec, words)
                if spec.verify_write:
                    self._verify(spec, words)
            except ExceptionReply as error:
                raise ExceptionReply(error.code, f"{spec.name}: ") from None

    def _write(self, spec: Spec, words: list[int]) -> None:
        if spec.mask != 0xFFFF and spec.write_with == 22:
            self._ask("mask_write_register", 22, address=spec.address, and_mask=spec.mask ^ 0xFFFF, or_mask=words[0])
            return
        if spec.mask != 0xFFFF:
            words = [self._read_own(spec)[0] & ~spec.mask | words[0]]
        if spec.write_with == 5:
            self._ask("write_coil", 5, address=spec.address, value=bool(words[0]))
        elif spec.write_with == 15:
            self._ask("write_coils", 15, address=spec.address, values=[bool(word) for word in words])
        elif spec.write_with == 6:
            self._ask("write_register", 6, address=spec.address, value=words[0])
        else:
            self._ask("write_registers", 16, address=spec.address, values=words)

    def _verify(self, spec: Spec, words: list[int]) -> None:
        found = [word & spec.mask for word in self._read_own(spec)]
        if found != words:
            raise NotTaken(f"{spec.name}: {spec.shown(words)!r} was written and acknowledged, but {spec.shown(found)!r} "
                           "reads back")

    def _read(self, table: str, address: int, count: int) -> list[int]:
        method, function, place = _READS[table]
        values = getattr(self._ask(method, function, address=address, count=count), place)
        return [int(value) for value in values[:count]]

    def _connected(self) -> None:
        """There is a connection to a device with this map afterwards."""
        if self._modbus is not None:
            return
        if not self._wanted:
            raise NotConnected("not connected; call connect() first, or use the client in a `with` statement")
        self._open()
        self._one_by_one.clear()
        try:
            self._compare_maps()
        except BaseException:
            self._drop()
            raise

    def _node_address(self) -> str:
        host = f"[{self.address}]" if ":" in self.address else self.address
        address = f"{'tcp' if self._tls is None else 'tls'}://{host}:{self.port}/{self.unit}"
        if not isinstance(self._tls, Tls):
            return address
        options = dataclasses.asdict(self._tls).items()
        return address + "".join(f" --{'tls-name' if key == 'name' else key} {value}" for key, value in options if value)

    def _compare_maps(self) -> None:
        if self.verify is Verify.OFF:
            return
        try:
            area = self._read("input_registers", _IDENTITY, 13)
        except ExceptionReply as error:
            if error.code not in _UNIT_AWAY:
                return  # a foreign coupler
            raise NotConnected(self._silence(f"the gateway answers, but unit {self.unit} does not: {error}")) from error
        except Lost as error:
            why = f"connected, but unit {self.unit} does not answer the request for its identity: {error}"
            raise NotConnected(self._silence(why)) from error
        if area[:3] != _MAGIC:
            return  # a foreign coupler
        found = int.from_bytes(struct.pack(">4H", *area[3:7]), "big")
        if found == self.fingerprint:
            return
        why = (f"the map differs from the device's: fingerprint {self.fingerprint:016x} here, {found:016x} in the device; "
               f"`coupler diff MAP {self._node_address()}` shows the differences")
        if self.verify is Verify.REQUIRE:
            raise OtherMap(f"{why}. Nothing is read or written. Generate this file again from the map that the device has, or "
                           "accept it with verify=Verify.WARN")
        _log.warning("%s", why)

    def _silence(self, why: str) -> str:
        return (f"{why}; check that the device runs, and that 'unit' is its unit id. If it is a foreign coupler that ignores "
                "addresses it does not have, give verify=Verify.OFF")
