# SPDX-License-Identifier: Apache-2.0
"""What ROS's own tools find after `source build/default/devel/setup.bash`, and nothing else done."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from support import testing

BUILD = pathlib.Path(os.environ["COUPLER_BUILD_DIR"])
OTHER_LAUNCH = """<launch>
  <include file="$(find coupler_driver)/launch/device.launch"><arg name="map" value="/etc/press.yaml"/></include>
</launch>
"""


@unittest.skipUnless(shutil.which("roslaunch") and shutil.which("rosrun"), "no roslaunch or rosrun (scripts/install-packages ros test)")
class Tools(unittest.TestCase):
    def said(self, command):
        kept = {name: os.environ[name] for name in ("PATH", "ROS_HOME", "TMPDIR", "LANG", "TSAN_OPTIONS") if name in os.environ}
        done = subprocess.run(["bash", "-c", f"source '{BUILD}/devel/setup.bash'; {command}"], env=kept | {"HOME": kept["ROS_HOME"]},
                              capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, f"{command}: {done.stdout}{done.stderr}")
        return done.stdout

    def test_the_package_is_not_the_source_tree(self):
        self.assertEqual(self.said("rospack find coupler_driver"), f"{BUILD}/devel/share/coupler_driver\n")
        self.assertEqual(self.said(f"source '{BUILD}/devel/setup.bash'; echo $ROS_PACKAGE_PATH").count("/devel/share"), 1)

    def test_rosrun_finds_the_programs(self):
        for program in ("coupler_driver", "coupler-node"):
            self.assertIn("--help", self.said(f"rosrun coupler_driver {program} --help"))

    def test_rosmsg_and_rossrv_show_the_messages(self):
        self.assertEqual(self.said("rosmsg show coupler_driver/BoolArray").strip(), "bool[] data")
        self.assertIn("string point", self.said("rossrv show coupler_driver/Read"))
        self.assertIn("online", self.said("python3 -c 'import coupler_driver.msg; print(coupler_driver.msg.Status.__slots__)'"))

    def test_launch_files_are_found_by_their_names_and_by_others(self):
        self.assertIn("/press_driver", self.said("roslaunch --nodes coupler_driver device.launch map:=/etc/press.yaml"))
        with tempfile.NamedTemporaryFile("w", suffix=".launch") as file:
            file.write(OTHER_LAUNCH)
            file.flush()
            self.assertIn("/press_driver", self.said(f"roslaunch --nodes {file.name}"))


if __name__ == "__main__":
    testing.main()
