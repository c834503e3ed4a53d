// The script of every page that kadr writes: of one run, or of several.
import { compare } from './compare';
import { at, dress } from './frame';
import { report } from './report';

dress();
(at('runs') ? compare() : report()).then((views) => {
  document.body.classList.add('ready');
  // what tests look at: numbers and views, nothing that the page itself needs
  Object.assign(window, { kadr: views });
}).catch((error: unknown) => {
  document.body.classList.add('ready');
  at('note').textContent = `This browser can't show the charts: ${String(error)}`;
});
