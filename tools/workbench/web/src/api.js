// SPDX-License-Identifier: GPL-3.0-or-later
import { emit, on, store } from './store.js';

/** What the server says no to, with its words. */
export class Refused extends Error {}

async function ask(method, path, params = {}, body = null) {
  const url = new URL(path, location.origin);
  for (const [key, value] of Object.entries(params)) for (const one of [value].flat()) url.searchParams.append(key, one);
  const response = await fetch(url, { method, body, headers: method === 'GET' ? {} : { 'X-Vernier': '1' } });
  if (response.ok) return response;
  const text = await response.text();
  let message = text;
  try {
    message = JSON.parse(text).message ?? text;
  } catch {
    /* plain text */
  }
  throw new Refused(message.trim());
}

export const getJson = async (path, params) => (await ask('GET', path, params)).json();
export const postJson = async (path, value) => (await ask('POST', path, {}, JSON.stringify(value))).json();
export const getBlob = async (path, params) => decode(await (await ask('GET', path, params)).arrayBuffer());
export const postBlob = async (path, value) => decode(await (await ask('POST', path, {}, JSON.stringify(value))).arrayBuffer());
/** `replace`: an existing file of this name is replaced, else it is refused. */
export const putFile = async (name, bytes, replace = false) =>
  (await ask('PUT', '/api/file', { name, ...(replace ? {} : { new: '1' }) }, bytes)).json();
export const deleteFile = async (name) => (await ask('DELETE', '/api/file', { name })).json();
export const fileAddress = (name) => `/api/file?name=${encodeURIComponent(name)}`;

/** JSON with typed arrays beside it (tools/workbench/files/blob.h). */
export function decode(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const base = 4 + length;
  const types = { f32: Float32Array, u32: Uint32Array, u8: Uint8Array };
  const filled = (value) => {
    if (Array.isArray(value)) return value.map(filled);
    if (value === null || typeof value !== 'object') return value;
    const [key] = Object.keys(value);
    if (types[key] && Array.isArray(value[key]) && Object.keys(value).length === 1)
      return new types[key](buffer, base + value[key][0], value[key][1]);
    return Object.fromEntries(Object.entries(value).map(([name, one]) => [name, filled(one)]));
  };
  return filled(JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length))));
}

export const job = { current: null, last: null };

/** Runs a command in the project and waits for its end; throws Refused with its message where it fails. */
export async function run(fields) {
  let state = await postJson('/api/jobs', fields);
  job.current = job.last = state;
  emit('job');
  while (state.state === 'running') {
    await new Promise((done) => setTimeout(done, state.seconds < 1 ? 40 : 150));
    state = await getJson('/api/jobs', { id: state.id });
    job.last = state;
    if (job.current?.id === state.id) job.current = state;
    emit('job');
  }
  if (job.current?.id === state.id) job.current = null;
  emit('job');
  await refresh();
  if (state.state !== 'done') throw Object.assign(new Refused(state.state === 'cancelled' ? 'cancelled' : state.message), { job: state });
  return state;
}

export async function cancel() {
  if (job.current) await ask('DELETE', '/api/jobs', { id: job.current.id });
}

export async function refresh() {
  const project = await getJson('/api/project');
  Object.assign(store, { folder: project.folder, version: project.version, files: project.files, history: project.history });
  emit('project');
}

export const named = (name) => store.files.some((file) => file.name === name || file.name.startsWith(`${name}/`));

/** A name that is not taken: base, base-2, base-3 ... with an ending. */
export function freeName(base, ending) {
  for (let i = 1; ; ++i) {
    const name = `${base}${i > 1 ? `-${i}` : ''}${ending}`;
    if (!named(name)) return name;
  }
}

export { on };
