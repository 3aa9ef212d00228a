// SPDX-License-Identifier: Apache-2.0
// Node.js's tls under modbus-serial and jsmodbus, against a node with TLS: roles, and what is refused.
//   node secure.js NODE COUPLER
"use strict";
const assert = require("node:assert/strict");
const { execFileSync, spawn } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const readline = require("node:readline");
const tls = require("node:tls");
const { after, before, describe, it } = require("node:test");

const ModbusSerial = require("modbus-serial");
const jsmodbus = require("jsmodbus");

const [nodeProgram, coupler] = process.argv.slice(2);
const PATIENCE = 60000; // ms; no rule, only reached when something is broken
const MAP = `
name: cell
security:
  certificate: press/press.pem
  key: press/press.key
  ca: press/authority.pem
  roles:
    operator: {read: all, write: [lamp]}
    viewer: {read: [lamp]}
mapping:
  coils: {lamp: 0, valve: 1}
  holding_registers: {speed: {address: 0, type: UINT}}
`;
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "secure-"));
let node;
let port;

// `use` gets the socket before it is connected.
function connect(name, use = () => {}) {
  const file = (ending) => fs.readFileSync(path.join(folder, name, ending));
  const options = { host: "127.0.0.1", port, cert: file(`${name}.pem`), key: file(`${name}.key`), ca: file("authority.pem") };
  return new Promise((resolve, reject) => {
    const socket = tls.connect(options, () => resolve(socket));
    socket.once("error", reject);
    use(socket);
  });
}

before(async () => {
  execFileSync(coupler, ["certificates", folder, "--node", "press:127.0.0.1,localhost", "--client", "cell1:operator", "--client",
    "screen:viewer"]);
  fs.writeFileSync(path.join(folder, "cell.yaml"), MAP);
  node = spawn(nodeProgram, [path.join(folder, "cell.yaml"), "--sim", "--listen", "127.0.0.1", "--port", "0", "--tls-port", "0"],
    { stdio: ["ignore", "ignore", "pipe"] });
  for await (const line of readline.createInterface(node.stderr)) {
    port = Number(/TLS at 127\.0\.0\.1:(\d+)/.exec(line)?.[1]);
    if (port) break;
  }
  assert.ok(port, "the node does not serve");
});

after(async () => {
  const ended = new Promise((resolve) => node.once("exit", resolve));
  node.kill();
  assert.equal(await ended, 0, "the node ends in order");
  fs.rmSync(folder, { recursive: true });
});

describe("modbus-serial over tls", () => {
  const client = new ModbusSerial();
  before(async () => {
    const socket = await connect("cell1");
    await new Promise((resolve) => client.linkTCP(socket, {}, resolve));
    client.setID(1);
    client.setTimeout(PATIENCE);
  });
  after(() => client.close(() => {}));

  it("may what its role may", async () => {
    await client.writeCoil(0, true);
    assert.deepEqual((await client.readCoils(0, 2)).data.slice(0, 2), [true, false]);
    assert.deepEqual((await client.readHoldingRegisters(0, 1)).data, [0]);
  });

  it("gets exception 01 for what it may not", async () => {
    for (const reply of [client.writeCoil(1, true), client.writeRegister(0, 1), client.writeCoils(0, [true, true])])
      await assert.rejects(reply, (error) => error.modbusCode === 1);
  });
});

describe("jsmodbus over tls", () => {
  it("may what its role may, and gets exception 01 for the rest", async () => {
    let client;
    const socket = await connect("screen", (early) => { client = new jsmodbus.client.TCP(early, 1, PATIENCE); });
    assert.equal((await client.readCoils(0, 1)).response.body.valuesAsArray[0] >= 0, true);
    const refused = (error) => error.response?.body?.code === 1;
    await assert.rejects(client.readHoldingRegisters(0, 1), refused);
    await assert.rejects(client.writeSingleCoil(0, false), refused);
    socket.destroy();
  });
});
