// SPDX-License-Identifier: GPL-3.0-or-later
// A headless Chromium over its debugging pipe: no package needed beside node and the browser itself.
import { spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

export const browserName = () =>
  ['chromium', 'chromium-browser', 'google-chrome'].find((name) => spawnSync('which', [name]).status === 0) ?? null;

/** One page of a browser of its own: evaluate, click, type, drop files, take pictures. */
export class Page {
  static async open({ width = 1280, height = 720, dark = false } = {}) {
    const page = new Page();
    page.profile = mkdtempSync(join(tmpdir(), 'workbench-browser-'));
    page.process = spawn(
      browserName(),
      [
        '--headless=new',
        '--no-sandbox',
        '--disable-gpu',
        '--disable-dev-shm-usage',
        '--no-first-run',
        '--remote-debugging-pipe',
        `--user-data-dir=${page.profile}`,
        `--window-size=${width},${height}`,
        'about:blank',
      ],
      { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] },
    );
    page.waiting = new Map();
    page.next = 1;
    page.complaints = [];
    let left = '';
    page.process.stdio[4].on('data', (bytes) => {
      const parts = (left + bytes).split('\0');
      left = parts.pop();
      for (const part of parts) page.take(JSON.parse(part));
    });
    const { targetInfos } = await page.send('Target.getTargets', {}, null);
    const { sessionId } = await page.send(
      'Target.attachToTarget',
      { targetId: targetInfos.find((one) => one.type === 'page').targetId, flatten: true },
      null,
    );
    page.session = sessionId;
    for (const domain of ['Page', 'Runtime', 'DOM', 'Log', 'Network']) await page.send(`${domain}.enable`);
    await page.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: false });
    await page.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: dark ? 'dark' : 'light' }] });
    return page;
  }
  send(method, params = {}, session = this.session) {
    const id = this.next++;
    this.process.stdio[3].write(`${JSON.stringify({ id, method, params, ...(session ? { sessionId: session } : {}) })}\0`);
    return new Promise((done, fail) => this.waiting.set(id, { done, fail, method }));
  }
  take(message) {
    if (message.id !== undefined) {
      const call = this.waiting.get(message.id);
      this.waiting.delete(message.id);
      if (message.error) call.fail(new Error(`${call.method}: ${message.error.message}`));
      else call.done(message.result);
      return;
    }
    // Whatever the page complains about, a broken content policy included, fails the test in the end.
    if (message.method === 'Runtime.exceptionThrown')
      this.complaints.push(message.params.exceptionDetails.exception?.description ?? message.params.exceptionDetails.text);
    if (message.method === 'Log.entryAdded' && message.params.entry.level === 'error')
      this.complaints.push(`${message.params.entry.text} ${message.params.entry.url ?? ''}`);
    if (message.method === 'Network.requestWillBeSent') (this.requests ??= []).push(message.params.request.url);
  }
  async go(url) {
    await this.send('Page.navigate', { url });
  }
  async evaluate(expression) {
    const { result, exceptionDetails } = await this.send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description ?? exceptionDetails.text}`);
    return result.value;
  }
  /** Waits until an expression is true; throws with what it waited for. */
  async until(expression, what = expression, seconds = 60) {
    const end = Date.now() + seconds * 1000;
    for (;;) {
      const value = await this.evaluate(`(() => { try { return ${expression}; } catch { return null; } })()`).catch(() => null);
      if (value) return value;
      if (Date.now() > end) throw new Error(`waited ${seconds} s in vain for ${what}; the page says: ${await this.words()}`);
      await new Promise((done) => setTimeout(done, 60));
    }
  }
  words() {
    return this.evaluate(
      "[document.body.dataset.view, document.getElementById('command')?.textContent, document.getElementById('job-state')?.textContent, ...[...document.querySelectorAll('.error')].map((one) => one.textContent)].join(' | ')",
    );
  }
  async click(selector) {
    await this.until(
      `(() => { const one = document.querySelector(${JSON.stringify(selector)}); return one && !one.disabled && one.getClientRects().length > 0; })()`,
      selector,
    );
    // The page may move while an answer arrives: press again where the element is now, until it has the click.
    const one = `document.querySelector(${JSON.stringify(selector)})`;
    for (let attempt = 0; attempt < 5; ++attempt) {
      const [x, y] = await this.evaluate(
        `(() => {
          const one = ${one};
          one.scrollIntoView({ block: 'center' });
          window.wasClicked = false;
          one.addEventListener('click', () => { window.wasClicked = true; }, { once: true, capture: true });
          const box = one.getBoundingClientRect();
          return [box.left + box.width / 2, box.top + box.height / 2];
        })()`,
      );
      await this.drag([x, y], [x, y]);
      // A click that leaves the page has no answer any more.
      const clicked = await this.evaluate('window.wasClicked !== false');
      if (clicked || !(await this.evaluate(`Boolean(${one}) && !${one}.disabled`))) return;
    }
    throw new Error(`${selector} was pressed five times and had no click`);
  }
  /** The mouse from one point to another with its button down. */
  async drag([x0, y0], [x1, y1]) {
    const mouse = (type, x, y, buttons) =>
      this.send('Input.dispatchMouseEvent', {
        type,
        x,
        y,
        button: type === 'mouseMoved' && !buttons ? 'none' : 'left',
        buttons,
        clickCount: 1,
      });
    await mouse('mouseMoved', x0, y0, 0);
    await mouse('mousePressed', x0, y0, 1);
    if (x0 !== x1 || y0 !== y1)
      for (const share of [0.3, 0.7, 1]) await mouse('mouseMoved', x0 + share * (x1 - x0), y0 + share * (y1 - y0), 1);
    await mouse('mouseReleased', x1, y1, 0);
  }
  async type(selector, text) {
    await this.evaluate(`(() => { const one = document.querySelector(${JSON.stringify(selector)}); one.focus(); one.select(); })()`);
    await this.send('Input.insertText', { text });
  }
  async key(key, code = key) {
    for (const type of ['keyDown', 'keyUp'])
      await this.send('Input.dispatchKeyEvent', {
        type,
        key,
        code,
        ...(key === 'Enter' ? { text: '\r', windowsVirtualKeyCode: 13 } : key === 'Tab' ? { windowsVirtualKeyCode: 9 } : {}),
      });
  }
  async choose(selector, value) {
    await this.until(
      `[...document.querySelector(${JSON.stringify(selector)}).options].some((one) => one.value === ${JSON.stringify(value)})`,
      `${selector} to offer ${value}`,
    );
    await this.evaluate(
      `(() => { const one = document.querySelector(${JSON.stringify(selector)}); one.value = ${JSON.stringify(value)}; one.dispatchEvent(new Event('change')); })()`,
    );
  }
  /** Files ({name, text} or {name, bytes}) as if a person had dropped them on the page. */
  async drop(files) {
    const items = files.map(({ name, text, bytes }) => ({ name, base64: Buffer.from(bytes ?? text).toString('base64') }));
    await this
      .evaluate(`(() => { const data = new DataTransfer(); for (const one of ${JSON.stringify(items)}) data.items.add(new File([Uint8Array.from(atob(one.base64), (c) => c.charCodeAt(0))], one.name));
      document.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true })); })()`);
  }
  async picture(path) {
    const { data } = await this.send('Page.captureScreenshot', { format: 'png' });
    writeFileSync(path, Buffer.from(data, 'base64'));
  }
  async close() {
    const gone = new Promise((done) => this.process.on('exit', done));
    this.process.kill('SIGKILL');
    await gone;
    // Its helpers write for a moment longer; a profile that stays in the temporary folder harms nobody.
    for (let i = 0; i < 50; ++i) {
      try {
        return rmSync(this.profile, { recursive: true, force: true });
      } catch {
        await new Promise((wait) => setTimeout(wait, 100));
      }
    }
  }
}
