// SPDX-License-Identifier: Apache-2.0
// The live page. It asks for the points once, then reads the stream of what is new; nothing else is loaded.
"use strict";

const STEPS = 300; // of two seconds
const ALIVE_EVERY = 500; // ms, once this page has written
const ANSWER_WITHIN = 5000; // ms; the stream has something to say each second
const STREAMS = 4; // of one browser, which opens six connections to an address: the others write and ask
const element = (id) => document.getElementById(id);
const rows = new Map(); // by point: what its row shows

let token = "";
let hasWritten = false;

async function ask(path, options = {}) {
  const signal = options.signal || AbortSignal.timeout(ANSWER_WITHIN);
  const answer = await fetch(path, { ...options, signal, headers: { Authorization: `Bearer ${token}` } });
  if (!answer.ok) {
    const error = new Error((await answer.text()).trim());
    error.status = answer.status;
    throw error;
  }
  return answer;
}

// Elements.

function make(kind, className, ...content) {
  const made = document.createElement(kind);
  if (className) made.className = className;
  made.append(...content);
  return made;
}

function makeDrawing() {
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", `0 0 ${STEPS} 28`);
  svg.setAttribute("preserveAspectRatio", "none");
  svg.setAttribute("aria-hidden", "true");
  svg.append(path);
  return { svg, path };
}

function makeButton(text, label, act) {
  const button = make("button", "", text);
  button.type = "button";
  button.setAttribute("aria-label", label);
  button.addEventListener("click", act);
  return button;
}

/// What the point's value is set with, and the answer to the last one.
function makeControls(entry) {
  const { point } = entry;
  const outcome = make("output", "outcome");
  outcome.setAttribute("aria-live", "polite");
  entry.outcome = outcome;
  if (point.write.kind === "switch" && point.write_only) {
    entry.controls = [makeButton("on", `${point.name} on`, () => write(entry, "true")),
      makeButton("off", `${point.name} off`, () => write(entry, "false"))];
    return [entry.controls[0], " ", entry.controls[1], outcome];
  }
  if (point.write.kind === "switch") {
    entry.switch = makeButton("set", point.name, () => write(entry, String(!entry.shown.value)));
    entry.switch.setAttribute("role", "switch");
    entry.controls = [entry.switch];
    return [entry.switch, outcome];
  }
  const form = make("form", "");
  const field = point.values ? make("select", "") : make("input", "");
  if (point.values) field.append(make("option", "", "")); // so that nothing is written by chance
  field.required = Boolean(point.values);
  for (const [, name] of point.values || []) field.append(make("option", "", name));
  field.setAttribute("aria-label", `New value of ${point.name}`);
  if (!point.values) {
    field.autocomplete = "off";
    field.placeholder = point.write.range || "";
  }
  const button = make("button", "", "write");
  entry.controls = [field, button];
  form.append(field, button);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    write(entry, field.value);
  });
  return [form, outcome];
}

/// The rows of a word's bits come when they are asked for, and go again: there may be thousands.
function makeBitsButton(entry) {
  const { name, bits } = entry.point;
  const button = makeButton(`show ${bits} bits`, `Show the bits of ${name}`, () => {
    const opens = entry.bits.length === 0;
    if (opens) addBits(entry);
    else for (const { row } of entry.bits.splice(0)) row.remove();
    button.setAttribute("aria-expanded", String(opens));
    setText(button, opens ? "hide bits" : `show ${bits} bits`);
  });
  button.setAttribute("aria-expanded", "false");
  return button;
}

function addBits(entry) {
  let last = entry.row;
  for (let bit = 0; bit < entry.point.bits; ++bit) {
    const name = make("th", "name", `${entry.point.name}.${bit}`);
    name.scope = "row";
    const text = document.createTextNode("–");
    const seen = make("td", "seen");
    const { svg, path } = makeDrawing();
    const row = make("tr", "bit", name, make("td", "value", text), make("td", "curve", svg), seen, make("td", "type", "bit"), make("td", "address", `bit ${bit}`), make("td", "write"));
    row.dataset.point = `${entry.point.name}.${bit}`;
    last.after(row);
    last = row;
    entry.bits.push({ row, text, seen, path });
  }
  if (entry.shown) showBits(entry);
  drawBits(entry);
}

function addRow(point) {
  const name = make("th", "name", point.name);
  name.scope = "row";
  if (point.description) name.append(make("small", "", point.description));
  const about = make("small", "", "");
  const text = document.createTextNode("–");
  const value = make("td", "value", text, about);
  const seen = make("td", "seen");
  const { svg, path } = makeDrawing();
  const row = make("tr", "", name, value, make("td", "curve", svg), seen, make("td", "type", point.type), make("td", "address", point.place.replace("_", " "), " ", make("small", "", point.modicon)));
  row.dataset.point = point.name;
  const entry = { point, row, text, about, seen, path, steps: [], bits: [], bitSteps: [], changedAt: 0, shown: null, switch: null, controls: [], outcome: null };
  row.append(make("td", "write", ...(point.write ? makeControls(entry) : [])));
  showControls(entry);
  if (point.bits) name.append(makeBitsButton(entry));
  element("points").append(row);
  rows.set(point.name, entry);
}

// Values.

function ageText(seconds) {
  if (seconds < 1) return "just now";
  if (seconds < 60) return `${Math.floor(seconds)} s ago`;
  if (seconds < 3600) return `${Math.floor(seconds / 60)} min ago`;
  return `${Math.floor(seconds / 3600)} h ago`;
}

function qualityText(state) {
  if (state.why !== undefined) return `${state.quality}: ${state.why}`;
  if (state.exception === undefined) return state.quality;
  return `${state.quality}: exception ${state.exception.toString(16).toUpperCase().padStart(2, "0")}`;
}

function valueText(point, shown) {
  if (shown.text === undefined) return "–";
  if (point.values && shown.text !== String(shown.value)) return `${shown.text} (${shown.value})`;
  if (shown.value === true) return "on";
  if (shown.value === false) return "off";
  return point.units ? `${shown.text} ${point.units}` : shown.text;
}

/// Whether a bit is 1 in a hexadecimal text: JavaScript's numbers have 53 bits.
function hasBit(digits, bit) {
  const digit = parseInt(digits[digits.length - 1 - Math.floor(bit / 4)] || "0", 16);
  return Math.floor(digit / 2 ** (bit % 4)) % 2 === 1;
}

/// "bits 0, 3": those of a word that are set.
function bitsText(point, shown) {
  if (!point.bits || shown.text === undefined) return "";
  const set = [];
  for (let bit = 0; bit < point.bits; ++bit) if (hasBit(shown.bits.is, bit)) set.push(bit);
  return set.length > 0 ? `bits ${set.join(", ")} are 1` : "every bit is 0";
}

/// Setting it anew would take a selection away.
function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

function seenText(off, on, changes) {
  const often = changes === 1 ? "1 change" : `${changes} changes`;
  return [off ? "off" : "", on ? "on" : "", changes > 0 ? often : ""].filter(Boolean).join(" · ");
}

function isGood({ point, shown }) {
  return shown.quality === "good" || point.write_only === true;
}

/// A word's bits, each as a coil is shown.
function showBits(entry) {
  const { row: word, shown } = entry;
  const isKnown = shown.text !== undefined;
  for (const [bit, { row, text, seen }] of entry.bits.entries()) {
    const isOn = isKnown && hasBit(shown.bits.is, bit);
    row.classList.toggle("bad", !isGood(entry));
    row.classList.toggle("away", word.classList.contains("away"));
    row.classList.toggle("on", isGood(entry) && isOn);
    setText(text, isKnown ? (isOn ? "on" : "off") : "–");
    setText(seen, seenText(hasBit(shown.bits.off, bit), hasBit(shown.bits.on, bit), shown.bits.changes[bit]));
  }
}

/// They are disabled while nothing can be written, and say why. What was typed stays.
function showControls(entry) {
  const { point, shown } = entry;
  const away = element("device").dataset.state === "online" ? "" : element("device").textContent;
  const isKnown = shown !== null && shown.quality === "good" && typeof shown.value === "boolean";
  const why = away || (entry.switch && !isKnown ? "It is not known which value it has." : "");
  for (const control of entry.controls) {
    control.disabled = why !== "";
    control.title = why || (control.matches("input") && point.write.range) || "";
  }
  if (!entry.switch) return;
  entry.switch.setAttribute("aria-checked", String(isKnown && shown.value));
  setText(entry.switch, isKnown && shown.value ? "switch off" : "switch on");
}

function show(entry) {
  const { point, row, shown } = entry;
  const good = isGood(entry);
  const isBit = typeof shown.value === "boolean";
  row.classList.toggle("bad", !good);
  row.classList.toggle("away", shown.quality === "offline" || (!good && shown.quality === "never read"));
  row.classList.toggle("on", good && shown.value === true);
  const seconds = (performance.now() - entry.changedAt) / 1000;
  const age = entry.changedAt ? ageText(seconds) : "";
  row.classList.toggle("changed", good && shown.changes > 0 && seconds < 1);
  const about = [point.write_only ? "can only be written" : good ? age : qualityText(shown), bitsText(point, shown)].filter(Boolean).join(" · ");
  setText(entry.text, valueText(point, shown));
  setText(entry.about, about);
  setText(entry.seen, seenText(isBit && shown.off, isBit && shown.on, shown.changes));
  if (entry.switch) showControls(entry);
  showBits(entry);
}

/// A screen reader reads what is set, so only news is.
function say(state, text) {
  const device = element("device");
  const isNews = device.dataset.state !== state || device.textContent !== text;
  device.dataset.state = state;
  setText(device, text);
  if (state !== "online") setText(element("numbers"), "");
  if (isNews) rows.forEach(showControls);
}

function showDevice(device) {
  if (!device.online) return say("offline", `offline: ${device.why || "no answer yet"}`);
  say("online", "online");
  if (device.requests === 0) return undefined;
  const errors = device.errors > 0 ? `, ${device.errors} failed` : "";
  return setText(element("numbers"), ` · round trip ${device.round_trip_ms.toFixed(1)} ms · ${device.requests} requests${errors}`);
}

function take(news) {
  if (news.device) showDevice(news.device);
  for (const [name, state] of Object.entries(news.points)) {
    const entry = rows.get(name);
    if (!entry) continue;
    entry.shown = state;
    if (state.age !== undefined) entry.changedAt = performance.now() - 1000 * state.age;
    show(entry);
  }
}

// The last ten minutes.

/// A band from the least to the greatest value of each step; of bits, a bar where they were on.
function drawing(steps, isBit) {
  const known = steps.filter(Boolean);
  const low = isBit ? 0 : Math.min(...known.map((step) => step[0]));
  const high = isBit ? 1 : Math.max(...known.map((step) => step[1]));
  const scale = high > low ? 22 / (high - low) : 0;
  const y = (number) => (25 - (number - low) * scale).toFixed(1);
  return steps.map((step, x) => {
    if (!step) return "";
    const from = isBit ? 27 : Number(y(step[0])) + 1;
    return `M${x} ${from}H${x + 1}V${Number(y(step[1])) - 1}H${x}Z`;
  }).join("");
}

function draw(entry) {
  entry.path.setAttribute("d", drawing(entry.steps, entry.shown !== null && typeof entry.shown.value === "boolean"));
  drawBits(entry);
}

function drawBits(entry) {
  for (const [bit, { path }] of entry.bits.entries()) {
    const steps = entry.bitSteps.map((step) => step && [hasBit(step[1], bit) ? 0 : 1, hasBit(step[0], bit) ? 1 : 0]);
    path.setAttribute("d", drawing(steps, true));
  }
}

/// The steps that are known, moved on by those that have passed, and the newest.
function joined(steps, news, passed) {
  const old = steps.slice(passed, STEPS - (news.length - passed));
  return [...Array(STEPS - old.length - news.length).fill(null), ...old, ...news];
}

let lastStep = -Infinity; // of what is known of the histories

/// Asks for the steps that may be new, and draws what is to be seen.
async function drawAll() {
  const wanted = Math.min(STEPS, Math.ceil((performance.now() - drawAll.at) / 2000) + 2);
  drawAll.at = performance.now();
  const answer = await ask(`history.json?steps=${wanted}`);
  const step = Number(answer.headers.get("Step"));
  const passed = Math.min(STEPS, step - lastStep);
  if (passed > wanted) { // this machine has slept, and its clock with it
    drawAll.at = -Infinity;
    return drawAll();
  }
  const news = await answer.json();
  for (const [name, entry] of rows) {
    entry.steps = joined(entry.steps, news[name], passed);
    if (entry.point.bits) entry.bitSteps = joined(entry.bitSteps, news[`${name}.bits`], passed);
    if (!entry.row.hidden) draw(entry);
  }
  lastStep = step;
  return undefined;
}
drawAll.at = -Infinity;

async function drawOn() {
  for (;;) {
    if (!document.hidden) await drawAll().catch(() => { drawAll.at = -Infinity; });
    await new Promise((done) => { setTimeout(done, 2000); });
  }
}

// Writing.

async function write(entry, value) {
  hasWritten = true;
  entry.outcome.dataset.outcome = "waiting";
  entry.outcome.textContent = "…";
  try {
    const told = await (await ask("write", { method: "POST", body: JSON.stringify({ point: entry.point.name, value }) })).json();
    entry.outcome.dataset.outcome = told.outcome;
    entry.outcome.textContent = told.text;
  } catch (error) {
    entry.outcome.dataset.outcome = "lost";
    entry.outcome.textContent = error.status ? error.message : "lost: no answer of the panel; it may have been carried out";
  }
}

// The stream.

/// Waits until this page is one of those of this browser that have a stream. Otherwise a write, or the word that this
/// page is alive, would wait for a connection. Returns what ends that. Without a secure context there are no locks, nor is
/// there anything to write.
async function takeAPlace() {
  if (!navigator.locks) return () => {};
  const tryPlace = (place) => new Promise((done) => {
    const hold = (lock) => (lock ? new Promise((end) => { done(end); }) : done(null));
    navigator.locks.request(`stream ${place}`, { ifAvailable: true }, hold).catch(() => done(() => {}));
  });
  for (;;) {
    for (let place = 0; place < STREAMS; ++place) {
      const leave = await tryPlace(place);
      if (leave) return leave;
    }
    say("offline", `This browser shows ${STREAMS} pages of this panel and has no connections for more: close one of them.`);
    await new Promise((done) => { setTimeout(done, 1000); });
  }
}

/// Server-sent events by fetch: EventSource can show no token.
async function follow() {
  const silence = new AbortController();
  let timer = 0;
  const heard = () => {
    clearTimeout(timer);
    timer = setTimeout(() => silence.abort(new Error("the panel does not answer")), ANSWER_WITHIN);
  };
  heard();
  try {
    const reader = (await ask("events", { signal: silence.signal })).body.pipeThrough(new TextDecoderStream()).getReader();
    let rest = "";
    for (;;) {
      const { value, done } = await reader.read();
      if (done) throw new Error("the panel has ended");
      heard();
      rest += value;
      const events = rest.split("\n\n");
      rest = events.pop();
      for (const event of events) take(JSON.parse(event.slice("data: ".length)));
    }
  } finally {
    clearTimeout(timer);
  }
}

function loseAll(why) {
  say("offline", why);
  for (const entry of rows.values()) {
    if (!entry.shown) continue;
    entry.shown = { ...entry.shown, quality: "offline" };
    show(entry);
  }
}

function filter() {
  const wanted = element("filter").value.toLowerCase();
  for (const { point, row, bits } of rows.values()) {
    row.hidden = !`${point.name} ${point.description}`.toLowerCase().includes(wanted);
    for (const bit of bits) bit.row.hidden = row.hidden;
  }
}

async function save() {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(await (await ask("seen.csv")).blob());
  link.download = "seen.csv";
  link.click();
  URL.revokeObjectURL(link.href);
}

function showTable(device) {
  document.title = `${device.name}: panel`;
  element("name").textContent = `${device.name} at ${device.place}`;
  element("warning").textContent = device.warning || "";
  element("writes").hidden = !device.writes;
  element("write-head").hidden = !device.writes;
  device.points.forEach(addRow);
}

async function begin() {
  const answer = await fetch("token", { method: "POST", body: location.hash.slice(1) });
  if (!answer.ok) return say("offline", "Open the address that the terminal shows, with what stands behind #.");
  token = await answer.text();
  showTable(await (await ask("points.json")).json());
  element("filter").addEventListener("input", filter);
  element("save").addEventListener("click", save);
  element("print").addEventListener("click", () => window.print());
  setInterval(() => { for (const entry of rows.values()) if (entry.shown && !entry.row.hidden) show(entry); }, 1000);
  setInterval(() => { if (hasWritten) ask("alive", { method: "POST" }).catch(() => {}); }, ALIVE_EVERY);
  element("points").inert = true;
  const leave = await takeAPlace();
  element("points").inert = false;
  drawOn();
  for (;;) {
    const error = await follow().catch((why) => why);
    if (error.status === 401) {
      leave();
      return loseAll("This page is not known any more: open the address that the terminal shows now.");
    }
    loseAll(`${error.message}; trying again`);
    await new Promise((done) => { setTimeout(done, 1000); });
  }
}

addEventListener("hashchange", () => location.reload()); // another key
begin().catch((error) => say("offline", error.message));
