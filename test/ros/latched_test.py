# SPDX-License-Identifier: Apache-2.0
"""A latched topic tells everybody its last message, also who subscribes while it is published."""
import os
import pathlib
import shutil

from std_msgs.msg import Bool

from support import levels, process, testing


class Latched(levels.LevelsTest):
    def test_who_subscribes_while_a_message_is_published_has_it(self):
        hold = pathlib.Path(os.environ["ROS_HOME"], "hold")
        held = {"LD_PRELOAD": str(process.BUILD / "test/lib/libhold_publish.so"), "HOLD_PUBLISH": str(hold),
                "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":verify_asan_link_order=0"}
        press = self.peer(11)
        early = self.topic("/press/online", Bool)
        driver = process.Process("coupler_driver", f"_map:={levels.write_map('press', press.port)}",
                                 environment=os.environ | held)
        self.addCleanup(driver.end)
        early.becomes(True)
        hold.touch()
        self.addCleanup(hold.unlink, missing_ok=True)
        press.stop()
        early.becomes(False)
        late = process.Process(shutil.which("rostopic"), "echo", "/press/online",
                               environment=os.environ | {"PYTHONUNBUFFERED": "1"})
        self.addCleanup(late.end)
        late.wait_for("data: True")  # what roscpp has kept until now
        hold.unlink()
        late.wait_for("data: False")


if __name__ == "__main__":
    testing.main()
