// Checks the dashboard against Grafana's published types (npm's @grafana/schema): the whole dashboard, and the
// parts that depend on the kind of panel (options and field drawing), which the dashboard's type leaves open.
// Unknown names are errors too. Exits with 1 if there is an error.
//   npm install --ignore-scripts @grafana/schema typescript@5
//   node deploy/grafana/validate.mjs NODE_MODULES [DASHBOARD]
import {mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';

const modules = path.resolve(process.argv[2]);
const file = process.argv[3] ?? fileURLToPath(new URL('duet.json', import.meta.url));
const dashboard = JSON.parse(readFileSync(file, 'utf8'));
const types = path.join(modules, '@grafana/schema/dist/types');
const {default: ts} = await import(pathToFileURL(path.join(modules, 'typescript/lib/typescript.js')));

// The type declarations of a kind of panel.
function kindOf({type}) {
  const folder = path.join(types, `raw/composable/${type}/panelcfg/x`);
  return path.join(folder, readdirSync(folder).find((name) => name.endsWith('.d.ts')).replace('.d.ts', ''));
}

const imported = (file, name) => `import(${JSON.stringify(file)}).${name}`;

// A type in its JSON form: an enumeration of strings is one of these strings.
const json = 'type Json<T> = T extends string ? `${T}` : T extends object ? {[K in keyof T]: Json<T[K]>} : T;';

// A literal for each part: TypeScript rejects unknown names only in literals.
const parts = [['dashboard', imported(path.join(types, 'index'), 'Dashboard'), dashboard]];
for (const panel of dashboard.panels) {
  const kind = kindOf(panel);
  parts.push([`options of ${panel.title}`, `Json<${imported(kind, 'Options')}>`, panel.options]);
  const {custom} = panel.fieldConfig.defaults;
  if (custom) parts.push([`field of ${panel.title}`, `Json<${imported(kind, 'FieldConfig')}>`, custom]);
}

const folder = mkdtempSync(path.join(tmpdir(), 'dashboard-'));
try {
  const source = path.join(folder, 'dashboard.ts');
  // One line for each part, so that the line number identifies the part.
  writeFileSync(source, parts.map(([, type, value], index) =>
    `export const part${index}: ${type} = ${JSON.stringify(value)};\n`).join('') + json);
  const program = ts.createProgram([source], {
    strict: true, noEmit: true, skipLibCheck: true, types: [],
    module: ts.ModuleKind.ESNext, moduleResolution: ts.ModuleResolutionKind.Bundler,
    target: ts.ScriptTarget.ES2022});
  let wrong = 0;
  for (const {file: where, start, messageText} of ts.getPreEmitDiagnostics(program)) {
    const line = where?.fileName === source ? where.getLineAndCharacterOfPosition(start).line : undefined;
    console.log(`${parts[line]?.[0] ?? where?.fileName}: ${ts.flattenDiagnosticMessageText(messageText, ' ')}`);
    wrong++;
  }
  console.log(`${parts.length} parts, ${wrong} wrong`);
  process.exitCode = wrong ? 1 : 0;
} finally {
  rmSync(folder, {recursive: true});
}
