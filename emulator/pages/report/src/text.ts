// Words of the page in two languages, and how numbers are written: a point, a thin space between thousands, a minus
// sign, whatever the browser's locale.

const RU: Record<string, string> = {
  'Whole run': 'Весь прогон', 'Over the path': 'По пути', 'Runs at the cursor': 'Прогоны у курсора', 'run': 'прогон', 'Dark / light': 'Тёмная / светлая', 'Print': 'Печать', 'Tool path': 'Траектория инструмента', 'Colour': 'Цвет',
  'Iso': 'Изометрия', 'Top': 'Сверху', 'Front': 'Спереди', 'Program': 'Программа', 'Values in this window': 'Значения в этом окне',
  'Events': 'События', 'Blocks': 'Кадры', 'Settings in force': 'Действующие настройки', 'Licences of included libraries': 'Лицензии библиотек',
  'Warning': 'Предупреждение', 'Run': 'Прогон', 'outcome': 'исход', 'time': 'время', 'in motion': 'в движении', 'standing': 'стоянка', 'path': 'путь',
  'feed, mean': 'подача средняя', 'feed, peak': 'подача наибольшая', 'path error, peak': 'ошибка контура, наибольшая', 'not simulated': 'не моделируется',
  'blocks': 'кадры', 'pulses': 'импульсы', 'steps hash': 'хеш шагов', 'What held the feed': 'Что ограничило подачу', 'reason': 'причина', 'share': 'доля',
  'Time lost against the plan at 100 %': 'Потеря времени против плана при 100 %', 'of the plan': 'от плана', 'Axes against their limits': 'Оси и их пределы',
  'axis': 'ось', 'range': 'ход', 'peak feed': 'наибольшая подача', 'acceleration': 'ускорение', 'jerk': 'рывок', 'Load (simulated)': 'Исполнительный орган (модель)',
  'vibration, peak': 'колебания, наибольшие', 'rms': 'скз', 'at': 'когда', 'line': 'строка', 'residual': 'остаточные', 'following error, peak': 'ошибка слежения, наибольшая',
  'lost steps': 'потеря шагов', 'work, driving': 'работа привода', 'braking': 'торможения', 'rigid (not modelled)': 'жёсткая (не моделируется)',
  'Alarms and messages': 'Аварии и сообщения', 'No alarms, no messages.': 'Аварий и сообщений нет.', 'severity': 'вид', 'code': 'код', 'what': 'что', 'error': 'ошибка',
  'alarm': 'авария', 'warning': 'предупреждение', 'note': 'замечание', 'program': 'программа', 'rapid': 'ускоренный ход', 'approach': 'подвод', 'length': 'длина', 'stop': 'стоянка',
  'Feed': 'Подача', 'Feed override': 'Коррекция подачи', 'Acceleration along the path': 'Ускорение вдоль пути', 'Jerk along the path': 'Рывок вдоль пути',
  'Path error': 'Ошибка контура', 'Axis speed': 'Скорость осей', 'Axis acceleration': 'Ускорение осей', 'Axis jerk': 'Рывок осей', 'Following error': 'Ошибка слежения',
  'Vibration': 'Колебания', 'Step rate': 'Частота шагов', 'feed': 'подача', 'path error': 'ошибка контура', 'vibration': 'колебания', 'text': 'текст', 'kind': 'вид',
  'planned time': 'время по плану', 'F': 'F', 'limited by': 'ограничено', 'signal': 'сигнал', 'lowest': 'наименьшее', 'highest': 'наибольшее', 'at the cursor': 'у курсора',
  'complete': 'завершён', 'interrupted': 'прерван', 'dwell': 'выдержка', 'path feed': 'подача пути', 'axis speed': 'скорость оси', 'centripetal': 'центростремительное',
  'junction': 'стык', 'commanded': 'заданная', 'programmed': 'по программе', 'used': 'действует', 'requested': 'запрошено', 'hold': 'останов подачи', 'limiter': 'ограничитель', 'override': 'коррекция',
};

let russian = false;
export const isRussian = (): boolean => russian;
export function setRussian(on: boolean): void {
  russian = on;
  document.documentElement.lang = on ? 'ru' : 'en';
  // words written by kadr and by page.html; the English one is kept beside
  for (const at of document.querySelectorAll<HTMLElement>('.w')) {
    at.dataset.en ??= at.textContent ?? '';
    at.textContent = say(at.dataset.en);
  }
}
/** Also of "junction X": words and an axis. */
export function say(english: string): string {
  const axis = russian && !(english in RU) ? / [A-Z]$/.exec(english)?.[0] ?? '' : '';
  const word = axis ? english.slice(0, -axis.length) : english;
  return russian && word in RU ? RU[word] + axis : english;
}

/** An element with text, never markup. */
export function made<K extends keyof HTMLElementTagNameMap>(tag: K, text = '', className = ''): HTMLElementTagNameMap[K] {
  const out = document.createElement(tag);
  if (text) out.textContent = text;
  if (className) out.className = className;
  return out;
}

/** More words, of another page. */
export const learn = (words: Record<string, string>): void => { Object.assign(RU, words); };

export function fixed(value: number, decimals: number): string {
  if (!Number.isFinite(value)) return '-';
  const [whole, part] = Math.abs(value).toFixed(decimals).split('.');
  const text = whole.replace(/\B(?=(\d{3})+$)/g, '\u202f') + (part ? `.${part}` : '');
  return (value < 0 && /[1-9]/.test(text) ? '\u2212' : '') + text;
}

/** As many decimals as a step of the data allows, at most 4. */
export function byStep(value: number, step: number): string {
  return fixed(value, step > 0 ? Math.max(0, Math.min(4, Math.ceil(-Math.log10(step)))) : 3);
}
