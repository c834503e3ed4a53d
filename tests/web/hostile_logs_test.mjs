// Pages of logs that a stranger made: markup and script in every text, numbers at the end of the range, odd names of axes.
// The logs have no summary, so no hash denies them: they are read like logs that were cut off.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { begin, end, folder, opened, page, run, shot, unpacked, write } from './pages.mjs';

const MARKUP = {
  'p.ngc': '</script><script>window.hacked = 1</script>',
  mill3: '<img src=x onerror="window.hacked = 2"> <!--DATA--> <!--SUMMARY-->',
  X: '<svg onload=window.hacked=3>',
  Y: '"><b onclick=x>,*\u2028',
  line: '<iframe srcdoc="<script>parent.hacked = 4</script>">',
  'G1 X20 F3000': '</pre><script>window.hacked = 5</script>',
  'bold move': "<b onmouseover='window.hacked = 6'>${window.hacked = 7}</b>",
};

function events(log) {
  const data = readFileSync(join(folder, log));
  const list = [];
  for (let at = 0; at + 28 <= data.length;) {
    const channel = data.readUInt32BE(at + 20), size = data.readUInt32BE(at + 24), from = at + 28 + channel;
    list.push({ time: data.subarray(at + 12, at + 20), channel: data.toString('latin1', at + 28, from), data: data.subarray(from, from + size) });
    at = from + size;
  }
  return list;
}
function save(name, list) {
  const parts = list.flatMap((event, number) => {
    const head = Buffer.alloc(28);
    head.writeUInt32BE(0xeda1da01, 0);
    head.writeBigInt64BE(BigInt(number), 4);
    event.time.copy(head, 12);
    head.writeUInt32BE(event.channel.length, 20);
    head.writeUInt32BE(event.data.length, 24);
    return [head, Buffer.from(event.channel, 'latin1'), event.data];
  });
  writeFileSync(join(folder, name), Buffer.concat(parts));
}
/** A text as a message has it: length with its zero byte, the text, a zero byte. */
function coded(text) {
  const bytes = Buffer.from(`${text}\0`, 'utf8'), size = Buffer.alloc(4);
  size.writeUInt32BE(bytes.length);
  return Buffer.concat([size, bytes]);
}
function replaced(data, from, to) {
  const old = coded(from), fresh = coded(to);
  for (let at = data.indexOf(old); at >= 0; at = data.indexOf(old, at + fresh.length))
    data = Buffer.concat([data.subarray(0, at), fresh, data.subarray(at + old.length)]);
  return data;
}
/** Writes the page of a log without a summary; the answer is no, and nothing else happens. */
function report(log, html) {
  const done = spawnSync(process.env.KADR, ['report', log, '-o', html], { cwd: folder, encoding: 'utf8' });
  assert.equal(done.status, 1, done.stderr);
  assert.match(done.stderr, /cut off: no KADR_SUMMARY/);
}

before(async () => {
  write('p.ngc', 'G21 G90 G94\nG1 X20 F3000\n(MSG,bold move)\nG2 X40 Y0 I10 J0\nG4 P0.2\nG1 X0 Y5\nM2\n');
  run('run', 'p.ngc', '-m', 'mill3', '-o', 'true.lcmlog', '-q', '--set', 'log.viewer_rate_hz=0');
  const list = events('true.lcmlog').filter((event) => event.channel !== 'KADR_SUMMARY');
  const texts = list.map((event) => {
    if (event.channel === 'KADR_TICKS' || event.channel === 'KADR_STEPS') return event;
    return { ...event, data: Object.entries(MARKUP).reduce((data, [from, to]) => replaced(data, from, to), event.data) };
  });
  save('texts.lcmlog', texts);
  // the first column is the feed: finite values beyond any picture, in turn
  let turn = 0;
  const huge = list.map((event) => {
    if (event.channel !== 'KADR_TICKS') return event;
    const data = Buffer.from(event.data), n = data.readInt32BE(24);
    for (let i = 0; i < n; ++i) data.writeDoubleBE(turn % 2 ? 1e308 : -1e308, 40 + 8 * i);
    turn += 1;
    return { ...event, data };
  });
  save('huge.lcmlog', huge);
  for (const name of ['texts', 'huge']) report(`${name}.lcmlog`, `${name}.html`);
  await begin();
});
after(end);

test('no text of a log becomes markup or script of its page', async () => {
  const view = await opened('texts.html', { height: 3300 });
  await unpacked(view);
  assert.deepEqual(view.complaints, []);
  assert.deepEqual(view.requests, [page('texts.html')]);
  assert.equal(await view.value('window.hacked === undefined'), true);
  assert.equal(await view.value('document.querySelectorAll("iframe, [onerror], [onload], [onclick], [onmouseover]").length'), 0);
  // the names are there, as text
  const text = await view.value('document.body.textContent');
  for (const name of [MARKUP.mill3, MARKUP['p.ngc'], MARKUP['bold move']]) assert.ok(text.includes(name.slice(0, 20)), name);
  assert.ok(await view.value(`kadr.run.tracks.has(${JSON.stringify(`axis.${MARKUP.X}.speed_mm_s`)})`));
  await shot(view, 'hostile_texts.png', true);
});

test('values beyond any picture are drawn without a complaint', async () => {
  const view = await opened('huge.html', { height: 3300 });
  await unpacked(view);
  assert.deepEqual(view.complaints, []);
  assert.equal(await view.value('Number.isFinite(kadr.run.tracks.get("feed.commanded_mm_s").step)'), true);
  await view.value('kadr.state.setCursor(0.1)');
  await view.frames();
  assert.deepEqual(view.complaints, []);
});
