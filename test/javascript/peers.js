// SPDX-License-Identifier: Apache-2.0
// Clients from npm, modbus-serial and jsmodbus, against a node that serves test/peers/peers.yaml.
//   node peers.js NODE_COMMAND…
"use strict";
const assert = require("node:assert/strict");
const { spawn } = require("node:child_process");
const net = require("node:net");
const readline = require("node:readline");
const { after, before, describe, it } = require("node:test");

const ModbusSerial = require("modbus-serial");
const jsmodbus = require("jsmodbus");

const command = process.argv.slice(2);
const IDENTITY = 0xff00;
const PATIENCE = 60000; // ms; no rule, only reached when something is broken
let node;
let port;

before(async () => {
  node = spawn(command[0], [...command.slice(1), "--listen", "127.0.0.1", "--port", "0"], { stdio: ["ignore", "ignore", "pipe"] });
  for await (const line of readline.createInterface(node.stderr)) {
    port = Number(/serving .* on 127\.0\.0\.1:(\d+)/.exec(line)?.[1]);
    if (port) break;
  }
  assert.ok(port, `${command.join(" ")} does not serve`);
});

after(async () => {
  const ended = new Promise((resolve) => node.once("exit", resolve));
  node.kill();
  assert.equal(await ended, 0, "the node ends in order");
});

describe("modbus-serial", () => {
  const client = new ModbusSerial();
  before(async () => {
    await client.connectTCP("127.0.0.1", { port });
    client.setID(1);
    client.setTimeout(PATIENCE);
  });
  after(() => client.close(() => {}));

  it("writes and reads coils: FC 1, 5, 15", async () => {
    for (const level of [true, false, true]) {
      await client.writeCoil(20, level);
      assert.equal((await client.readCoils(20, 1)).data[0], level);
    }
    const pattern = [true, false, true, true, false, false, true, true, false, true];
    await client.writeCoils(0, pattern);
    assert.deepEqual((await client.readCoils(0, 10)).data.slice(0, 10), pattern);
  });

  it("sees discrete inputs follow their wires: FC 2", async () => {
    for (const level of [true, false]) {
      await client.writeCoils(0, [level, level]);
      assert.deepEqual((await client.readDiscreteInputs(0, 4)).data.slice(0, 4), [level, !level, true, false]);
    }
  });

  it("reads input registers: FC 4", async () => {
    const { buffer } = await client.readInputRegisters(0, 5);
    assert.deepEqual([buffer.readInt16BE(0), buffer.readUInt32BE(2), buffer.readFloatBE(6)], [-2, 305419896, 1.5]);
  });

  it("writes and reads holding registers: FC 3, 6, 16", async () => {
    await client.writeRegister(65279, 0xbeef);
    assert.deepEqual((await client.readHoldingRegisters(65279, 1)).data, [0xbeef]);
    const values = Buffer.alloc(34);
    values.writeInt16BE(-12345, 0);
    values.writeUInt32BE(0xcafef00d, 2);
    values.writeDoubleBE(-1.0e-300, 6);
    values.write("twenty characters ok", 14);
    await client.writeRegisters(0, values);
    assert.deepEqual((await client.readHoldingRegisters(0, 17)).buffer, values);
  });

  it("masks a register, writes and reads in one: FC 22, 23", async () => {
    await client.writeRegister(0, 0x0012);
    await client.maskWriteRegister(0, 0x00f2, 0x0025);
    assert.deepEqual((await client.readWriteRegisters(0, 3, 1, 2, [7, 8])).data, [0x0017, 7, 8]);
  });

  it("is told who answers: FC 43, 20, and the identity area", async () => {
    const { data } = await client.readDeviceIdentification(2, 0);
    assert.equal(data[0], "OpenCoupler");
    assert.equal(data[1], "peers");
    const head = (await client.readInputRegisters(IDENTITY, 13)).data;
    assert.deepEqual(head.slice(0, 3), [0x4f43, 0x504c, 1]);
    const fingerprint = head.slice(3, 7).map((word) => word.toString(16).padStart(4, "0")).join("");
    assert.equal(data[5], fingerprint);
    const text = Buffer.from((await client.readFileRecords(1, 0)).data).subarray(0, 200).toString();
    assert.match(text, /^# SPDX-License-Identifier: Apache-2\.0\n# A node that foreign clients can try out/);
  });

  it("gets an exception for what is not there", async () => {
    const refused = [
      [2, client.readCoils(0, 11)], [2, client.readDiscreteInputs(4, 1)], [2, client.readHoldingRegisters(17, 1)],
      [2, client.readInputRegisters(4, 2)], [2, client.writeCoil(10, true)], [2, client.writeRegister(17, 1)],
      [2, client.writeCoils(9, [true, true])], [2, client.writeRegisters(16, [1, 2])],
      [2, client.readHoldingRegisters(65535, 2)], [1, client.customFunction(100, [1, 2])],
    ];
    await Promise.all(refused.map(([code, reply]) => assert.rejects(reply, (error) => error.modbusCode === code)));
  });
});

describe("jsmodbus", () => {
  const socket = new net.Socket();
  const client = new jsmodbus.client.TCP(socket, 1, PATIENCE);
  const values = async (reply) => (await reply).response.body.valuesAsArray;
  before(() => new Promise((resolve) => socket.connect({ host: "127.0.0.1", port }, resolve)));
  after(() => socket.destroy());

  it("writes and reads coils: FC 1, 5, 15", async () => {
    for (const level of [true, false, true]) {
      await client.writeSingleCoil(20, level);
      assert.deepEqual((await values(client.readCoils(20, 1))).slice(0, 1), [Number(level)]);
    }
    const pattern = [0, 1, 1, 0, 1, 0, 0, 1, 1, 1];
    await client.writeMultipleCoils(0, pattern);
    assert.deepEqual((await values(client.readCoils(0, 10))).slice(0, 10), pattern);
  });

  it("reads discrete inputs and input registers: FC 2, 4", async () => {
    await client.writeMultipleCoils(0, [1, 1]);
    assert.deepEqual((await values(client.readDiscreteInputs(0, 4))).slice(0, 4), [1, 0, 1, 0]);
    assert.deepEqual(Array.from(await values(client.readInputRegisters(0, 3))), [0xfffe, 0x1234, 0x5678]);
  });

  it("writes and reads holding registers: FC 3, 6, 16", async () => {
    await client.writeSingleRegister(0, 0x8000);
    await client.writeMultipleRegisters(1, [0xcafe, 0xf00d]);
    assert.deepEqual(Array.from(await values(client.readHoldingRegisters(0, 3))), [0x8000, 0xcafe, 0xf00d]);
  });

  it("gets an exception for what is not there", async () => {
    const refused = [
      client.readCoils(0, 11), client.readDiscreteInputs(4, 1), client.readHoldingRegisters(17, 1),
      client.readInputRegisters(4, 2), client.writeSingleCoil(10, true), client.writeSingleRegister(17, 1),
    ];
    const is02 = ({ err, response }) => err === "ModbusException" && response.body.code === 2;
    await Promise.all(refused.map((reply) => assert.rejects(reply, is02)));
  });
});

it("both keep their answers apart when each asks a hundred things at once", async () => {
  const serial = new ModbusSerial();
  await serial.connectTCP("127.0.0.1", { port });
  serial.setID(1);
  const socket = new net.Socket();
  const js = new jsmodbus.client.TCP(socket, 1, PATIENCE);
  await new Promise((resolve) => socket.connect({ host: "127.0.0.1", port }, resolve));
  await serial.writeRegisters(0, [11, 22, 33]);
  const wanted = [11, 22, 33];
  const replies = [];
  for (let i = 0; i < 100; ++i) {
    replies.push(serial.readHoldingRegisters(i % 3, 1).then(({ data }) => assert.equal(data[0], wanted[i % 3])));
    replies.push(js.readHoldingRegisters(i % 3, 1).then(({ response }) => assert.equal(response.body.valuesAsArray[0], wanted[i % 3])));
  }
  await Promise.all(replies);
  serial.close(() => {});
  socket.destroy();
});
