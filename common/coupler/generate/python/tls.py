# SPDX-License-Identifier: Apache-2.0
# Behind spec.py in a generated file: Modbus/TCP Security, docs/security.md.


@dataclass(frozen=True)
class Tls:
    """What proves each side to the other, as `tls` of a map has it. The files are in PEM; paths begin in the working
    directory. They are read at each connect, so a certificate that was renewed counts from the next one on."""

    certificate: str  # of this client; its role is in it
    key: str          # of the certificate, without a password
    ca: str = ""      # the authority of the device's certificate
    name: str = ""    # in the device's certificate, if that is not the address
    pin: str = ""     # "sha256:…", as `coupler pin` prints it: the device's certificate itself, in place of `ca`

    def __post_init__(self) -> None:
        if not self.certificate or not self.key or bool(self.ca) == bool(self.pin):
            raise ValueError("tls: give the certificate, its key, and either 'ca' or 'pin'")
        if self.pin and not (self.pin.startswith("sha256:") and re.fullmatch("[0-9a-f]{64}", self._pinned())):
            raise ValueError("tls: a pin is 'sha256:' and 64 hexadecimal digits")

    def context(self) -> ssl.SSLContext:
        """Returns what Python's ssl needs. Raises NotConnected if a file cannot be used."""
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)  # compares the name in the certificate, too
        context.minimum_version = ssl.TLSVersion.TLSv1_2
        if self.pin:
            context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        path = ""
        try:
            for path in filter(None, (self.certificate, self.key, self.ca)):
                open(path, "rb").close()  # ssl does not say which one it cannot read
            path = f"{self.certificate} with {self.key}"
            context.load_cert_chain(self.certificate, self.key, password=lambda: b"")  # it would ask at the terminal
            path = self.ca
            if self.ca:
                context.load_verify_locations(self.ca)
        except OSError as error:
            raise NotConnected(f"cannot use {path}: {error.strerror or error}; check the files of tls",
                               _number_of(error)) from error
        return context

    def check_pin(self, certificate: bytes | None) -> None:
        """Raises OSError if the device has shown another certificate than that of the pin."""
        shown = "sha256:" + hashlib.sha256(certificate or b"").hexdigest()
        if self.pin and shown[len("sha256:"):] != self._pinned():
            raise OSError(f"the device's certificate has the pin {shown}, not that of tls")

    def _pinned(self) -> str:
        """The digits of the pin."""
        return self.pin.replace(":", "").lower()[len("sha256"):]


def _number_of(error: BaseException) -> int | None:
    """The errno of an error, if it has one. The numbers of ssl and of names that are not found are others."""
    if isinstance(error, (ssl.SSLError, socket.gaierror)):
        return None
    if isinstance(error, TimeoutError):
        return errno.ETIMEDOUT
    return error.errno if isinstance(error, OSError) else None


def _receive(modbus: Any, timeout: float, size: int | None) -> bytes:
    """Stands in for pymodbus' own `recv`, which waits by select(): that does not see what TLS has decrypted already."""
    end = time.monotonic() + timeout
    data = b""
    while len(data) < (size or 1) and (left := end - time.monotonic()) > 0:
        modbus.socket.settimeout(left)
        try:
            piece: bytes = modbus.socket.recv(size - len(data) if size else 4096)
        except TimeoutError:
            break
        if not piece:
            raise ConnectionResetError(errno.ECONNRESET, "the device has closed the connection")
        data += piece
    modbus.socket.settimeout(timeout)
    return data
