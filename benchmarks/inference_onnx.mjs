// The peers of synthesis_benchmark.cc in ONNX Runtime: the graphs that inference_eager.py exports, one
// thread. Prints what inference_eager.py prints.
//   node inference_onnx.mjs NODE_MODULES GRAPHS BATCH...
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const [modules, graphs, ...batches] = process.argv.slice(2);
const ort = createRequire(pathToFileURL(`${modules}/`))("onnxruntime-node");

const FRAMES = 45, JOINTS = 15, CLASSES = 6;
const START = 3 + 3 * JOINTS + 2;

// Milliseconds of processor time, the median of a few.
async function milliseconds(session, batch) {
  const tensor = (...shape) => {
    const values = Float32Array.from({ length: shape.reduce((a, b) => a * b) }, Math.random);
    return new ort.Tensor("float32", values, shape);
  };
  const feeds = {
    leader: tensor(batch, FRAMES, 3 * JOINTS),
    labels: tensor(batch, FRAMES, CLASSES),
    start: tensor(batch, START),
  };
  const wanted = Object.fromEntries(session.inputNames.map((name) => [name, feeds[name]]));
  await session.run(wanted); // warms up
  const times = [];
  let all = 0;
  while (times.length < 5 || all < 500) {
    const begin = process.cpuUsage();
    await session.run(wanted);
    const used = process.cpuUsage(begin);
    times.push((used.user + used.system) / 1000);
    all += times[times.length - 1];
  }
  times.sort((a, b) => a - b);
  return times[Math.floor(times.length / 2)];
}

for (const model of ["sbu@1", "sbu@3"]) {
  const session = await ort.InferenceSession.create(`${graphs}/${model}.onnx`, {
    intraOpNumThreads: 1,
    interOpNumThreads: 1,
    graphOptimizationLevel: "all",
  });
  for (const batch of batches.map(Number)) {
    console.log(JSON.stringify({ model, batch, milliseconds: await milliseconds(session, batch) }));
  }
}
