// The page of several runs: overlays over time and over the path, one window and one cursor.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { begin, csv, end, folder, opened, page, run, shot, unpacked, write } from './pages.mjs';

before(async () => {
  write('p.ngc', '(</script><script>window.hacked = 1</script>)\nG21 G90 G94\nG1 X40 F3000\nG2 X60 Y0 I10 J0\nG1 X60 Y30\nG1 X0 Y0 F1500\nM2\n');
  run('run', 'p.ngc', '-m', 'mill3', '-o', 'a.lcmlog', '-q');
  run('run', 'p.ngc', '-m', 'mill3', '-o', 'b.lcmlog', '-q', '--set', 'feed.max_acceleration_mm_s2=400');
  run('run', 'p.ngc', '-m', 'mill3', '-o', 'c.lcmlog', '-q', '--set', 'feed.max_mm_s=20');
  run('compare', 'a.lcmlog', 'b.lcmlog', 'c.lcmlog', '-o', 'abc.html', '-q');
  await begin();
});
after(end);

const summary = (log) => JSON.parse(run('export', log, '--json').trim().split('\n').at(-1));

test('the page of three runs loads without a complaint or a request and shows the table of the terminal', async () => {
  const view = await opened('abc.html', { height: 3300 });
  assert.deepEqual(view.complaints, []);
  assert.deepEqual(view.requests, [page('abc.html')]);
  assert.equal(await view.value('window.hacked === undefined'), true);
  assert.equal(await view.value('document.getElementById("comparison").textContent'), run('compare', 'a.lcmlog', 'b.lcmlog', 'c.lcmlog'));
  assert.equal(await view.value('getComputedStyle(document.getElementById("path")).display'), 'none');
  assert.match(readFileSync(join(folder, 'abc.html'), 'utf8'), /<noscript><h2>Feed over time<\/h2>/);
  await unpacked(view);
  await shot(view, 'compare.png');
});

test('every chart has all runs, with the values of their logs', async () => {
  const view = await opened('abc.html', { height: 3300 });
  await unpacked(view);
  const groups = await view.value('kadr.charts.groups.map((g) => ({ title: g.title, names: g.names }))');
  assert.deepEqual(groups[0], { title: 'Feed', names: ['A', 'B', 'C'] });
  assert.ok(groups.some((g) => g.title === 'Vibration X') && groups.every((g) => g.names.length === 3));
  for (const [k, log] of ['a.lcmlog', 'b.lcmlog', 'c.lcmlog'].entries()) {
    const rows = csv(log, 'feed.commanded*,path.length*');
    const got = await view.value(`(() => { const run = kadr.runs[${k}], t = run.tracks.get('feed.commanded_mm_s'); return { step: t.step, feed: [...t.high], path: [...run.path_u] }; })()`);
    assert.equal(got.feed.length, rows.length);
    rows.forEach((row, i) => {
      assert.ok(Math.abs(got.feed[i] - row[1]) <= 0.51 * got.step);
      assert.ok(Math.abs(got.path[i] - row[2]) <= 0.00051, `path of ${log} at ${i}`);
    });
  }
});

test('charts fill a window whose width changes', async () => {
  const view = await opened('abc.html', { width: 400, height: 3300 });
  // how far to the right the feed of the third and longest run comes, in its colour
  const reach = () => view.value(`(() => {
    const u = kadr.charts.plots[0], { left, top, width, height } = u.bbox, { data } = u.ctx.getImageData(left, top, width, height);
    let last = 0;
    for (let i = 0; i < data.length; i += 4)
      if (data[i] < 60 && Math.abs(data[i + 1] - 121) < 25 && Math.abs(data[i + 2] - 90) < 25) last = Math.max(last, (i / 4) % width);
    return last / width;
  })()`);
  assert.ok(await reach() > 0.95);
  // buttons of a narrow page are one line high and within it
  assert.deepEqual(await view.value('[...document.querySelectorAll("nav button")].map((b) => b.getBoundingClientRect()).filter((b) => b.right > 400 || b.height > 40)'), []);
  await view.send('Emulation.setDeviceMetricsOverride', { width: 1440, height: 3300, deviceScaleFactor: 1, mobile: false });
  await view.until('kadr.charts.plots[0].width > 1000');
  await view.frames();
  await view.until('kadr.charts.drawn');
  assert.ok(await reach() > 0.95);
});

test('the window reaches to the end of the longest run; a drag in one chart zooms all, the cursor reads all runs', async () => {
  const view = await opened('abc.html', { height: 3300 });
  await unpacked(view);
  const ends = ['a.lcmlog', 'b.lcmlog', 'c.lcmlog'].map((log) => summary(log).t_s);
  assert.ok(Math.abs(await view.value('kadr.state.end_s') - Math.max(...ends)) < 1e-9);
  const box = await view.value('(({ left, top, width, height }) => ({ left, top, width, height }))(document.querySelectorAll(".u-over")[1].getBoundingClientRect())');
  const y = box.top + box.height / 2;
  await view.mouse('mousePressed', box.left + box.width * 0.1, y, { button: 'left', clickCount: 1 });
  await view.mouse('mouseMoved', box.left + box.width * 0.3, y, { button: 'left', buttons: 1 });
  await view.mouse('mouseReleased', box.left + box.width * 0.3, y, { button: 'left', clickCount: 1 });
  await view.frames();
  await view.frames();
  const [from, to, end_s] = await view.value('[kadr.state.from_s, kadr.state.to_s, kadr.state.end_s]');
  assert.ok(Math.abs(from - 0.1 * end_s) < 0.01 * end_s && Math.abs(to - 0.3 * end_s) < 0.01 * end_s);
  assert.ok(await view.value('kadr.charts.plots.every((p) => p.scales.x.min === kadr.state.from_s && p.scales.x.max === kadr.state.to_s)'));
  // 0.8 s: what the legend of the first chart says is what the logs say
  await view.value('kadr.state.setCursor(0.8)');
  await view.frames();
  const legend = await view.value('[...document.querySelector(".chart h3").querySelectorAll(".v")].map((v) => Number(v.textContent))');
  const rows = ['a.lcmlog', 'b.lcmlog', 'c.lcmlog'].map((log) => csv(log, 'feed.commanded*,path.length*')[799]);
  rows.forEach((row, k) => {
    assert.equal(row[0], 0.8);
    assert.ok(Math.abs(legend[k] - row[1]) < 0.001, `${legend[k]} and ${row[1]}`);
  });
  // where each run is then, with its line
  const places = await view.value('[...document.querySelectorAll("#places tr")].map((r) => [...r.cells].map((c) => c.textContent))');
  assert.deepEqual(places.map((p) => p[0]), ['A', 'B', 'C']);
  rows.forEach((row, k) => assert.ok(Math.abs(Number(places[k][2].replace(' mm', '')) - row[2]) < 0.0011));
  assert.equal(places[0][4], 'G1 X40 F3000');
  assert.equal(places[0][3], '3');
});

test('over the path the runs stand where they are of one place', async () => {
  const view = await opened('abc.html', { height: 3300 });
  await unpacked(view);
  await view.value('document.getElementById("over-path").click()');
  await view.frames();
  await view.until('kadr.charts.drawn');
  const length = summary('a.lcmlog').path_u;
  assert.ok(Math.abs(await view.value('kadr.state.end_s') - length) < 0.002);
  // at 20 mm: feeds of the control tick in which each run passes it; that of C is its limit of 20 mm/s
  await view.value('kadr.state.setCursor(20)');
  await view.frames();
  const got = await view.value('kadr.charts.groups[0].curves.map((c) => c.at(20)[1])');
  ['a.lcmlog', 'b.lcmlog', 'c.lcmlog'].forEach((log, k) => {
    const row = csv(log, 'feed.commanded*,path.length*').find((r) => r[2] > 20);
    assert.ok(Math.abs(got[k] - row[1]) < 0.001, `${log}: ${got[k]} and ${row[1]}`);
  });
  assert.ok(Math.abs(got[2] - 20) < 0.001);
  assert.ok(got[0] > 45);
  await shot(view, 'compare_path.png');
  // the choice is in the address, also for a fresh look
  assert.match(await view.value('location.hash'), /path/);
});
