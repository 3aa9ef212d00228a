# SPDX-License-Identifier: Apache-2.0
# Behind begin.py in a generated file: what a point is, and what its registers mean.


def _reordered(words: list[int], order: str) -> list[int]:
    """Registers, the most significant first, as they stand in the device, and back: each order undoes itself."""
    if order in ("CDAB", "DCBA"):
        words = words[::-1]
    return [(word & 0xFF) << 8 | word >> 8 for word in words] if order in ("BA", "BADC", "DCBA") else words


def _words(data: bytes, order: str) -> list[int]:
    return _reordered(list(struct.unpack(f">{len(data) // 2}H", data)), order)


def _bytes(words: list[int], order: str) -> bytes:
    return struct.pack(f">{len(words)}H", *_reordered(words, order))


def _shortest(number: float) -> float:
    """Returns 0.1 for the REAL that Python reads as 0.10000000149011612: the fewest digits that are the same REAL."""
    for digits in range(1, 10):  # nine are always enough
        short = float(f"{number:.{digits}g}")
        try:
            if struct.pack(">f", short) == struct.pack(">f", number):
                return short
        except OverflowError:
            pass  # the greatest REAL with so few digits is beyond it
    return number  # a NaN with bits of its own


@dataclass(frozen=True)
class Spec:
    """A point as the map describes it. Addresses are zero-based."""

    name: str
    table: str
    address: int
    type: str
    size: int = 1                      # registers or bits of one value
    count: int = 1                     # values; more than one: an array
    order: str = "AB"
    mask: int = 0xFFFF                 # which bits of the register are the point's
    write_with: int = 0                # function code
    read_address: int | None = None    # where it reads back, if not at `address`
    whole: tuple[int, int] | None = None  # what a request has to read for it, if more: first, count
    verify_write: bool = False         # read back after a write
    length: int = 0                    # bytes of a text
    encoding: str = ""
    gain: float = 1.0
    offset: float = 0.0
    exponent_of: str = ""              # the point with the exponent n: the gain is multiplied by 10^n
    invalid: tuple[tuple[int, int], ...] = ()  # raw values that are none: first, last
    fault_below: float = -math.inf     # raw values beyond are faults
    fault_above: float = math.inf
    units: str = ""
    least: float = -math.inf           # `min` and `max` of the map, as the registers hold them
    most: float = math.inf
    nonfinite: bool = False            # NaN and the infinities may be written
    allowed: str = "a finite number"   # which values may be written, in words
    names: Any = None                  # of its values, an IntEnum

    @property
    def read_from(self) -> int:
        return self.address if self.read_address is None else self.read_address

    @property
    def scaled(self) -> bool:
        return self.gain != 1 or self.offset != 0 or self.exponent_of != ""

    def decode(self, words: list[int], power: int | None = 0) -> Any:
        """The value in `count * size` registers or bits; None if there is none. `power`: the exponent of the scale."""
        parts = [words[at:at + self.size] for at in range(0, self.count * self.size, self.size)]
        if power is None or any(self._is_invalid(part) or self._is_fault(part) for part in parts):
            return None
        return self.shown(words, power)

    def shown(self, words: list[int], power: int = 0) -> Any:
        """The same of any registers, whether they are a value or not."""
        values = [self._decode_one(words[at:at + self.size], power) for at in range(0, self.count * self.size, self.size)]
        return values if self.count > 1 else values[0]

    def encode(self, value: Any) -> list[int]:
        """The registers or bits, those of other points 0. Raises Refused."""
        if self.count == 1:
            return self._encode_one(value)
        try:
            values = list(value)
        except TypeError:
            self.refuse(f"{value!r} is one value; give {self.count}")
        if isinstance(value, (str, bytes)) or len(values) != self.count:
            self.refuse(f"{value!r} has {len(values)} values; give {self.count}")
        return [word for one in values for word in self._encode_one(one)]

    def refuse(self, why: str) -> NoReturn:
        raise Refused(f"{self.name}: refused: {why}")

    def _is_invalid(self, words: list[int]) -> bool:
        if not self.invalid:
            return False
        is_part = self.mask != 0xFFFF and self.type != "BOOL"  # of a BOOL it is the value of its register
        raw = self._part(words) if is_part else int.from_bytes(_bytes(words, self.order), "big")
        return any(first <= raw <= last for first, last in self.invalid)

    def why_none(self, words: list[int]) -> str:
        for at in range(0, self.count * self.size, self.size):
            part = words[at:at + self.size]
            if self._is_invalid(part):
                return f"the device gives 0x{_bytes(part, self.order).hex().upper()}, which the map calls invalid"
            if self._is_fault(part):
                end = "below fault_below" if self._raw(part) < self.fault_below else "above fault_above"
                return f"the device gives {self._raw(part)}, {end}"
        return f"{self.exponent_of}, the exponent of its scale, has no value, or is out of range"

    def _is_fault(self, words: list[int]) -> bool:
        if math.isinf(self.fault_below) and math.isinf(self.fault_above):
            return False
        raw = self._raw(words)
        return bool(raw < self.fault_below or raw > self.fault_above)

    def _decode_one(self, words: list[int], power: int) -> Any:
        if self.type == "BOOL":
            return words[0] & self.mask != 0
        if self.type == "STRING":
            data = _bytes(words, self.order)[:self.length].split(b"\0")[0]
            if self.encoding == "ascii":
                return data.decode("ascii", "replace").replace("\ufffd", "?")
            return data.decode(self.encoding, "backslashreplace")
        raw = self._raw(words)
        if self.scaled:
            gain = self.gain * 10.0 ** power if power >= 0 else self.gain / 10.0 ** -power
            return self._without_last_digits(float(raw) * gain + self.offset, raw, gain)
        if self.type == "REAL":
            return _shortest(raw)
        return raw if self._name_of(raw) is None else self._name_of(raw)

    def _without_last_digits(self, value: float, raw: int | float, gain: float) -> float:
        """Returns 72.6 for 72.60000000000001, as `coupler dump` does: the digits behind the fifteenth come from the
        multiplication, unless it takes them to tell the raw number from others."""
        short = float(f"{value:.15g}")
        same = math.isfinite(short) and gain != 0 and self._nearest_raw(short, gain) == raw
        return short if same else value

    def _nearest_raw(self, value: float, gain: float) -> int | float | None:
        """The raw number that is published as the value, or as one as near to it as can be; None if that is out of range."""
        letter = _LETTERS[self.type]
        least, most = (float(end) for end in self._ends(letter))
        raw = (value - self.offset) / gain
        if letter in "fd":
            return struct.unpack(">" + letter, struct.pack(">" + letter, raw))[0] if least <= raw <= most else None
        # The greatest number of 64 bits has no double: `most` is then the first one beyond.
        if raw >= most + 0.5 or (raw <= least - 0.5 and raw != least) or math.isnan(raw):
            return None
        whole = int(raw)
        return whole + (1 if raw - whole >= 0.5 else -1 if raw - whole <= -0.5 else 0)  # half away from zero

    def _name_of(self, raw: int) -> Any:
        """A member of `names`, or None: the device may have values without a name."""
        return None if self.names is None else next((name for name in self.names if name == raw), None)

    def _raw(self, words: list[int]) -> Any:
        letter = ">" + _LETTERS[self.type]
        part = self.mask != 0xFFFF
        data = self._part(words).to_bytes(struct.calcsize(letter), "big") if part else _bytes(words, self.order)
        return struct.unpack(letter, data)[0]

    def _part(self, words: list[int]) -> int:
        """What stands in the bits of `mask`."""
        word, mask = _reordered([words[0], self.mask], self.order)
        return (word & mask) // (mask & -mask)

    def _in_part(self, value: int) -> list[int]:
        mask = _reordered([self.mask], self.order)[0]
        return _reordered([value * (mask & -mask)], self.order)

    def _encode_one(self, value: Any) -> list[int]:
        if self.type == "BOOL":
            if isinstance(value, (str, bytes)) or value not in (0, 1):
                self.refuse(f"{value!r} is neither True nor False")
            return [(1 if self.mask == 0xFFFF else self.mask) if value else 0]
        if self.type == "STRING":
            return _words(self._text(value).ljust(2 * self.size, b"\0"), self.order)
        letter, number = _LETTERS[self.type], self._number(value)
        raw = self._unscaled(letter, number) if self.scaled else self._checked(letter, number)
        data = struct.pack(">" + letter, raw)
        words = _words(data, self.order) if self.mask == 0xFFFF else self._in_part(int.from_bytes(data, "big"))
        self._check_allowed(words)
        return words

    @property
    def _limited(self) -> bool:
        return math.isfinite(self.least) or math.isfinite(self.most) or self.names is not None

    def _text(self, value: Any) -> bytes:
        if not isinstance(value, str):
            self.refuse(f"{value!r} is not text")
        if "\0" in value:
            self.refuse("a text with a NUL character would end there; leave the character out")
        try:
            data = value.encode(self.encoding)
        except UnicodeEncodeError:
            self.refuse(f"{value!r} cannot be written in {self.encoding}; leave out what it does not have")
        if len(data) > self.length:
            self.refuse(f"{value!r} is too long; give at most {self.length} bytes of {self.encoding}")
        return data

    def _number(self, value: Any) -> int | float:
        """Also of the number types of other libraries."""
        if not isinstance(value, (bool, str, bytes)):
            try:
                return operator.index(value)
            except TypeError:
                try:
                    return float(value)
                except (TypeError, ValueError):
                    pass
        self.refuse(f"{value!r} is not a number")

    def _checked(self, letter: str, number: int | float) -> int | float:
        if letter in "fd":
            try:
                struct.pack(">" + letter, number)
                return number
            except (OverflowError, struct.error):
                self.refuse(f"{number} does not fit into {self.type}")
        if isinstance(number, float) and not number.is_integer():
            self.refuse(f"{number} is not a whole number, as {self.type} needs")
        least, most = self._ends(letter)
        if not least <= number <= most:
            if self._limited:  # the range of the type is not what may be sent
                self.refuse(f"{number} is not allowed; send {self.allowed}")
            what = self.type if self.mask in (0xFFFF, 0xFF00, 0x00FF) else f"{bin(self.mask).count('1')} bits"
            self.refuse(f"{number} does not fit into {what} ({least} to {most})")
        return int(number)

    def _ends(self, letter: str) -> tuple[Any, Any]:
        if letter in "fd":
            return -_MOST[letter], _MOST[letter]
        bits = 8 * struct.calcsize(">" + letter) if self.mask == 0xFFFF else bin(self.mask).count("1")
        return (-(1 << bits - 1), (1 << bits - 1) - 1) if letter.islower() else (0, (1 << bits) - 1)

    def _unscaled(self, letter: str, number: int | float) -> int | float:
        """The raw number of a scaled value that is to be written."""
        try:
            value = float(number)
        except OverflowError:
            value = math.inf if number > 0 else -math.inf
        least, most = (float(end) for end in self._ends(letter))
        ends = sorted((least * self.gain + self.offset, most * self.gain + self.offset))
        right = self.allowed if self._limited else "{:g} to {:g}".format(*ends) + self._unit()
        if math.isnan(value):
            self.refuse(f"not a number; send {right}")
        raw = self._nearest_raw(value, self.gain)
        if raw is None:
            self.refuse(f"{value:g}{self._unit()} is out of range; send {right}")
        return raw

    def _check_allowed(self, words: list[int]) -> None:
        """As what the registers would hold, so that 21.7 is not above `max: 21.7` of a REAL."""
        if self._is_invalid(words):
            value = self._raw(words) if self.type in _BITS_ONLY else self._raw(words) * self.gain + self.offset
            self.refuse(f"{value:g}{self._unit()} means 'no value'; send {self.allowed}")
        if self.type in _BITS_ONLY:
            return
        raw = self._raw(words)
        value = float(raw) * self.gain + self.offset
        if not math.isfinite(value):
            if not self.nonfinite:
                self.refuse(f"a number that is not finite (NaN or infinity); send {self.allowed}")
        elif not self.least <= value <= self.most:
            side = "below the minimum" if value < self.least else "above the maximum"
            self.refuse(f"{value:g}{self._unit()} is {side}; send {self.allowed}")
        elif self.names is not None and self._name_of(raw) is None:
            self.refuse(f"{raw} is not one of its values; send {self.allowed}")

    def _unit(self) -> str:
        return f" {self.units}" if self.units else ""
