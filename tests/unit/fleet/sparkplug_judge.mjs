// SPDX-License-Identifier: GPL-3.0-or-later
// usage: node sparkplug_judge.mjs FILE
// FILE: a line a message, "topic \t qos \t retained \t payload in hex". Judges it by Sparkplug 3.0.0 (clauses in brackets) with Eclipse Tahu's decoder. Prints
// what is wrong, then counts as JSON; exit status 1 where anything is wrong.
import { readFileSync } from 'node:fs';
import sparkplug from 'sparkplug-payload';

const tahu = sparkplug.get('spBv1.0');
const wrong = [];
const counts = {};
const nodes = new Map();
let hostOnline = false;

const number = (value) => (value === null || value === undefined ? undefined : Number(value));

function judge(line, index) {
  const [topic, qos, , hex] = line.split('\t');
  const say = (what) => wrong.push(`message ${index} ${topic}: ${what}`);
  const parts = topic.split('/');
  if (parts[0] !== 'spBv1.0') return say('another namespace');
  const bytes = Buffer.from(hex ?? '', 'hex');
  if (parts[1] === 'STATE') {
    counts.STATE = (counts.STATE ?? 0) + 1;
    const state = JSON.parse(bytes.toString());
    if (typeof state.online !== 'boolean' || !Number.isInteger(state.timestamp)) say('STATE without online and timestamp [6.4.24]');
    hostOnline = state.online;
    return undefined;
  }
  const [, , kind, name, device] = parts;
  counts[kind] = (counts[kind] ?? 0) + 1;
  if ((kind[0] === 'D') !== (device !== undefined) || parts.length > 5) say('a device where none belongs, or none [4.1]');
  const payload = tahu.decodePayload(bytes);
  const metrics = payload.metrics ?? [];
  const seq = number(payload.seq);
  if (kind === 'NCMD') return seq === undefined ? undefined : say('a command with seq');
  if (payload.timestamp === undefined || payload.timestamp === null) say('no timestamp [6.4.6]');
  for (const one of metrics)
    if (!one.name || one.type === undefined || one.value === undefined) say(`metric ${one.name} without name, type or value`);
  const node = nodes.get(name) ?? { born: false, devices: new Map() };
  nodes.set(name, node);
  if (kind === 'NDEATH') {
    if (seq !== undefined) say('NDEATH with seq [6.4.22]');
    const death = number(metrics.find((one) => one.name === 'bdSeq')?.value);
    if (node.born && death !== node.bdSeq) say(`bdSeq ${death} of the death, ${node.bdSeq} of the birth`);
    node.born = false;
    return undefined;
  }
  if (qos !== '0') say(`QoS ${qos} [6.4: 0]`);
  if (kind === 'NBIRTH') {
    if (seq !== 0) say(`seq ${seq} of a birth [6.4.19]`);
    if (!hostOnline) say('born while its host is away [5.4]');
    const bdSeq = number(metrics.find((one) => one.name === 'bdSeq')?.value);
    const rebirth = metrics.find((one) => one.name === 'Node Control/Rebirth');
    if (bdSeq === undefined || bdSeq > 255) say('no bdSeq');
    if (!rebirth || rebirth.value !== false || rebirth.type !== 'Boolean') say('no Node Control/Rebirth = false');
    if (!node.born && node.bdSeq !== undefined && bdSeq !== (node.bdSeq + 1) % 256 && !node.skipped)
      say(`bdSeq ${bdSeq} after ${node.bdSeq}`);
    Object.assign(node, { born: true, bdSeq, seq: 0, devices: new Map() });
    return undefined;
  }
  if (!node.born) say('before its node was born');
  if (seq !== (node.seq + 1) % 256) say(`seq ${seq} after ${node.seq} [6.4.6]`);
  node.seq = seq;
  if (kind === 'DBIRTH') node.devices.set(device, new Map(metrics.map((one) => [one.name, one.type])));
  else if (kind === 'DDEATH') {
    if (!node.devices.delete(device)) say('death of a device that was not born');
  } else if (kind === 'DDATA') {
    const promised = node.devices.get(device);
    if (!promised) return say('data of a device that was not born');
    for (const one of metrics) if (promised.get(one.name) !== one.type) say(`${one.name} (${one.type}) was not in its birth`);
    if (metrics.some((one) => one.isHistorical)) counts.historical = (counts.historical ?? 0) + 1;
    if (metrics.length < 20) say(`${metrics.length} metrics`);
  } else say('an unexpected kind');
  return undefined;
}

// A line that was cut when the listener was ended is none.
const lines = readFileSync(process.argv[2], 'utf8').split('\n').slice(0, -1);
lines.forEach((line, index) => judge(line, index));
for (const one of wrong.slice(0, 20)) console.log(one);
console.log(JSON.stringify({ ...counts, wrong: wrong.length }));
process.exit(wrong.length > 0 || lines.length === 0 ? 1 : 0);
