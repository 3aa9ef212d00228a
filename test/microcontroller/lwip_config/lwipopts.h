// SPDX-License-Identifier: Apache-2.0
// lwIP on a chip without an operating system: for four Modbus clients.
#pragma once
#define NO_SYS 1
#define LWIP_SOCKET 0
#define LWIP_NETCONN 0
#define SYS_LIGHTWEIGHT_PROT 0
#define MEM_ALIGNMENT 4
#define LWIP_UDP 0
#define LWIP_RAW 0
#define TCP_MSS 536
#define MEMP_NUM_TCP_PCB 6  // four clients, one more that is accepted, one that is closing
#define LWIP_STATS 0
