// SPDX-License-Identifier: GPL-3.0-or-later
// The report's data as the program embedded it: JSON in which long rows of numbers are packed (tools/report/payload.h).

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

function unpacked(value) {
  if (Array.isArray(value)) return value.map(unpacked);
  if (value === null || typeof value !== 'object') return value;
  if (typeof value.f32 === 'string') return new Float32Array(bytesOf(value.f32).buffer);
  if (typeof value.u8 === 'string') return bytesOf(value.u8);
  return Object.fromEntries(Object.entries(value).map(([key, item]) => [key, unpacked(item)]));
}

export function readData() {
  return unpacked(JSON.parse(document.getElementById('report-data').textContent));
}

/** A number for people: `digits` significant ones; a dash where there is none. */
export function number(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return value.toExponential(digits - 1);
  const text = Number(value.toPrecision(digits)).toString();
  return text.replace('-', '−');
}

/** A sentence of the program with the signs of print: its own are those of any terminal. */
export const printed = (text) =>
  String(text ?? '')
    .replace(/\bum\b/g, 'µm')
    .replace(/\+-/g, '±')
    .replace(/\bdegC\b/g, '°C')
    .replace(/(?<![\w.])-(?=\d)/g, '−');

/** Fixed digits behind the point, as an instrument prints. */
export function fixed(value, digits) {
  return value === null || value === undefined || !Number.isFinite(value) ? '–' : value.toFixed(digits).replace('-', '−');
}
