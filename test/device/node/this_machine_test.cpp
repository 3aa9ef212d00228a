// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/this_machine.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "test/device/analogue/fake_sysfs.hpp"

namespace coupler::device {
namespace {

/// A machine with everything that a serial is looked for in.
struct Machine : testing::Test {
  Machine() {
    disk.write(tree, std::string("10000000c0ffee\0", 15));
    disk.write("sys/class/dmi/id/product_serial", "PROD-1");
    disk.write("sys/class/dmi/id/board_serial", "BOARD-1");
    add_interface("eth0", "dc:a6:32:01:02:03");
    disk.write("etc/machine-id", "3d1219c7c4c5404aaa1f6d2a48adfda4");
  }
  void add_interface(const std::string& name, const std::string& mac,
                     const std::string& assigned = "0") const {
    const std::string folder = "sys/class/net/" + name + "/";
    disk.write(folder + "address", mac);
    disk.write(folder + "addr_assign_type", assigned);
    disk.link(folder + "device", ".");
  }
  void remove_board() const {
    disk.remove("sys/firmware");
    disk.remove("sys/class/dmi");
  }
  std::string serial() const { return find_serial(disk.root); }

  static constexpr auto tree = "sys/firmware/devicetree/base/serial-number";
  FakeSysfs disk;
};

using ThisMachine = Machine;

TEST_F(ThisMachine, The_boards_serial_goes_first_then_a_mac_then_the_machine_id) {
  EXPECT_EQ(serial(), "10000000c0ffee");
  disk.remove(tree);
  disk.write("proc/device-tree/serial-number", "10000000c0ffef");
  EXPECT_EQ(serial(), "10000000c0ffef");
  disk.remove("proc/device-tree");
  EXPECT_EQ(serial(), "PROD-1");
  disk.remove("sys/class/dmi/id/product_serial");
  EXPECT_EQ(serial(), "BOARD-1");
  disk.remove("sys/class/dmi");
  EXPECT_EQ(serial(), "dc:a6:32:01:02:03");
  disk.remove("sys/class/net");
  EXPECT_EQ(serial(), "3d1219c7c4c5404aaa1f6d2a48adfda4");
  disk.remove("etc/machine-id");
  EXPECT_EQ(serial(), "");
}

TEST_F(ThisMachine, What_a_maker_writes_in_place_of_a_serial_is_none) {
  for (const char* filler :
       {"", "None", "To be filled by O.E.M.", "0", "0000000000000000", "Default string",
        " System Serial Number ", "0123456789", "Not Specified", "..............", "N/A"}) {
    disk.write(tree, filler);
    EXPECT_EQ(serial(), "PROD-1") << filler;
  }
}

TEST_F(ThisMachine, The_first_interface_by_name_counts_that_has_hardware_and_a_permanent_address_of_its_own) {
  remove_board();
  add_interface("aaa_virtual", "dc:a6:32:00:00:01");
  disk.remove("sys/class/net/aaa_virtual/device");
  add_interface("bbb_random", "dc:a6:32:00:00:02", "1");
  add_interface("ccc_set", "dc:a6:32:00:00:03", "3");
  add_interface("can0", "");
  add_interface("ddd_local", "02:fc:00:00:00:01");
  add_interface("ddd_zero", "00:00:00:00:00:00");
  add_interface("enx0", "dc:a6:32:00:00:04");
  EXPECT_EQ(serial(), "dc:a6:32:00:00:04");
}

TEST_F(ThisMachine, A_machine_id_that_is_not_made_yet_is_none) {
  remove_board();
  disk.remove("sys/class/net");
  disk.write("etc/machine-id", "uninitialized");
  EXPECT_EQ(serial(), "");
}

TEST_F(ThisMachine, Nobody_keeps_a_node_waiting) {
  disk.remove(tree);
  ASSERT_EQ(::mkfifo((disk.root + "/" + tree).c_str(), 0644), 0);
  EXPECT_EQ(serial(), "PROD-1");
}

/// $ printf 'OpenCoupler serial: 10000000c0ffee' | sha256sum | cut -c1-16
TEST_F(ThisMachine, A_serial_is_told_as_the_hash_that_the_documents_describe) {
  EXPECT_EQ(this_machine(disk.root).serial, 0x71a963439233158aU);
  EXPECT_EQ(hashed_serial(""), 0U);
}

TEST_F(ThisMachine, The_hostname_is_the_kernels) {
  char name[65] = {};
  ASSERT_EQ(::gethostname(name, sizeof name - 1), 0);
  EXPECT_EQ(identity::hostname_of(this_machine(disk.root)), name);
}

}  // namespace
}  // namespace coupler::device
