// The picture of README: node tests/web/readme_picture.mjs PAGE.html OUT.png; tools/readme-picture calls it. Path, program and the
// first chart of the page, zoomed to the four outer rings of the rosette.
import { resolve } from 'node:path';
import { Browser } from './chromium.mjs';

const SHIFT = 8;
const [html, out] = process.argv.slice(2);
const browser = await Browser.open();
try {
  const view = await browser.page(`file://${resolve(html)}`, { width: 1080, height: 656, scale: 1.5 });
  await view.until('document.body.classList.contains("ready")');
  await view.value('document.getElementById("path").scrollIntoView(), kadr.state.setWindow(9.5, 38.8)');
  // the path larger and in the middle
  await view.value('document.getElementById("view").focus()');
  for (let k = 0; k < 3; k++) await view.key('+');
  const [x, y] = await view.value('(({ left, top }) => [left + 400, top + 220])(document.getElementById("view").getBoundingClientRect())');
  await view.mouse('mousePressed', x, y, { button: 'left', clickCount: 1, modifiers: SHIFT });
  await view.mouse('mouseMoved', x - 155, y + 20, { button: 'left', buttons: 1, modifiers: SHIFT });
  await view.mouse('mouseReleased', x - 155, y + 20, { button: 'left', clickCount: 1, modifiers: SHIFT });
  await view.value('Promise.all([kadr.run.positions.load(), kadr.charts.loaded()]).then(() => { document.activeElement.blur(); kadr.state.setCursor(24.9); })');
  await view.frames();
  await view.until('kadr.charts.drawn');
  await view.frames();
  await view.shot(out);
} finally {
  await browser.close();
}
