// SPDX-License-Identifier: Apache-2.0
// A device served by modbus-serial or jsmodbus, by RTU on a serial port or over TCP where the name says so: four tables of
// 65536 addresses, set and read through standard input, a JSON text a line, each answered by one:
//   ["set", "coils", 3, [1, 0]]             null
//   ["get", "holding_registers", 0, 2]      [17, 4]
// Says "ready" once it serves, and ends with its input.
//   node server.js modbus-serial|jsmodbus|jsmodbus-rtu PORT
//   node server.js modbus-serial-rtu DEVICE
"use strict";
const net = require("node:net");
const readline = require("node:readline");

const [kind, place] = process.argv.slice(2);
const port = Number(place);
const host = "127.0.0.1";

const bits = () => {
  const buffer = Buffer.alloc(65536 / 8);
  return {
    buffer,
    get: (address) => (buffer[address >> 3] >> (address & 7)) & 1,
    set: (address, value) => {
      const mask = 1 << (address & 7);
      buffer[address >> 3] = value ? buffer[address >> 3] | mask : buffer[address >> 3] & ~mask;
    },
  };
};
const registers = () => {
  const buffer = Buffer.alloc(65536 * 2);
  return {
    buffer,
    get: (address) => buffer.readUInt16BE(2 * address),
    set: (address, value) => buffer.writeUInt16BE(value, 2 * address),
  };
};
const tables = { coils: bits(), discrete_inputs: bits(), input_registers: registers(), holding_registers: registers() };

const ready = () => console.log("ready");
if (kind.startsWith("modbus-serial")) {
  const { ServerTCP, ServerSerial } = require("modbus-serial");
  const functions = {
    getCoil: (address) => tables.coils.get(address) !== 0,
    getDiscreteInput: (address) => tables.discrete_inputs.get(address) !== 0,
    getInputRegister: tables.input_registers.get,
    getHoldingRegister: tables.holding_registers.get,
    setCoil: tables.coils.set,
    setRegister: tables.holding_registers.set,
  };
  const server = kind === "modbus-serial" ? new ServerTCP(functions, { host, port })
    : new ServerSerial(functions, { path: place, baudRate: 115200 });
  server.on("initialized", ready);
} else if (kind.startsWith("jsmodbus")) {
  const { server } = require("jsmodbus");
  const listener = net.createServer();
  const buffers = {
    coils: tables.coils.buffer, discrete: tables.discrete_inputs.buffer,
    input: tables.input_registers.buffer, holding: tables.holding_registers.buffer,
  };
  if (kind === "jsmodbus") new server.TCP(listener, buffers);
  else listener.on("connection", (socket) => new server.RTU(socket, buffers));
  listener.listen({ host, port }, ready);
} else {
  throw new Error(`there is no server '${kind}'`);
}

const commands = {
  set: (table, address, values) => { values.forEach((value, i) => tables[table].set(address + i, value)); return null; },
  get: (table, address, count) => Array.from({ length: count }, (_, i) => tables[table].get(address + i)),
};
readline.createInterface(process.stdin)
  .on("line", (line) => {
    const [command, ...rest] = JSON.parse(line);
    console.log(JSON.stringify(commands[command](...rest)));
  })
  .on("close", () => process.exit(0));
