// What tests of pages share: the program, a folder of their own, one browser.
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { Browser } from './chromium.mjs';

const kadr = process.env.KADR;
export const shots = process.env.KADR_SHOTS;
export const folder = mkdtempSync(join(tmpdir(), 'kadr_pages_'));
export let browser;

export async function begin() {
  if (shots) mkdirSync(shots, { recursive: true });
  browser = await Browser.open();
}
export async function end() {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
}

/** Runs kadr; alarms end with exit code 3, which is no fault here. */
export function run(...args) {
  try {
    return execFileSync(kadr, args, { cwd: folder, encoding: 'utf8', maxBuffer: 1 << 30, stdio: ['ignore', 'pipe', 'ignore'] });
  } catch (error) {
    if (error.status === 3) return error.stdout;
    throw error;
  }
}
export const csv = (log, signals) => run('export', log, '--csv', '--signals', signals).trim().split('\n').slice(1).map((row) => row.split(',').map(Number));
export const page = (name) => `file://${join(folder, name)}`;

export async function opened(name, options) {
  const view = await browser.page(page(name), options);
  await view.until('document.body.classList.contains("ready")');
  await view.frames();
  await view.until('kadr.charts.drawn');
  return view;
}
/** Everything is unpacked, also what nobody has looked at. */
export const unpacked = (view) => view.value('Promise.all([...(kadr.runs ?? [kadr.run]).map((run) => run.positions.load()), kadr.charts.loaded()]).then(() => true)');
export async function shot(view, name, whole) {
  if (shots) await view.shot(join(shots, name), whole);
}

export const write = (name, text) => writeFileSync(join(folder, name), text);
