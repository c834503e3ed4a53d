// Bundles a page into one HTML template: node build.mjs OUT.html [OUT.cpp [PAGE [CORE.wasm]]], PAGE report (default) or teach.
// The template has marks (title, heading, summary, charts, data; start) that kadr fills; script and style are fixed, and
// the security policy names their hashes. The licence of every package in the bundle is part of the page.
import { build, transform } from 'esbuild';
import { createHash } from 'node:crypto';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const [htmlPath, cppPath, pageName = 'report', corePath] = process.argv.slice(2);
const nodeModules = process.env.KADR_NODE_MODULES ?? join(here, 'node_modules');
const base = join(here, 'src/base.css');
const teach = join(here, '../teach/src');
// sources, style sheets in order, and the C++ accessor of the template
const { root, styles, header, room, accessor } = {
  report: { root: join(here, 'src'), styles: [join(nodeModules, 'uplot/dist/uPlot.min.css'), base, join(here, 'src/style.css')], header: 'emulator/log_tools/report/report_page.h', room: 'log_tools', accessor: 'report_template' },
  teach: { root: teach, styles: [base, join(teach, 'teach.css')], header: 'emulator/studies/teach/teach_page.h', room: 'studies', accessor: 'teach_template' },
}[pageName];

// Parts of packages that no page uses and a bundler can't tell: twgl makes ready-made shapes at start, by functions
// that do nothing else; uPlot hangs further kinds of lines on itself. Without them 18 kB less.
const unused = {
  name: 'unused-parts',
  setup(own) {
    const edit = (filter, from, to) => own.onLoad({ filter }, ({ path }) => {
      const text = readFileSync(path, 'utf8'), edited = text.replace(from, to);
      if (edited === text) throw new Error(`${path} is not what it was: nothing to leave out`);
      return { contents: edited };
    });
    edit(/twgl-full\.module\.js$/, /= (?=(createBuffer(Info)?Func|wrapCallbackFnToAsyncFn)\()/g, '= /* @__PURE__ */ ');
    edit(/uPlot\.esm\.js$/, /^\t*\(?(uPlot|paths)\.(join|stepped|bars|spline|addGap|clipGaps|rangeLog|rangeAsinh|orient|sync|fmtDate|tzDate)\s*=.*;$/gm, '');
  },
};

const js = await build({
  entryPoints: [join(root, 'main.ts')],
  alias: corePath ? { 'core.wasm': resolve(corePath) } : {},
  loader: { '.wasm': 'binary' },
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2022',
  write: false,
  metafile: true,
  legalComments: 'none',
  charset: 'utf8',
  plugins: [unused],
  nodePaths: [nodeModules],
  logLevel: 'warning',
});
const code = js.outputFiles[0].text.trim().replaceAll('</script', '<\\/script');
const sheets = styles.map((path) => readFileSync(path, 'utf8'));
const css = (await transform(sheets.join('\n'), { loader: 'css', minify: true, charset: 'utf8' })).code.trim();

const sha256 = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;
const policy = `default-src 'none'; script-src ${sha256(code)}${corePath ? " 'wasm-unsafe-eval'" : ''}; style-src ${sha256(css)}; img-src data: blob:; base-uri 'none'; form-action 'none'`;

// packages that reached the bundle, by the paths of its inputs
const inputs = Object.keys(Object.values(js.metafile.outputs)[0].inputs);
const packages = [...new Set(inputs.map((path) => path.match(/node_modules\/((?:@[^/]+\/)?[^/]+)\//)?.[1]).filter(Boolean))].sort();
const escaped = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;');
const licences = packages.map((name) => {
  const file = ['LICENSE', 'LICENSE.md', 'LICENSE.txt', 'license'].map((f) => join(nodeModules, name, f)).find(existsSync);
  if (!file) throw new Error(`${name} has no licence text`);
  const { version } = JSON.parse(readFileSync(join(nodeModules, name, 'package.json'), 'utf8'));
  return `${name} ${version}\n\n${readFileSync(file, 'utf8').trim()}\n`;
});

if (corePath) {
  // of the C library in the core; the runtime of C++ carries LLVM's exception for what is compiled with it
  const copyright = '/usr/share/doc/wasi-libc/copyright';
  if (!existsSync(copyright)) throw new Error('wasi-libc has no licence text');
  licences.push(`wasi-libc\n\n${readFileSync(copyright, 'utf8').trim()}\n`);
}
const part = (name) => (existsSync(join(root, name)) ? readFileSync(join(root, name), 'utf8').trim() : '');
const page = readFileSync(join(root, 'page.html'), 'utf8')
  .replace('<!--POLICY-->', () => policy)
  .replace('/*STYLE*/', () => css)
  .replace('<!--EXERCISES-->', () => part('exercises.html'))
  .replace('<!--LICENCES-->', () => escaped(licences.join('\n')))
  .replace('/*SCRIPT*/', () => code);
writeFileSync(htmlPath, page);

if (cppPath) {
  // string literals of at most 64 KiB as compilers promise; adjacent ones are one text
  const octets = Buffer.from(page, 'utf8');
  const lines = [];
  for (let at = 0; at < octets.length; at += 48) {
    let line = '';
    for (const byte of octets.subarray(at, at + 48)) {
      const plain = byte >= 32 && byte < 127 && byte !== 34 && byte !== 92 && byte !== 63;
      line += plain ? String.fromCharCode(byte) : `\\${byte.toString(8).padStart(3, '0')}`;
    }
    lines.push(`    "${line}"`);
  }
  writeFileSync(
    cppPath,
    `// Generated by emulator/pages/report/build.mjs.\n#include "${header}"\n\nnamespace kadr::${room} {\n\n` +
      `std::string_view ${accessor}() {\n  static constexpr char kPage[] =\n${lines.join('\n')};\n  return {kPage, sizeof kPage - 1};\n}\n\n}  // namespace kadr::${room}\n`,
  );
}
const bytes = (text) => Buffer.byteLength(text);
console.log(`page ${bytes(page)} B: script ${bytes(code)} B, style ${bytes(css)} B; ${packages.join(', ')}`);
