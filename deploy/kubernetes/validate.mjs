// Checks manifests against the schemas that Kubernetes, KEDA and the Prometheus operator publish, from npm's
// kubernetes-models packages: values and required fields by the schemas, unknown names by the types
// generated from them. Reads a JSON array of objects from standard input; exits with 1 if one is invalid.
//   npm install --ignore-scripts kubernetes-models @kubernetes-models/keda \
//       @kubernetes-models/prometheus-operator typescript@5
//   ... | node deploy/kubernetes/validate.mjs NODE_MODULES
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

const modules = path.resolve(process.argv[2]);

// The package that has the class for an API version.
function packageOf(apiVersion) {
  if (apiVersion.startsWith('keda.sh/')) return '@kubernetes-models/keda';
  if (apiVersion.startsWith('monitoring.coreos.com/')) return '@kubernetes-models/prometheus-operator';
  return 'kubernetes-models';
}

function fileOf({apiVersion, kind}) {
  return path.join(modules, packageOf(apiVersion), apiVersion, `${kind}.js`);
}

const nameOf = ({apiVersion, kind, metadata}) => `${apiVersion} ${kind} ${metadata.name}`;

// The schema's error for an object's values, or undefined.
async function wrongValue(object) {
  const found = await import(pathToFileURL(fileOf(object)));
  const Model = found[object.kind] ?? found.default[object.kind];
  try {
    new Model(object).validate();
  } catch (error) {
    return error.message;
  }
}

// The type errors in each object, as [name of the object, message]. TypeScript reports unknown fields only of
// object literals, so this writes a source file.
async function wrongNames(objects) {
  const {default: ts} = await import(pathToFileURL(path.join(modules, 'typescript/lib/typescript.js')));
  const folder = mkdtempSync(path.join(tmpdir(), 'manifests-'));
  const wrong = [];
  try {
    for (const [index, object] of objects.entries()) {
      const {apiVersion, kind, ...fields} = object;
      writeFileSync(path.join(folder, `${index}.ts`),
        `import {${kind}} from ${JSON.stringify(fileOf(object))};\n`
        + `export const object = new ${kind}(${JSON.stringify(fields, null, 1)});\n`);
    }
    const program = ts.createProgram(objects.map((_, index) => path.join(folder, `${index}.ts`)), {
      strict: true, noEmit: true, skipLibCheck: true, types: [],
      module: ts.ModuleKind.ESNext, moduleResolution: ts.ModuleResolutionKind.Bundler,
      target: ts.ScriptTarget.ES2022});
    for (const {file, messageText} of ts.getPreEmitDiagnostics(program)) {
      if (!file?.fileName.startsWith(folder)) continue;
      const index = Number(path.basename(file.fileName, '.ts'));
      wrong.push([nameOf(objects[index]), ts.flattenDiagnosticMessageText(messageText, ' ')]);
    }
  } finally {
    rmSync(folder, {recursive: true});
  }
  return wrong;
}

const objects = JSON.parse(readFileSync(0, 'utf8'));
const problems = await wrongNames(objects);
for (const object of objects) {
  const message = await wrongValue(object);
  if (message) problems.push([nameOf(object), message]);
}
for (const [name, message] of problems) console.log(`${name}: ${message}`);
const failed = new Set(problems.map(([name]) => name)).size;
console.log(`${objects.length - failed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
