// The report page in a browser: node --test tests/web/report_test.mjs; tools/web-test calls it with KADR (the program) and
// KADR_SHOTS (a folder for screenshots, which a person looks at).
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { begin, browser, csv, end, folder, opened, page, run, shot, shots, unpacked, write } from './pages.mjs';

// markup and script in every place that a program's text reaches; X400 leaves mill3's travel of 300 mm
const HOSTILE = `(</script><script>window.hacked = 1</script>)
(<img src=x onerror="window.hacked = 2"> <!--DATA--> <!--SUMMARY-->)
G21 G90 G94
G1 X20 F3000 ; <svg onload=window.hacked=3>
(MSG,<b onmouseover="window.hacked=4">bold</b>)
G2 X40 Y0 I10 J0
G4 P0.2
G1 X310 (off the table)
G1 X0
M2
`;

before(async () => {
  write('hostile.ngc', HOSTILE);
  run('run', 'hostile.ngc', '-m', 'mill3', '-o', 'hostile.lcmlog', '-q');
  run('report', 'hostile.lcmlog', '-o', 'hostile.html', '-q');
  await begin();
});
after(end);

test('the page loads from a file without a complaint or a request, and no text of a program becomes markup or script', async () => {
  const view = await opened('hostile.html', { height: 3300 });
  assert.deepEqual(view.complaints, []);
  assert.deepEqual(view.requests, [page('hostile.html')]);
  assert.equal(await view.value('window.hacked === undefined'), true);
  assert.equal(await view.value('document.querySelectorAll("main img, main b:not(.row b):not(.w), svg[onload], [onerror]").length'), 0);
  assert.match(await view.value('document.getElementById("lines").textContent'), /<script>window.hacked = 1<\/script>/);
  assert.equal(await view.value('kadr.path.kind'), 'webgl');
  await shot(view, 'light.png', true);
});

test('the security policy refuses what would come in all the same', async () => {
  const view = await opened('hostile.html');
  await view.value('{ const s = document.createElement("script"); s.textContent = "window.hacked = 5"; document.body.append(s); }');
  assert.equal(await view.value('window.hacked === undefined'), true);
  assert.equal(await view.value('fetch("data:text/plain,x").then(() => "came", () => "refused")'), 'refused');
});

test('numbers in the page equal those of the log', async () => {
  const view = await opened('hostile.html');
  const summary = JSON.parse(run('export', 'hostile.lcmlog', '--json').trim().split('\n').at(-1));
  const cell = (id, row) => view.value(`[...document.querySelectorAll('#${id} tr')].find((r) => r.cells[0].textContent === '${row}').cells[1].textContent`);
  assert.equal(await cell('run', 'time'), `${summary.t_s.toFixed(3)} s`);
  assert.equal(await cell('run', 'steps hash'), summary.steps_hash);
  assert.equal(await cell('run', 'path error, peak'), `${summary.path_error_um.toFixed(3)} um`);
  for (const [reason, time_s] of Object.entries(summary.limited_by_s)) assert.equal(await cell('reasons', reason), `${time_s.toFixed(3)} s`);

  await unpacked(view);
  const rows = csv('hostile.lcmlog', 'axis.X.steps,feed.commanded*,axis.X.vibration*,path.error*');
  const got = await view.value(`({ nodes: [...kadr.run.positions.value.pieces[0]], tracks: ['feed.commanded_mm_s', 'axis.X.vibration_um', 'path.error_um'].map((n) => { const t = kadr.run.tracks.get(n); return { step: t.step, values: [...t.high] }; }) })`);
  assert.deepEqual(got.nodes, rows.map((r) => r[1]));
  got.tracks.forEach((track, k) => {
    const worst = Math.max(...rows.map((r, i) => Math.abs(r[k + 2] - track.values[i]) / track.step));
    assert.ok(worst <= 0.51, `${k}: off by ${worst} steps of the packing`);
  });
});

test('an alarm leads to its line, its instant and its point of the path', async () => {
  const view = await opened('hostile.html');
  const at = await view.value('(({ t, line }) => ({ t: Number(t), line: Number(line) }))(document.querySelector("#alarms tr.alarm").dataset)');
  assert.equal(at.line, 8);
  await view.value('document.querySelector("#alarms tr.alarm").click()');
  await view.frames();
  assert.equal(await view.value('kadr.state.cursor_s'), at.t);
  assert.ok(await view.value(`kadr.state.from_s < ${at.t} && ${at.t} < kadr.state.to_s && kadr.state.to_s - kadr.state.from_s < 0.3`));
  assert.equal(await view.value('kadr.listing.current'), 8);
  assert.match(await view.value('document.querySelector(".row.now").textContent'), /^8G1 X310/);
  // the caret stands below the word
  assert.match(await view.value('document.querySelector("#alarms tr.alarm pre").textContent'), /^8 \| G1 X310 \(off the table\)\n {2}\| \^/);
  await shot(view, 'alarm.png', true);
});

test('cursor and window are one for charts, program and path; the mouse, the keyboard and a line move them', async () => {
  const view = await opened('hostile.html', { height: 3300 });
  const box = await view.value('(({ left, top, width, height }) => ({ left, top, width, height }))(document.querySelectorAll(".u-over")[2].getBoundingClientRect())');
  const y = box.top + box.height / 2;
  await view.mouse('mouseMoved', box.left + box.width / 4, y);
  await view.frames();
  const end_s = await view.value('kadr.state.end_s');
  const cursor_s = await view.value('kadr.state.cursor_s');
  assert.ok(Math.abs(cursor_s - end_s / 4) < 0.01 * end_s);
  // every chart has its upright line there
  const lines = await view.value('[...document.querySelectorAll(".u-cursor-x")].map((e) => new DOMMatrix(getComputedStyle(e).transform).e)');
  assert.ok(lines.length >= 8 && lines.every((x) => Math.abs(x - box.width / 4) < 1.5), lines.join());
  // a drag over the second half zooms all of them
  await view.mouse('mousePressed', box.left + box.width / 2, y, { button: 'left', clickCount: 1 });
  await view.mouse('mouseMoved', box.left + box.width * 0.75, y, { button: 'left', buttons: 1 });
  await view.mouse('mouseReleased', box.left + box.width * 0.75, y, { button: 'left', clickCount: 1 });
  await view.frames();
  const [from_s, to_s] = await view.value('[kadr.state.from_s, kadr.state.to_s]');
  assert.ok(Math.abs(from_s - end_s / 2) < 0.01 * end_s && Math.abs(to_s - 0.75 * end_s) < 0.01 * end_s);
  // charts out of sight follow when they come into it
  const followed = '[...document.querySelectorAll(".chart")].map((c, k) => ({ c: c.getBoundingClientRect(), x: kadr.charts.plots[k].scales.x })).filter(({ c }) => c.bottom > 0 && c.top < innerHeight).map(({ x }) => x.min === kadr.state.from_s && x.max === kadr.state.to_s)';
  assert.ok((await view.value(followed)).every((f) => f) && (await view.value(followed)).length >= 4);
  await view.value('scrollTo(0, document.body.scrollHeight)');
  await view.frames();
  await view.frames();
  assert.ok((await view.value(followed)).every((f) => f));
  await view.value('scrollTo(0, 0)');
  await view.value('document.getElementById("charts").focus()');
  await view.key('+');
  assert.ok(Math.abs(await view.value('kadr.state.to_s - kadr.state.from_s') - (to_s - from_s) / 2) < 1e-6);
  // the upright line stays at its instant when the window changes below it
  const off = await view.value(`(() => { const s = kadr.state, at = (s.cursor_s - s.from_s) / (s.to_s - s.from_s) * ${box.width}; return new DOMMatrix(getComputedStyle(document.querySelectorAll('.u-cursor-x')[2]).transform).e - at; })()`);
  assert.ok(Math.abs(off) < 1.5, `${off} pixels beside`);
  await view.key('ArrowLeft');
  await view.key('Home');
  assert.equal(await view.value('kadr.state.from_s'), 0);
  // a line of the program
  await view.value('[...document.querySelectorAll(".row")].find((r) => r.dataset.line === "6").click()');
  await view.frames();
  const [first, last] = await view.value('[kadr.state.from_s, kadr.state.to_s]');
  const block = await view.value('kadr.run.blocks.t_s[kadr.run.blocks.line.indexOf(6)]');
  assert.ok(first < block && block < last && last - first < end_s / 2);
});

test('dark, Russian, 2-D, printed and without script', async () => {
  let view = await opened('hostile.html', { scheme: 'dark', height: 3300 });
  assert.equal(await view.value('document.documentElement.classList.contains("dark")'), true);
  await shot(view, 'dark.png', true);
  view = await opened('hostile.html#ru,no-webgl', { height: 3300 });
  assert.equal(await view.value('document.querySelector("#text h2").textContent'), 'Программа');
  assert.equal(await view.value('kadr.path.kind'), '2d');
  assert.deepEqual(view.complaints, []);
  await shot(view, 'russian_2d.png', true);
  const pdf = (await view.pdf(join(folder, 'page.pdf'))).toString('latin1');
  const pages = (pdf.match(/\/Type\s*\/Page\b/g) ?? []).length;
  assert.ok(pages >= 1 && pages <= 4, `${pages} pages`);
  if (shots) writeFileSync(join(shots, 'print.pdf'), readFileSync(join(folder, 'page.pdf')));
  view = await browser.page(page('hostile.html'), { script: false, height: 1400 });
  await shot(view, 'no_script.png');
  const html = readFileSync(join(folder, 'hostile.html'), 'utf8');
  assert.match(html, /<noscript><svg /);
  for (const name of ['uplot', 'twgl.js']) assert.match(html, new RegExp(`\\n?${name} [0-9.]+\\n\\n`));
});

test('the frame of a page, without a run in it, is at most 120 kB', (t) => {
  const html = readFileSync(join(folder, 'hostile.html'), 'utf8');
  const frame = html.replace(/<script type="application[^]*?<\/script>\n/g, '').replace(/(<section id="summary"[^>]*>)[^]*?<\/section>/, '$1').replace(/<noscript>[^]*?<\/noscript>/, '');
  t.diagnostic(`${Buffer.byteLength(frame)} B of ${Buffer.byteLength(html)} B`);
  assert.ok(Buffer.byteLength(frame) > 90_000, 'script and licences are in what is measured');
  assert.ok(Buffer.byteLength(frame) <= 120_000);
});

test('words of both languages are readable: contrast of text is at least 4.5 to 1 on either ground', async () => {
  for (const scheme of ['light', 'dark']) {
    const view = await opened('hostile.html', { scheme });
    const colours = await view.value(`Object.fromEntries(['ground', 'ink', 'soft', 'card', 'warn', 'bad', 'c0', 'c1', 'c2', 'c3', 'c4', 'c5'].map((n) => [n, getComputedStyle(document.documentElement).getPropertyValue('--' + n).trim()]))`);
    const light = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255).map((v) => (v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)).reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
    const contrast = (a, b) => { const [x, y] = [light(a), light(b)].sort((p, q) => q - p); return (x + 0.05) / (y + 0.05); };
    for (const name of ['ink', 'soft', 'warn', 'bad', 'c0', 'c1', 'c2', 'c3', 'c4', 'c5'])
      assert.ok(contrast(colours[name], colours.ground) >= 4.5, `${scheme} ${name}: ${contrast(colours[name], colours.ground).toFixed(2)}`);
    assert.ok(contrast(colours.ink, colours.card) >= 4.5 && contrast(colours.soft, colours.card) >= 4.5);
  }
});
