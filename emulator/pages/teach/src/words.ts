// Words of the teaching page in Russian; numbers and the language itself are the report page's (text.ts).
import { isRussian, learn } from '../../report/src/text';
export { fixed, isRussian, made, say, setRussian } from '../../report/src/text';

learn({
  'Interpolators, step by step': 'Интерполяторы, шаг за шагом', 'Step by step': 'По шагам', 'Compare': 'Сравнение', 'Eight cases': 'Восемь случаев', 'Speed rose': 'Роза скоростей',
  'Joints': 'Стыки кривых', 'Time and feed': 'Время и подача', 'Curve': 'Кривая', 'Method': 'Метод', 'Case': 'Задача', 'Example': 'Пример', 'Draw': 'Показать',
  'Play': 'Пуск', 'Stop': 'Стоп', 'Begin': 'Начало', 'Back': 'Назад', 'Forward': 'Вперёд', 'End': 'Конец', 'largest': 'наибольшее',
  'Dual squares': 'Двойственные квадраты', 'Signs of F': 'Знаки F', 'Near the cursor': 'Вблизи', 'move': 'ход', 'deviation': 'отклонение', 'steps': 'шаги', 'end': 'конец',
  'slots': 'такты', 'slot': 'такт', 'at': 'при', 'pulses': 'импульсы', 'slots with both axes': 'такты с двумя осями', 'idle slots': 'пустые такты', 'forced by the end (!)': 'решил конец (!)', 'idle': 'пустые', 'forced': 'по концу',
  'largest deviation': 'наибольшее отклонение', 'root mean square': 'среднее квадратическое', 'in the larger axis': 'по большей оси', 'length of the path': 'длина пути', 'steps hash': 'хеш шагов',
  'end reached': 'конец достигнут', 'end missed': 'конец пропущен', 'reached': 'достигнут', 'missed': 'пропущен', 'method': 'метод', 'rms': 'скз', 'larger axis': 'большая ось',
  'Step table': 'Таблица шагов', 'Step pulses over time': 'Импульсы шага во времени', 'One slot a pulse: time in slots': 'Такт на импульс: время в тактах',
  'At the crossings: place on the ideal path at a constant feed, steps': 'В моменты пересечений: место на идеальной кривой при постоянной подаче, шаги',
  'Time between pulses at 1000 steps/s': 'Время между импульсами при 1000 шаг/с', 'one slot a pulse': 'такт на импульс', 'at the crossings': 'в моменты пересечений',
  'Moves (small letters: backwards)': 'Ходы (строчные буквы: назад)', 'Methods, up to four': 'Методы, не больше четырёх', 'as printed, to be seen failing': 'как напечатано, чтобы увидеть ошибку',
  'F < 0': 'F < 0', 'F > 0': 'F > 0', 'F = 0': 'F = 0', 'where F is tested': 'где проверяется F', 'ideal curve': 'идеальная кривая', 'path done': 'пройденный путь', 'path to come': 'путь впереди',
  'angle': 'угол', 'direction': 'направление', 'pulses at the crossings': 'импульсы в моменты пересечений', 'speed, steps a slot': 'скорость, шагов за такт', 'max / min': 'макс / мин',
  'View': 'Вид', 'Along the joint': 'Вдоль касательной', 'Paper 004': 'Статья 004', 'G2 repair': 'Исправление G2', 'C2 repair': 'Исправление C2', 'Comb': 'Гребень', 'Control points of curve 2, mm': 'Точки кривой 2, мм',
  'gap': 'разрыв', 'angle between tangents': 'угол между касательными', 'ratio of |dB/dt|': 'отношение |dB/dt|', 'curvature before and after': 'кривизна до и после', 'angle between normals': 'угол между нормалями',
  'jump of the curvature vector': 'скачок вектора кривизны', 'of the largest curvature': 'от наибольшей кривизны', 'jump of the second derivative': 'скачок второй производной', 'joint': 'стык', 'smallest radius': 'наименьший радиус',
  'length': 'длина', 'curve': 'кривая', 'Polynomial': 'Многочлен', 'Degree': 'Степень', 'Parts': 'Части', 'degree': 'степень', 'parts': 'части', 'Error of t': 'Ошибка t', 'Error of the feed': 'Ошибка подачи',
  'error of t, %': 'ошибка t, %', 'error of the feed, %': 'ошибка подачи, %', 'error of place, mm': 'ошибка места, мм', 'share of the length': 'доля длины', 'Curve 1': 'Кривая 1', 'Curve 2': 'Кривая 2',
  'Newton through equal parts': 'Ньютон по равным частям', 'minimax of Newton 8': 'минимакс от Ньютона 8', 'minimax of the exact t(S)': 'минимакс точной t(S)', 'table of quintic pieces': 'таблица кусков степени 5',
  'Exercises': 'Упражнения', 'Try the core': 'Проверить ядро', 'Numbers by the C++ core of kadr, compiled to WebAssembly.': 'Числа считает ядро kadr на C++, собранное в WebAssembly.', 'h = one motor step': 'h = один шаг двигателя',
  'Keys: arrows one step, Home and End, space plays.': 'Клавиши: стрелки — шаг, Home и End, пробел — пуск.', 'Skip to the picture': 'К рисунку', 'Same in the terminal': 'То же в терминале', 'Dark / light': 'Тёмная / светлая',
});

/** One of two sentences: English, Russian. */
export const either = (english: string, russian: string): string => (isRussian() ? russian : english);
