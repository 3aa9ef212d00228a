# SPDX-License-Identifier: Apache-2.0
"""A point, a value and a map may have the name of any macro: what is generated of them compiles, whatever headers stand
before it. The macros are the compiler's own answer. COUPLER is the program, CXX the compiler, SOURCE_DIR the tree."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["SOURCE_DIR"])
CXX = [os.environ["CXX"], "-std=gnu++17", *(f"-I{SOURCE / side}" for side in ("common", "device", "host"))]
GENERATED = ["coupler/host/client/point.hpp", "coupler/device/node/program.hpp", "coupler/device/node/point_hooks.hpp",
             "coupler/device/core/node_core.hpp"]
USUAL = ["cassert", "cerrno", "cfloat", "cinttypes", "climits", "clocale", "cmath", "complex.h", "csetjmp", "csignal",
         "cstdarg", "cstddef", "cstdio", "cstdlib", "cstring", "ctime", "cwchar", "fcntl.h", "netdb.h", "netinet/in.h",
         "poll.h", "pthread.h", "sys/ioctl.h", "sys/mman.h", "sys/socket.h", "sys/stat.h", "sys/sysmacros.h",
         "sys/time.h", "sys/types.h", "sys/wait.h", "syslog.h", "termios.h", "unistd.h"]
# Those of ROS 1, and with them Boost's, where it is installed.
ROS = ["ros/ros.h"] if os.path.exists("/usr/include/ros/ros.h") else []
FILES = ("client.cpp", "hooks.hpp", "core.hpp", "map.cpp", "node.cpp")
# Where E2BIG is a macro, its namespace has no other name than this one.
USE = """
#pragma push_macro("E2BIG")
#undef E2BIG
namespace made = ::coupler::maps::E2BIG;
#pragma pop_macro("E2BIG")
bool use(made::NodeHooks& hooks, made::NodeCore& core) {
  return hooks.set_BUFSIZ(true).has_value() && core.set_EAGAIN(true);
}
static_assert(E2BIG > 0 && EAGAIN > 0 && BUFSIZ > 0 && EOF < 0, "the macros are back");
"""


def run(*command, **how):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **how)
    return done.returncode, done.stdout, done.stderr


def includes(headers):
    return "".join(f'#include {name if name[0] == chr(34) else f"<{name}>"}\n' for name in headers)


class Macros(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.headers = includes(GENERATED + ROS + USUAL)
        status, text, errors = run(*CXX, "-dM", "-E", "-x", "c++", "-", input=cls.headers)
        assert status == 0, errors
        # Boost's have a prefix of their own, and are thousands.
        cls.macros = sorted(set(re.findall(r"^#define (?!BOOST_)([A-Za-z]\w*)", text, re.M)))

    def test_the_compiler_knows_the_macros_that_people_may_type(self):
        self.assertGreater(len(self.macros), 2000)
        for name in ("BUFSIZ", "EOF", "NULL", "INT_MAX", "errno", "major", "minor", "linux", "unix", "stdin", "SIGINT", "EAGAIN",
                     "M_PI", "assert", "si_pid", "PRIx64", "I", "alloca"):
            self.assertIn(name, self.macros)

    def test_any_of_them_names_a_point_and_a_value_and_one_the_map(self):
        """The coils are the firmware's inputs: each has a member of the client, and set_POINT of both hooks."""
        values = ", ".join(f'{at}: "{macro}"' for at, macro in enumerate(self.macros))
        path = self.folder / "E2BIG.yaml"
        path.write_text("name: E2BIG\nmapping:\n  discrete_inputs:\n" +
                        "".join(f'    "{macro}": {{address: {at}}}\n' for at, macro in enumerate(self.macros)) +
                        f"  holding_registers:\n    IN_USE: {{address: 0, type: UINT, values: {{{values}}}}}\n"
                        "    last: {address: 4, type: LINT, values: {-9223372036854775808: INT64_MIN}}\n", encoding="utf-8")
        self.assertEqual(run(os.environ["COUPLER"], "generate", path, "--out", self.folder, "--quiet"), (0, "", ""))
        own = includes(f'"E2BIG_{file}"' for file in FILES)
        for place, text in (("before", self.headers + own + USE), ("behind", own + self.headers)):
            path = self.folder / f"{place}.cpp"
            path.write_text(text, encoding="utf-8")
            status, _, errors = run(*CXX, "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror",
                                    f"-I{self.folder}", path)
            self.assertEqual((status, errors[:2000]), (0, ""), f"the headers stand {place}")


if __name__ == "__main__":
    unittest.main(verbosity=1)
