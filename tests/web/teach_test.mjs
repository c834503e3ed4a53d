// The teaching page in a browser and its core in Node: node --test tests/web/teach_test.mjs; tools/web-test calls it with KADR (the
// program), KADR_CORE (core.wasm) and KADR_SHOTS (a folder for screenshots, which a person looks at).
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Browser } from './chromium.mjs';

const kadr = process.env.KADR;
const shots = process.env.KADR_SHOTS;
const folder = mkdtempSync(join(tmpdir(), 'kadr_teach_'));
let browser;

const run = (...args) => execFileSync(kadr, args, { cwd: folder, encoding: 'utf8', maxBuffer: 1 << 26, stdio: ['ignore', 'pipe', 'ignore'] });
const json = (...args) => JSON.parse(run(...args, '--json'));
/** Rows of a table that kadr prints, as cells. */
const printed = (text) => text.trim().split('\n').map((line) => line.trim().split(/\s+/));
const plain = (cell) => cell.replaceAll('\u2212', '-').replaceAll('\u202f', ' ').trim();

async function opened(address = '', options = {}) {
  const view = await browser.page(`file://${join(folder, 'teach.html')}${address}`, options);
  await view.until('document.body.classList.contains("ready")');
  await view.frames();
  return view;
}
const shot = async (view, name) => { if (shots) await view.shot(join(shots, name), true); };
const table = async (view, id) => (await view.value(`[...document.querySelectorAll("#${id} tbody tr")].map((tr) => [...tr.cells].map((c) => c.textContent))`)).map((row) => row.map(plain));
const fact = (view, name) => view.value(`document.querySelector('[data-fact=${name}]').textContent`).then(plain);
const click = async (view, selector) => { await view.value(`document.querySelector(${JSON.stringify(selector)}).click()`); await view.frames(); };

before(async () => {
  if (shots) mkdirSync(shots, { recursive: true });
  run('teach', 'page');
  browser = await Browser.open();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

test('20,000 traces have the same hash in the program, in WebAssembly and on the page', async () => {
  const native = json('teach', 'sweep').sweep_hash;
  const module = new WebAssembly.Module(readFileSync(process.env.KADR_CORE));
  assert.deepEqual(WebAssembly.Module.imports(module), []);  // the core asks for nothing
  const core = new WebAssembly.Instance(module).exports;
  core._initialize();
  const hash = (from, count, before) => core.sweep(from, count, before);
  assert.equal(BigInt.asUintN(64, hash(0, 20_000, core.sweep_begin())).toString(16).padStart(16, '0'), native);
  assert.notEqual(BigInt.asUintN(64, hash(0, 19_999, core.sweep_begin())).toString(16).padStart(16, '0'), native);
  const view = await opened();
  await click(view, '#try');
  assert.match(await view.value('document.getElementById("tried").textContent'), new RegExp(native));
});

test('the page opens without requests and complaints, and its policy admits its own script and core alone', async () => {
  const view = await opened();
  assert.deepEqual(view.complaints, []);
  assert.deepEqual(view.requests.filter((url) => !url.startsWith('file://') || !url.includes('teach.html')), []);
  const html = readFileSync(join(folder, 'teach.html'), 'utf8');
  assert.match(html, /default-src 'none'; script-src 'sha256-[^']+' 'wasm-unsafe-eval'; style-src 'sha256-/);
  assert.doesNotMatch(html, /https?:\/\/(?!www\.w3\.org)[^\s"]*\.(js|css|woff|png)/);
  assert.match(html, /wasi-libc\n\n/);
  const probe = await view.value(`(async () => {
    const s = document.createElement('script'); s.textContent = 'window.injected = 1'; document.body.append(s);
    let fetched = true; try { await fetch('https://example.org/'); } catch { fetched = false; }
    return [window.injected, fetched];
  })()`);
  assert.deepEqual([probe[0] ?? null, probe[1]], [null, false]);
});

const CASES = [...['line 7 4', 'line -5 8', 'arc 7 0 0 7 ccw', 'arc 0 7 7 0 cw', 'circle 9', 'ellipse 12 5', 'parabola 3 -8 8', 'bezier 0 10 12 10 12 0', 'bezier 12 0 12 9'].map((words) => words.split(' ')),
  ['curve', '400 y - x^3', '-20', '-20', '20', '20', 'cw']];
test('every cell of the step table is what kadr teach table prints, for every method that knows the case', async (t) => {
  let cells = 0;
  const view = await opened();
  for (const first of CASES) {
    const words = first.map(encodeURIComponent).join(',');
    await view.value(`location.hash = '#${words},half_step,0'`);
    await view.frames();
    for (const method of await view.value('[...document.getElementById("method").options].map((o) => o.value)')) {
      await view.value(`location.hash = '#${words},${method},2'`);
      await view.frames();
      if (await view.value('document.getElementById("wrong").textContent')) { assert.throws(() => run('teach', 'table', ...first, '--method', method)); continue; }
      const want = json('teach', 'table', ...first, '--method', method), rows = await table(view, 'steps');
      const text = printed(run('teach', 'table', ...first, '--method', method)).slice(2, 2 + rows.length);
      rows.forEach((row, i) => { assert.deepEqual(row.filter(Boolean), text[i], `${words} ${method} row ${i}`); cells += row.length; });
      assert.equal(rows.length, want.rows.length + 1);
      assert.equal(await fact(view, 'hash'), want.steps_hash);
      assert.equal(await fact(view, 'worst'), `${want.largest_deviation_steps.toFixed(4)} h`);
      assert.equal(await fact(view, 'length'), `${want.path_steps.toFixed(3)} h`);
    }
  }
  t.diagnostic(`${cells} cells`);
  assert.ok(cells > 5000);
  assert.deepEqual(view.complaints, []);
});

test('buttons, keys, slider, table and picture move one cursor; the address follows', async () => {
  const view = await opened('#line,7,4,half_step,0');
  const at = async () => Number(await view.value('document.querySelector("#steps tr.now").dataset.row'));
  const sentence = () => view.value('document.getElementById("sentence").textContent').then(plain);
  assert.match(await sentence(), /^Slot 0 of 11: G = 2F' = 3 is positive, so \+X/);
  await click(view, '#forward');
  assert.equal(await at(), 1);
  assert.match(await sentence(), /^Slot 1 of 11: G = 2F' = -5 is negative, so \+Y/);
  assert.match(await view.value('location.hash'), /^#line,7,4,half_step,1$/);
  await view.key('ArrowRight');
  await view.key('ArrowRight');
  assert.equal(await at(), 3);
  await shot(view, 'teach_line.png');
  await view.key('End');
  assert.equal(await at(), 11);
  assert.equal(await sentence(), 'The end node is reached.');
  await view.key('Home');
  await click(view, '#steps tr[data-row="6"]');
  assert.equal(await at(), 6);
  await view.value('(() => { const s = document.getElementById("slider"); s.value = 4; s.dispatchEvent(new Event("input")); })()');
  await view.frames();
  assert.equal(await at(), 4);
  // a click on node (7, 4), the end, in the picture
  const end = await view.value('(() => { const b = document.querySelector("#picture .cursor").getBoundingClientRect(); return [b.left + b.width / 2, b.top + b.height / 2]; })()');
  await view.key('End');
  await view.mouse('mousePressed', ...end, { button: 'left', clickCount: 1 });
  await view.mouse('mouseReleased', ...end, { button: 'left', clickCount: 1 });
  await view.frames();
  assert.equal(await at(), 4);
  // the cursor of the picture lies where the table says: one unit of the lattice a step
  const places = [];
  for (const row of [0, 1]) { await view.value(`location.hash = '#line,7,4,half_step,${row}'`); await view.frames(); places.push(await view.value('Number(document.querySelector("#picture .cursor").getAttribute("cx"))')); }
  assert.ok(places[1] - places[0] > 10);
  await view.key(' ');
  await view.until('document.querySelector("#steps tr.now").dataset.row >= 4');
  await view.key(' ');
  const stopped = await at();
  await new Promise((done) => setTimeout(done, 700));
  assert.equal(await at(), stopped);
});

test('the picture: a mark of sign at every node, a dual square a node of the path, the tested corner, and shapes beside colours', async () => {
  const view = await opened('#arc,7,0,0,7,ccw,half_step,3');
  const count = (selector) => view.value(`document.querySelectorAll("#picture ${selector}").length`);
  assert.equal(await count('.dual:not(.now)'), 15);
  // nodes -1 to 8 both ways: 100, and R = 7 has the two ends alone on it
  assert.equal(await count('.below:not(.tested)') + await count('.above:not(.tested)') + await count('.on:not(.begin)'), 100);
  assert.equal(await count('.on:not(.begin)'), 2);
  assert.equal(await count('.tested:not(.faint)'), 1);
  assert.match(await view.value('document.querySelector("#picture .worst + text").textContent'), /0\.616/);
  await click(view, '#show-squares');
  assert.equal(await count('.dual'), 0);
  await click(view, '#show-nodes');
  assert.equal(await count('.above:not(.tested)'), 0);
  // pulses: 14 rises in each of the two diagrams
  const rises = await view.value('[...document.querySelectorAll("#pulse-view .pulse:not(.dir)")].map((p) => (p.getAttribute("d").match(/V/g) ?? []).length / 2)');
  assert.deepEqual(rises, [7, 7, 7, 7]);
  await click(view, '#show-squares');
  await click(view, '#show-nodes');
  await shot(view, 'teach_arc.png');
});

test('times between pulses are those of kadr teach table --spacing', async () => {
  const view = await opened('#line,100,62,half_step,0');
  const text = plain(await view.value('document.getElementById("spacing").textContent'));
  const us = (timing) => json('teach', 'table', 'line', '100', '62', '--spacing', '--timing', timing).timing.axes.map((a) => `${a.name} ${[a.least_spacing_ticks, a.most_spacing_ticks].map((ticks) => (ticks / 10).toFixed(1).replace(/\B(?=(\d{3})+\.)/g, ' ')).join(' .. ')} us`).join(', ');
  assert.ok(text.includes(`one slot a pulse: ${us('uniform')}`), text);
  assert.ok(text.includes(`at the crossings: ${us('crossing')}`), text);
});

test('up to four methods side by side, with the numbers of kadr teach compare', async () => {
  const view = await opened('#compare,arc,7,0,0,7,ccw,classic,half_step,extra_points,chords,5');
  const want = printed(run('teach', 'compare', 'arc', '7', '0', '0', '7', 'ccw', ...['classic', 'half_step', 'extra_points', 'chords'].flatMap((m) => ['--method', m])));
  assert.deepEqual(await table(view, 'comparison'), want.slice(2, 6));
  assert.equal(await view.value('document.querySelectorAll("#compare-views svg").length'), 4);
  assert.ok((await view.value('document.getElementById("moves").textContent')).includes('half_step     YYYxYxYxYxYxxx'));
  // a fifth is not to be had; one less makes room
  assert.equal(await view.value('document.querySelector("#compared input[value=crossing]").disabled'), true);
  await click(view, '#compared input[value=chords]');
  assert.equal(await view.value('document.querySelectorAll("#compare-views svg").length'), 3);
  await click(view, '#compared input[value=printed_half_step]');
  assert.match((await table(view, 'comparison'))[3][9], /missed/);
  await click(view, '#compare-forward');
  assert.equal(await view.value('document.getElementById("compare-slot").textContent'), 'slot 6');
  await shot(view, 'teach_compare.png');
});

test('eight cases: four directions, both outcomes; a card leads to its step', async () => {
  const view = await opened('#cases');
  const cards = await view.value('[...document.querySelectorAll(".case")].map((c) => c.textContent)');
  assert.equal(cards.length, 8);
  assert.equal(new Set(cards.map((c) => c.replace(/^./, ''))).size, 8);
  for (const c of cards) assert.match(plain(c), /G = -\d+: Y steps$|G = \d+: X steps$/);
  await shot(view, 'teach_cases.png');
  await click(view, '[data-case=f]');
  assert.equal(await view.value('location.hash'), '#line,-7,-4,half_step,1');
  assert.match(plain(await view.value('document.getElementById("sentence").textContent')), /is negative, so -Y/);
});

test('the speed rose: L/(a + b), L/max(a, b), and a circle for pulses at their crossings', async () => {
  const view = await opened('#rose,half_step,diagonal');
  const rows = await table(view, 'rose-table');
  const long = Math.hypot(866, 500);
  assert.deepEqual(rows.map((r) => r[3 + 1]), [(long / 1366).toFixed(3), (long / 866).toFixed(3), '1.000']);
  assert.deepEqual(rows.map((r) => r[6]), ['1.414', '1.414', '1.000']);
  await shot(view, 'teach_rose.png');
});

test('joints: numbers of kadr teach bezier, and repairs that close the comb', async () => {
  const view = await opened('#joint');
  const text = execFileSync(kadr, ['teach', 'bezier', '0,0,0 2,2,4 5,-0.5,2', '5,-0.5,2 8,-3,0 11,-1,-2 12,1,-1'], { encoding: 'utf8' });
  assert.ok(text.includes(`normals ${(await fact(view, 'normals')).replace('\u00b0', '')} deg`));
  assert.ok(text.includes(`jumps by ${await fact(view, 'jump')}, ${await fact(view, 'share')}`));
  assert.ok(text.includes(`R_min ${(await fact(view, 'radius1')).replace(',', ' at')}`.replace('at t', 'at t')));
  await shot(view, 'teach_joint.png');
  await click(view, '#joint-kinds [value=g2]');
  assert.equal(await fact(view, 'jump'), '0.000000 1/mm');
  assert.match(text, /third point \(8\.6818, -6\.3182, -4\.4545\)/);
  assert.deepEqual((await table(view, 'joint-numbers'))[2], ['P2', '8.6818', '-6.3182', '-4.4545']);
  await click(view, '#joint-kinds [value=c2]');
  assert.equal(await fact(view, 'second'), '0.000 mm');
  await click(view, '#joint-eyes [value=joint]');
  await view.value('document.getElementById("joint-view").focus()');
  await view.key('ArrowLeft');
  assert.equal(await view.value('document.querySelector("#joint-eyes [aria-pressed=true]").value'), 'iso');
});

test('error of t beside error of the feed by degree, as kadr teach bezier --paper has them', async () => {
  const view = await opened('#feed,1,minimax,3');
  const rows = printed(execFileSync(kadr, ['teach', 'bezier', '0,0,0 2,2,4 5,-0.5,2', '--paper'], { encoding: 'utf8' }));
  for (const row of await table(view, 'feed-table')) {
    const want = rows.find((r) => r.join(' ').startsWith(`minimax degree ${row[0]} of Newton`)).slice(-3).map(Number);
    row.slice(1).forEach((cell, k) => assert.ok(Math.abs(Number(cell) - want[k]) <= 0.02 * want[k] + (k === 2 ? 0.5 : 0), `${row} ${want}`));
  }
  assert.match(await view.value('document.getElementById("feed-words").textContent'), /0\.818 %.*22\.3 %/);
  assert.equal(await view.value('document.querySelectorAll("#feed-charts svg").length'), 2);
  await shot(view, 'teach_feed.png');
  await click(view, '#feed-table tr[data-row="6"]');
  assert.equal(await view.value('location.hash'), '#feed,1,minimax,6');
});

test('what is wrong with a case is said, in either language, and nothing breaks', async () => {
  const view = await opened();
  const type = async (words) => {
    await view.value(`(() => { document.getElementById("words").value = ${JSON.stringify(words)}; document.getElementById("case-form").requestSubmit(); })()`);
    await view.frames();
    return view.value('document.getElementById("wrong").textContent');
  };
  assert.match(await type('spiral 3'), /begins with line/);
  assert.match(await type('line 7 x'), /\u2018x\u2019 is not a whole number/);
  assert.match(await type('arc 7 0 3 3'), /0\.707 steps off/);
  assert.match(await type('line 9000 1'), /no end after 4000 slots/);
  assert.match(await type('line 1 2 3'), /two axes/);
  assert.match(await type("curve 'y - z' 0 0 1 1"), /character 5 on/);
  await click(view, '#language');
  assert.match(await view.value('document.getElementById("wrong").textContent'), /\u043d\u0435 \u0447\u0438\u0442\u0430\u0435\u0442\u0441\u044f/);
  assert.equal(await type("curve '400 y - x^3' -20 -20 20 20 cw"), '');
  assert.equal(await fact(view, 'reached'), '(20, 20)');
  assert.deepEqual(view.complaints, []);
});

test('Russian and English say the same things; dark, narrow, printed and without script', async () => {
  const view = await opened('#line,7,4,half_step,3,ru', { scheme: 'dark' });
  assert.equal(await view.value('document.documentElement.classList.contains("dark")'), true);
  assert.match(await view.value('document.getElementById("sentence").textContent'), /^\u0422\u0430\u043a\u0442 3 \u0438\u0437 11/);
  // no word of the page stays English
  const left = await view.value('[...document.querySelectorAll(".w")].filter((e) => e.textContent === e.dataset.en && /[a-z]{3}/i.test(e.textContent)).map((e) => e.textContent)');
  assert.deepEqual(left, []);
  await shot(view, 'teach_dark_russian.png');
  for (const language of ['', ',ru']) {
    const narrow = await opened(`#arc,7,0,0,7,ccw,half_step,3${language}`, { width: 390, height: 900 });
    assert.equal(await narrow.value('document.documentElement.scrollWidth'), 390);
    // no title of a picture is cut off
    assert.deepEqual(await narrow.value('[...document.querySelectorAll("#pulse-view text.soft")].map((t) => t.getBoundingClientRect().right).filter((x) => x > 390)'), []);
    await shot(narrow, `teach_narrow${language}.png`);
  }
  const pdf = (await view.pdf(join(folder, 'teach.pdf'))).toString('latin1');
  assert.ok((pdf.match(/\/Type\s*\/Page\b/g) ?? []).length <= 3);
  const silent = await browser.page(`file://${join(folder, 'teach.html')}`, { script: false });
  await shot(silent, 'teach_no_script.png');
});

test('words are readable: contrast of text is at least 4.5 to 1 on either ground', async () => {
  for (const scheme of ['light', 'dark']) {
    const view = await opened('', { scheme });
    const ratios = await view.value(`(() => {
      const light = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255).map((v) => (v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)).reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
      const of = (n) => getComputedStyle(document.documentElement).getPropertyValue('--' + n).trim();
      return ['ink', 'soft', 'bad', 'c0', 'c1', 'c2', 'c3', 'mark'].map((n) => { const [a, b] = [light(of(n)), light(of('ground'))].sort((p, q) => q - p); return [n, (a + 0.05) / (b + 0.05)]; });
    })()`);
    for (const [name, ratio] of ratios) assert.ok(ratio >= 4.5, `${scheme} ${name} ${ratio.toFixed(2)}`);
  }
});
