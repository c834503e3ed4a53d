// A run of 10 minutes in the page: nothing of it is lost, whatever the zoom; its size; and, printed but not judged, how long
// opening and zooming take.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { loadavg } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { begin, browser, csv, end, folder, opened, run, shot, unpacked, write } from './pages.mjs';

const TIMES = 5;
const middle = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];
const size = (name) => readFileSync(join(folder, name)).length;

before(async () => {
  const lines = ['G21 G90 G94 G64 P0.02'];
  for (let k = 0; k < 300; k++) lines.push(`G3 X0 Y0 I${20 + (k % 7)} J${k % 5} F3000`, `G1 X${1 + (k % 9)} F1200`, 'G1 X0');
  lines.push('M2', '');
  write('long.ngc', lines.join('\n'));
  run('run', 'long.ngc', '-m', 'mill3', '-o', 'long.lcmlog', '-q', '--until', '600');
  run('report', 'long.lcmlog', '-o', 'long.html', '-q');
  run('report', 'long.lcmlog', '-o', 'overview.html', '-q', '--max-size-mb', '1');
  await begin();
});
after(end);

/** Milliseconds of an action in the page until two frames later. */
const timed = (view, action) => view.value(`(async () => {
  const two = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  await two();
  const begun = performance.now();
  ${action};
  await two();
  return performance.now() - begun;
})()`);

test('a page of 600 000 control ticks: size, and how long it takes to open and to zoom', async (t) => {
  const opens = [], cpu = [], inside = {};
  let view;
  for (let k = 0; k < TIMES; k++) {
    await browser.page('about:blank').then((empty) => empty.close());
    const used = browser.cpu_ms();
    view = await opened('long.html');
    // the page's clock begins with the navigation: making a tab is the browser's own time
    opens.push(await view.value('performance.now()'));
    cpu.push(browser.cpu_ms() - used);
    for (const [name, ms] of Object.entries(await view.value('kadr.ms'))) (inside[name] ??= []).push(ms);
    if (k + 1 < TIMES) await view.close();
  }
  const ticks = await view.value('kadr.run.meta.control_ticks');
  assert.ok(ticks > 500_000);
  assert.equal(await view.value('kadr.run.meta.every'), 1);
  assert.ok(size('long.html') <= 10e6);
  const ms = (values) => `${middle(values).toFixed(0)} ms (${Math.min(...values).toFixed(0)} to ${Math.max(...values).toFixed(0)})`;
  t.diagnostic(`load of this machine ${loadavg()[0].toFixed(1)}; medians of ${TIMES}, lowest and highest behind`);
  t.diagnostic(`${ticks} control ticks, ${await view.value('kadr.run.meta.tracks.length')} signals, ${(size('long.html') / 1e6).toFixed(2)} MB`);
  t.diagnostic(`open to drawn ${ms(opens)}; processor time ${ms(cpu)}; script begins at ${ms(inside.begun)}, unpacking takes ${ms(inside.decoded)}, views stand at ${ms(inside.ready)}`);
  const floor = [];
  for (let k = 0; k < TIMES; k++) floor.push(await timed(view, ''));
  t.diagnostic(`two empty frames ${ms(floor)}`);
  for (const where of ['path', 'charts']) {
    await view.value(`document.getElementById('${where}').scrollIntoView()`);
    for (const width of [599, 300, 60, 10, 1]) {
      const zooms = [];
      for (let k = 0; k < TIMES; k++) zooms.push(await timed(view, `kadr.state.setWindow(${0.1 * k}, ${0.1 * k + width})`));
      t.diagnostic(`zoom to ${width} s with ${where} in sight, two frames later ${ms(zooms)}`);
    }
    const moves = [];
    for (let k = 0; k < 2 * TIMES; k++) moves.push(await timed(view, `kadr.state.setCursor(${0.1 * k})`));
    t.diagnostic(`cursor with ${where} in sight, two frames later ${ms(moves)}`);
  }
  // what is out of sight is drawn once nothing has moved for a while
  await view.value('scrollTo(0, 0), kadr.state.whole()');
  await new Promise((done) => setTimeout(done, 3000));
  await shot(view, 'long.png', true);
});

test('positions of every control tick are the log\'s, over 10 minutes', async () => {
  const view = await opened('long.html');
  const steps = csv('long.lcmlog', 'axis.X.steps,axis.Y.steps').map((row) => row.slice(1));
  await unpacked(view);
  const got = await view.value('kadr.run.positions.value.pieces.slice(0, 2).map((n) => [...n])');
  assert.equal(got[0].length, steps.length);
  for (const axis of [0, 1]) assert.ok(steps.every((row, i) => row[axis] === got[axis][i]), `axis ${axis}`);
});

test('a spike of one control tick in 600 000 is seen in the chart at every zoom', async () => {
  const view = await opened('long.html');
  await unpacked(view);
  await view.value('document.getElementById("charts").scrollIntoView()');
  // one sample of the path error, a hundred times as large as the rest
  const [spike_s, peak] = await view.value(`(() => {
    const run = kadr.run, t = run.tracks.get('path.error_um'), i = 123457, peak = 100 * Math.max(1, t.pyramid.ask(0, run.pieces) ?? t.pyramid.high);
    t.low[i] = peak;
    t.pyramid_ = undefined;
    return [run.first_s + (i + 1) * run.piece_s, peak];
  })()`);
  for (const width of [600, 300, 60, 10, 1, 0.1]) {
    await view.value(`kadr.state.setWindow(${spike_s} - ${width} / 3, ${spike_s} + ${2 * width / 3}), kadr.state.tell(), kadr.charts.draw()`);
    await view.frames();
    await view.frames();
    // its column of pixels is coloured above the middle of the chart, the columns far from it are not
    const seen = await view.value(`(() => {
      const k = kadr.charts.groups.findIndex((g) => g.title === 'Path error'), plot = kadr.charts.plots[k], { ctx, bbox } = plot;
      const x = Math.round(plot.valToPos(${spike_s}, 'x', true)), top = Math.round(plot.valToPos(${peak}, 'y', true)), high = Math.floor(bbox.height / 3);
      const colour = [0, 0x72, 0xb2];  // --c0 of the light theme
      const inked = (from, width) => {
        const { data } = ctx.getImageData(from, top + 2, width, high);
        let n = 0;
        for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 60 && colour.every((c, j) => Math.abs(c - data[i + j]) < 60)) n++;
        return n;
      };
      return { at: inked(x - 3, 7), high, beside: inked(bbox.left + bbox.width * 0.6, bbox.width * 0.3), max: plot.scales.y.max };
    })()`);
    assert.ok(seen.max >= peak, `${width} s: the scale holds it`);
    assert.ok(seen.at >= 0.8 * seen.high, `${width} s: ${seen.at} of ${seen.high} pixels`);
    assert.equal(seen.beside, 0, `${width} s: nothing beside it`);
  }
});

test('beyond its size a page shows extremes of several control ticks, and each one round what matters', async (t) => {
  const view = await opened('overview.html');
  await unpacked(view);
  const { every, windows, pieces } = await view.value('kadr.run.meta');
  t.diagnostic(`overview of ${(size('overview.html') / 1e6).toFixed(2)} MB: extremes of each ${every} control ticks, ${windows.length} stretches at full rate`);
  assert.ok(size('overview.html') <= 1e6);
  assert.ok(every > 1 && windows.length > 3);
  assert.match(await view.value('document.getElementById("note").textContent'), /overview: lowest and highest of each \d+, every tick at \d+ places/);
  const names = ['path.error_um', 'axis.X.jerk_mm_s3', 'feed.commanded_mm_s'], rows = csv('long.lcmlog', `${names.join(',')},axis.X.steps,axis.Y.steps`);
  const got = await view.value(`(${JSON.stringify(names)}).map((n) => { const t = kadr.run.tracks.get(n); return { step: t.step, low: [...t.low], high: [...t.high], fine: [...t.fine] }; })`);
  names.forEach((name, k) => {
    const { step, low, high, fine } = got[k];
    const largest = rows.reduce((most, row) => Math.max(most, Math.abs(row[k + 1])), 0);
    let near = 0;
    rows.forEach((row, i) => {
      const piece = Math.floor(i / every);
      assert.ok(low[piece] - step <= row[k + 1] && row[k + 1] <= high[piece] + step, `${name}: control tick ${i} is within its piece`);
      if (Math.abs(row[k + 1]) >= largest - 1e-6 * largest && windows.some((w) => w.first <= i && i < w.first + w.ticks)) near++;
    });
    for (const w of windows)
      for (let i = 0; i < w.ticks; i++) assert.ok(Math.abs(fine[w.at + i] - rows[w.first + i][k + 1]) <= 0.51 * step, `${name}: stretch at ${w.first}, ${i}`);
    assert.ok(near > 0, `${name}: its largest value, ${largest}, is at full rate`);
  });
  assert.equal(pieces, Math.ceil(rows.length / every));
  // the chart of a stretch draws the samples themselves
  const w = windows[0];
  await view.value(`document.getElementById('charts').scrollIntoView(), kadr.state.setWindow(kadr.run.first_s + ${w.first + 100} * 0.001, kadr.run.first_s + ${w.first + 400} * 0.001)`);
  await view.frames();
  await view.frames();
  const drawn = await view.value(`(() => { const c = kadr.charts.groups.find((g) => g.title === 'Path error').curves[0]; const { x, y } = c.points(kadr.state.from_s, kadr.state.to_s, 1e6); return { x: [...x], y: [...y] }; })()`);
  assert.ok(drawn.x.length >= 300 && drawn.x.length <= 304);
  drawn.x.forEach((x, k) => {
    const i = Math.round(x / 0.001) - 1;
    assert.ok(Math.abs(drawn.y[k] - rows[i][1]) <= 0.51 * got[0].step);
  });
  await shot(view, 'overview.png', true);
  // the path's picture: corners are exact, and all positions are within 5 um of the lines between them
  const corners = await view.value('({ ticks: [...kadr.run.corners.ticks], nodes: kadr.run.corners.nodes.map((n) => [...n]), step: kadr.run.meta.axes.map((a) => a.step_u) })');
  let farthest = 0;
  for (let c = 1; c < corners.ticks.length; c++) {
    const point = (i) => [4, 5].map((k, a) => rows[i][k] * corners.step[a]);
    const [from, to] = [point(corners.ticks[c - 1]), point(corners.ticks[c])];
    assert.equal(corners.nodes[0][c], rows[corners.ticks[c]][4]);
    const line = Math.hypot(to[0] - from[0], to[1] - from[1]);
    for (let i = corners.ticks[c - 1]; i <= corners.ticks[c]; i++) {
      const p = point(i), dx = p[0] - from[0], dy = p[1] - from[1];
      const off = line > 0 ? Math.abs((dx * (to[1] - from[1]) - dy * (to[0] - from[0])) / line) : Math.hypot(dx, dy);
      farthest = Math.max(farthest, off);
    }
  }
  t.diagnostic(`path in ${corners.ticks.length} corners, farthest position ${(1000 * farthest).toFixed(2)} um beside its line`);
  assert.ok(corners.ticks.length < rows.length / 5);
  assert.ok(farthest <= 0.010);
});
