# SPDX-License-Identifier: Apache-2.0
"""An authority made with OpenSSL's own program, which also makes certificates that nobody should believe."""
import pathlib
import subprocess

ROLE = "1.3.6.1.4.1.50316.802.1"

CONFIG = """
[ca]
default_ca = plant
[plant]
database = index.txt
serial = serial
new_certs_dir = .
certificate = {name}.pem
private_key = {name}.key
default_md = sha256
default_days = 700
default_crl_days = 30
policy = any
unique_subject = no
[delta]
2.5.29.27 = critical,DER:020101
[any]
commonName = supplied
"""


def openssl(folder, *arguments):
    done = subprocess.run(["openssl", *arguments], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"openssl {' '.join(arguments)}: {done.stderr}")
    return done.stdout


class Authority:
    def __init__(self, folder, name="ca", curve="P-256"):
        self.folder = pathlib.Path(folder)
        self.name = name
        (self.folder / "index.txt").touch()
        (self.folder / "serial").write_text("1000\n")
        (self.folder / f"{name}.cnf").write_text(CONFIG.format(name=name))
        openssl(folder, "req", "-x509", "-newkey", "ec", "-pkeyopt", f"ec_paramgen_curve:{curve}", "-nodes", "-keyout",
                f"{name}.key", "-out", f"{name}.pem", "-days", "3650", "-subj", f"/CN=authority {name}", "-addext",
                "keyUsage=critical,keyCertSign,cRLSign")
        self._serial = 0x1000

    def issue(self, name, *extensions, key=("ec", "-pkeyopt", "ec_paramgen_curve:P-256"), dates=()):
        """NAME.pem and NAME.key in the folder; `dates`: -startdate and -enddate of openssl ca."""
        openssl(self.folder, "req", "-newkey", *key, "-nodes", "-keyout", f"{name}.key", "-out", f"{name}.csr", "-subj",
                f"/CN={name}")
        (self.folder / f"{name}.ext").write_text("\n".join(("basicConstraints=CA:FALSE", *extensions)) + "\n")
        openssl(self.folder, "ca", "-batch", "-config", f"{self.name}.cnf", "-in", f"{name}.csr", "-out", f"{name}.pem",
                "-notext", "-extfile", f"{name}.ext", *dates)

    def client(self, name, role=None, **how):
        extensions = ["extendedKeyUsage=clientAuth"]
        if role is not None:
            extensions.append(f"{ROLE}={role}")
        self.issue(name, *extensions, **how)

    def node(self, name, names="IP:127.0.0.1,DNS:localhost", **how):
        self.issue(name, "extendedKeyUsage=serverAuth", f"subjectAltName={names}", **how)

    def revoke(self, name, **how):
        openssl(self.folder, "ca", "-config", f"{self.name}.cnf", "-revoke", f"{name}.pem")
        self.list(**how)

    def list(self, to="list.pem", options=()):
        """Of all that is revoked; `options` of openssl ca -gencrl. Its text."""
        openssl(self.folder, "ca", "-config", f"{self.name}.cnf", "-gencrl", "-out", to, *options)
        return (self.folder / to).read_text()
