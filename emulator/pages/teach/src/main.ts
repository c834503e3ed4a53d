// The teaching page: tabs round one state, and the state in the address.
import { drawCases } from './cases_tab';
import { drawCompare } from './compare_tab';
import { axes, follow, knownMethods, legs, loadCore, MOST_SLOTS, readCase, sweep, type Fault, type Followed } from './core';
import { drawFeed } from './feed_tab';
import { drawJoint } from './joint_tab';
import { drawRose } from './rose_tab';
import { address, joinWords, readAddress, splitWords, state, TABS, type Tab } from './state';
import { drawStep, wireStep } from './step_tab';
import { either, fixed, isRussian, made, say, setRussian } from './words';

const at = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;
const PLAY_MS = 450;
const SWEEP_CASES = 20_000;

const EXAMPLES = ['line 7 4', 'line 3 10', 'line -5 8', 'arc 7 0 0 7 ccw', 'arc 0 7 7 0 cw', 'circle 9', 'ellipse 12 5', 'parabola 3 -8 8', 'bezier 12 0 12 9', 'bezier 0 10 12 10 12 0', "curve '400 y - x^3' -20 -20 20 20 cw", 'line 100 37', 'arc 50 0 0 50 ccw'];

let followed: Followed | null = null;
let timer = 0;

function complaint(fault: Fault): string {
  const word = `\u2018${fault.word}\u2019`;
  switch (fault.fault) {
    case 'kind': return either(`a case begins with line, arc, circle, ellipse, parabola, bezier or curve; got ${word}`, `задача начинается с line, arc, circle, ellipse, parabola, bezier или curve; здесь ${word}`);
    case 'number': return either(`${word} is not a whole number of steps`, `${word} — не целое число шагов`);
    case 'turn': return either('this kind takes no ccw or cw', 'у этого вида нет ccw и cw');
    case 'count': return either(`${state.words[0]} takes another count of numbers; got ${fault.place}`, `у ${state.words[0]} другое количество чисел; здесь ${fault.place}`);
    case 'polynomial': return either(`${word} can\u2019t be read from character ${fault.place} on`, `${word} не читается начиная с символа ${fault.place}`);
    case 'degree': return either(`${word} is of degree ${fault.place}, allowed 6`, `${word} степени ${fault.place}, допустимо 6`);
    case 'half_axes': return either('half axes of an ellipse are 1 to 10000 steps', 'полуоси эллипса от 1 до 10000 шагов');
    case 'flat_parabola': return either('P of a parabola is not 0', 'P параболы не равно 0');
    default: return either(`${word} is too far`, `${word} слишком далеко`);
  }
}
function refusal(name: string): string {
  switch (name) {
    case 'no_length': return either('both ends are one node', 'оба конца — один узел');
    case 'other_curve': return either(`${state.method} doesn\u2019t follow this curve`, `${state.method} не следует этой кривой`);
    case 'off_curve': return either('the end is more than 0.707 steps off the circle through the start', 'конец дальше 0.707 шага от окружности через начало');
    case 'one_quadrant': return either(`${state.method} stays within the quadrant of its beginning`, `${state.method} остаётся в квадранте своего начала`);
    case 'in_line': return either('the control points are collinear, so this is not a conic', 'точки лежат на прямой, это не коника');
    case 'too_long': return either(`no end after ${MOST_SLOTS} slots, which is all a page can show`, `нет конца после ${MOST_SLOTS} тактов, больше страница не покажет`);
    default: return either('a coordinate is too large', 'слишком большая координата');
  }
}

/** Reads the case anew; its complaint stands below the words. */
function take(): boolean {
  followed = null;
  const fault = readCase(state.words);
  let wrong = fault ? complaint(fault) : '';
  if (!fault && (axes() !== 2 || legs() !== 1)) wrong = either('the page shows one curve in two axes; `kadr teach table` takes more', 'страница показывает одну кривую в двух осях; `kadr teach table` умеет больше');
  if (!wrong && state.tab === 'step') {
    const known = knownMethods();
    if (!known.includes(state.method)) state.method = known.includes('half_step') ? 'half_step' : known[0];
    const got = follow(state.method);
    if (typeof got === 'string') wrong = refusal(got); else followed = got;
    if (followed) state.row = Math.min(state.row, followed.slots);
  }
  at('wrong').textContent = wrong;
  at('panel-step').classList.toggle('empty', !followed && state.tab === 'step');
  return !wrong;
}

function controls(): void {
  (at('words') as HTMLInputElement).value = joinWords(state.words);
  const select = at<HTMLSelectElement>('method');
  select.replaceChildren(...knownMethods().map((m) => { const o = made('option', m.startsWith('printed') ? `${m} (${say('as printed, to be seen failing')})` : m); o.value = m; o.selected = m === state.method; return o; }));
  const examples = at<HTMLSelectElement>('examples'), now = joinWords(state.words);
  examples.replaceChildren(...[...(EXAMPLES.includes(now) ? [] : [now]), ...EXAMPLES].map((e) => { const o = made('option', e); o.selected = e === now; return o; }));
  at('case-bar').hidden = state.tab !== 'step' && state.tab !== 'compare';
  at('method-label').hidden = state.tab !== 'step';
}

/** Draws the tab; `again` reads the case anew. */
function draw(again = true): void {
  const good = !again || take();
  for (const tab of TABS) {
    const on = tab === state.tab, button = at(`tab-${tab}`);
    button.setAttribute('aria-selected', String(on));
    button.tabIndex = on ? 0 : -1;
    at(`panel-${tab}`).hidden = !on;
  }
  const panel: Record<Tab, () => void> = {
    step: () => { if (followed) drawStep(followed, go); },
    compare: () => { if (good) drawCompare(change); },
    cases: () => drawCases(change), rose: () => drawRose(change), joint: () => drawJoint(change), feed: () => drawFeed(change),
  };
  if (again && (state.tab === 'step' || state.tab === 'compare')) controls();
  at('case-bar').hidden = state.tab !== 'step' && state.tab !== 'compare';
  panel[state.tab]();
  at('language').textContent = isRussian() ? 'English' : 'Русский';
  at('play').textContent = timer ? say('Stop') : say('Play');
  history.replaceState(null, '', address());
}
const change = (): void => { stop(); draw(); };

function go(row: number): void {
  const most = state.tab === 'step' ? followed?.slots ?? 0 : Number((at('compare-slider') as HTMLInputElement).max);
  state.row = Math.max(0, Math.min(most, row));
  draw(state.tab === 'compare');
}
function stop(): void {
  clearInterval(timer);
  timer = 0;
}
function play(): void {
  if (timer) { stop(); draw(false); return; }
  if (followed && state.row >= followed.slots) state.row = 0;
  timer = window.setInterval(() => {
    go(state.row + 1);
    if (!followed || state.row >= followed.slots) { stop(); draw(false); }
  }, PLAY_MS);
  draw(false);
}

function themed(): boolean {
  return state.theme === 'dark' || (state.theme === '' && matchMedia('(prefers-color-scheme: dark)').matches);
}

function wire(): void {
  for (const tab of TABS) {
    at(`tab-${tab}`).onclick = () => { state.tab = tab; change(); };
    at(`tab-${tab}`).onkeydown = (event) => {
      const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!by) return;
      event.stopPropagation();
      event.preventDefault();
      state.tab = TABS[(TABS.indexOf(tab) + by + TABS.length) % TABS.length];
      change();
      at(`tab-${state.tab}`).focus();
    };
  }
  at('case-form').onsubmit = (event) => { event.preventDefault(); state.words = splitWords(at<HTMLInputElement>('words').value); state.row = 0; change(); };
  at('examples').onchange = () => { state.words = splitWords(at<HTMLSelectElement>('examples').value); state.row = 0; change(); };
  at('method').onchange = () => { state.method = at<HTMLSelectElement>('method').value; change(); };
  at('begin').onclick = () => { stop(); go(0); };
  at('back').onclick = () => { stop(); go(state.row - 1); };
  at('forward').onclick = () => { stop(); go(state.row + 1); };
  at('to-end').onclick = () => { stop(); go(Infinity); };
  at('play').onclick = play;
  at('slider').oninput = () => { stop(); go(Number(at<HTMLInputElement>('slider').value)); };
  at('compare-slider').oninput = () => go(Number(at<HTMLInputElement>('compare-slider').value));
  at('compare-back').onclick = () => go(state.row - 1);
  at('compare-forward').onclick = () => go(state.row + 1);
  at('rose-angle').oninput = () => { state.angle = Number(at<HTMLInputElement>('rose-angle').value); draw(); };
  wireStep(() => draw(false));
  document.onkeydown = (event) => {
    const target = event.target as HTMLElement;
    if ((state.tab !== 'step' && state.tab !== 'compare') || event.ctrlKey || event.altKey || event.metaKey) return;
    // what a control does with the key itself
    if (target.matches('select, input:not([type=checkbox]):not([type=range])') || (event.key === ' ' && target.matches('button, input, summary'))) return;
    const step = { ArrowLeft: -1, ArrowRight: 1, Home: -Infinity, End: Infinity }[event.key];
    if (step !== undefined) { event.preventDefault(); stop(); go(state.row + step); }
    if (event.key === ' ' && state.tab === 'step') { event.preventDefault(); play(); }
  };
  at('theme').onclick = () => { state.theme = themed() ? 'light' : 'dark'; document.documentElement.classList.toggle('dark', themed()); draw(false); };
  at('language').onclick = () => { state.russian = !isRussian(); setRussian(state.russian); draw(); };
  at('print').onclick = () => print();
  at('try').onclick = () => { at('tried').textContent = `${fixed(SWEEP_CASES, 0)} ${either('cases, hash', 'задач, хеш')} ${sweep(SWEEP_CASES)}; kadr teach sweep`; draw(); };
  addEventListener('hashchange', () => { readAddress(location.hash); setRussian(state.russian); document.documentElement.classList.toggle('dark', themed()); change(); });
  let width = innerWidth;
  addEventListener('resize', () => { if (innerWidth !== width) { width = innerWidth; draw(false); } });
  // paper is light
  addEventListener('beforeprint', () => { document.documentElement.classList.remove('dark'); });
  addEventListener('afterprint', () => { document.documentElement.classList.toggle('dark', themed()); });
}

async function start(): Promise<void> {
  await loadCore();
  readAddress(location.hash || (JSON.parse(at('start').textContent || '""') as string));
  document.documentElement.classList.toggle('dark', themed());
  if (state.russian) setRussian(true);
  wire();
  document.body.classList.add('ready');
  draw();
}

start().catch((error: unknown) => {
  document.body.classList.add('ready');
  at('wrong').textContent = `This browser can't run the page: ${String(error)}`;
});
