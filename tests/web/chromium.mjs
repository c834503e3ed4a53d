// Drives a headless Chromium over its debugging pipe (DevTools protocol) with nothing but Node's own library.
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

// root needs --no-sandbox; SwiftShader gives WebGL without a graphics card, and all else is drawn by the processor, as Chromium does
// on a machine that has none
const FLAGS = ['--headless', '--no-sandbox', '--disable-gpu-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
  '--disable-accelerated-2d-canvas', '--disable-gpu-rasterization',
  '--no-first-run', '--disable-extensions', '--disable-background-networking', '--hide-scrollbars', '--force-color-profile=srgb', '--lang=en-US'];

export class Browser {
  static async open() {
    const browser = new Browser();
    browser.profile = mkdtempSync(join(tmpdir(), 'kadr_web_'));
    browser.child = spawn(process.env.KADR_CHROMIUM ?? 'chromium', [...FLAGS, `--user-data-dir=${browser.profile}`, '--remote-debugging-pipe', 'about:blank'],
      { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'], detached: true });
    browser.next = 1;
    browser.waiting = new Map();
    browser.pages = new Map();
    let rest = '';
    browser.child.stdio[4].setEncoding('utf8');
    browser.child.stdio[4].on('data', (text) => {
      const messages = (rest + text).split('\0');
      rest = messages.pop();
      for (const message of messages) browser.take(JSON.parse(message));
    });
    browser.child.on('exit', () => { for (const { fail } of browser.waiting.values()) fail(new Error('chromium ended')); });
    return browser;
  }

  take(message) {
    if (message.id) {
      const { done, fail } = this.waiting.get(message.id);
      this.waiting.delete(message.id);
      if (message.error) fail(new Error(message.error.message)); else done(message.result);
    } else this.pages.get(message.sessionId)?.event(message);
  }

  send(method, params = {}, sessionId = undefined) {
    const id = this.next++;
    this.child.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return new Promise((done, fail) => this.waiting.set(id, { done, fail }));
  }

  async page(url, { width = 1440, height = 1000, scale = 1, script = true, scheme = 'light' } = {}) {
    const { targetId } = await this.send('Target.createTarget', { url: 'about:blank' });
    const { sessionId } = await this.send('Target.attachToTarget', { targetId, flatten: true });
    const page = new Page(this, sessionId, targetId);
    this.pages.set(sessionId, page);
    for (const domain of ['Page', 'Runtime', 'Network', 'Log']) await page.send(`${domain}.enable`);
    await page.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: scale, mobile: false });
    await page.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: scheme }] });
    if (!script) await page.send('Emulation.setScriptExecutionDisabled', { value: true });
    const loaded = new Promise((done) => { page.loaded = done; });
    await page.send('Page.navigate', { url });
    await loaded;
    return page;
  }

  /** Processor time that all its processes have used: says more than a clock on a machine that others use too. */
  cpu_ms() {
    let ticks = 0;
    for (const name of readdirSync('/proc')) {
      if (!/^\d+$/.test(name)) continue;
      try {
        const fields = readFileSync(`/proc/${name}/stat`, 'utf8').split(') ').at(-1).split(' ');
        if (Number(fields[2]) === this.child.pid) ticks += Number(fields[11]) + Number(fields[12]);
      } catch { /* it ended */ }
    }
    return 10 * ticks;
  }

  async close() {
    await this.send('Browser.close').catch(() => {});
    await new Promise((done) => { if (this.child.exitCode !== null) done(); else this.child.on('exit', done); });
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }
}

class Page {
  constructor(browser, session, target) {
    this.browser = browser;
    this.target = target;
    this.session = session;
    this.complaints = [];  // console errors and uncaught exceptions
    this.requests = [];
  }
  send(method, params) { return this.browser.send(method, params, this.session); }
  event({ method, params }) {
    if (method === 'Page.loadEventFired') this.loaded?.();
    if (method === 'Runtime.exceptionThrown') this.complaints.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    if (method === 'Runtime.consoleAPICalled' && ['error', 'warning'].includes(params.type)) this.complaints.push(params.args.map((a) => a.value).join(' '));
    if (method === 'Log.entryAdded' && ['error', 'warning'].includes(params.entry.level)) this.complaints.push(params.entry.text);
    if (method === 'Network.requestWillBeSent') this.requests.push(params.request.url);
  }
  /** The value of an expression in the page. */
  async value(expression) {
    const { result, exceptionDetails } = await this.send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }
  async until(expression, most_ms = 20_000) {
    for (const begun = Date.now(); Date.now() - begun < most_ms;) {
      if (await this.value(expression)) return;
      await new Promise((done) => setTimeout(done, 20));
    }
    throw new Error(`never true: ${expression}`);
  }
  /** Two frames have been drawn since. */
  frames() { return this.value('new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))'); }
  async key(key, modifiers = 0) {
    const text = key.length === 1 ? key : undefined;
    for (const type of ['keyDown', 'keyUp']) await this.send('Input.dispatchKeyEvent', { type, key, text: type === 'keyDown' ? text : undefined, modifiers, code: key });
    await this.frames();
  }
  async mouse(type, x, y, more = {}) { await this.send('Input.dispatchMouseEvent', { type, x, y, ...more }); }
  async shot(path, whole = false) {
    const { data } = await this.send('Page.captureScreenshot', { format: 'png', captureBeyondViewport: whole });
    writeFileSync(path, Buffer.from(data, 'base64'));
  }
  async close() { await this.browser.send('Target.closeTarget', { targetId: this.target }); }
  async pdf(path) {
    const { data } = await this.send('Page.printToPDF', { preferCSSPageSize: true, printBackground: true });
    const bytes = Buffer.from(data, 'base64');
    writeFileSync(path, bytes);
    return bytes;
  }
}
