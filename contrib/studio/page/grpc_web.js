'use strict';
// One call over gRPC-web: sends one frame; receives frames with messages and a last one with
// trailers.

// A failed call: the server's message, and one problem for each invalid field.
class CallError extends Error {
  constructor(message, problems = []) {
    super(message);
    this.problems = problems;
  }
}

const AWAY_SECONDS = 2;  // between two questions to a server that is away

// As fetch. A browser's own error does not name the program that is missing.
async function fetchFrom(path, options) {
  try {
    return await fetch(path, options);
  } catch (error) {
    if (error.name === 'AbortError') throw error;
    throw new CallError(`The gateway at ${location.host} does not answer. Start it with ` +
                        'contrib/studio/gateway.py.');
  }
}

const pause = (seconds) => new Promise((resolve) => setTimeout(resolve, 1000 * seconds));

// What a page begins with: {about, models}.
async function askServer() {
  const response = await fetchFrom('/about.json');
  if (!response.ok) throw new CallError(await messageIn(response));
  const about = await response.json();
  let models = [];
  for await (const answer of callServer('ListModels', 'ListModelsRequest', {}, 'ListModelsResponse')) {
    models = answer.models;
  }
  return {about, models};
}

// The first answer of askServer. Calls `tellWhy` with each error before it.
async function awaitServer(tellWhy) {
  for (;;) {
    try {
      return await askServer();
    } catch (error) {
      tellWhy(error);
      await pause(AWAY_SECONDS);
    }
  }
}

class FrameReader {
  constructor(stream) {
    this.reader = stream.getReader();
    this.buffer = new Uint8Array(0);
  }

  // Returns `count` bytes, or null at the stream's end.
  async take(count) {
    while (this.buffer.length < count) {
      const {done, value} = await this.reader.read();
      if (done) return null;
      const joined = new Uint8Array(this.buffer.length + value.length);
      joined.set(this.buffer);
      joined.set(value, this.buffer.length);
      this.buffer = joined;
    }
    const taken = this.buffer.slice(0, count);
    this.buffer = this.buffer.slice(count);
    return taken;
  }

  // {isTrailer, data}, or null at the stream's end.
  async next() {
    const head = await this.take(5);
    if (!head) return null;
    const data = await this.take(new DataView(head.buffer).getUint32(1));
    return data && {isTrailer: head[0] >= 128, data};
  }
}

function readTrailers(data) {
  const lines = new TextDecoder().decode(data).trim().split('\r\n');
  return Object.fromEntries(lines.map((line) => {
    const colon = line.indexOf(':');
    return [line.slice(0, colon).toLowerCase(), line.slice(colon + 1).trim()];
  }));
}

// The problem of each field in a status' details (google.rpc.BadRequest).
function problemsIn(details) {
  if (!details) return [];
  const bytes = Uint8Array.from(atob(details.replace(/=+$/, '')), (letter) => letter.charCodeAt(0));
  return decode('Status', bytes).details
      .filter((detail) => detail.type_url.endsWith('/google.rpc.BadRequest'))
      .flatMap((detail) => decode('BadRequest', detail.value).field_violations)
      .map(({field, description}) => `${field}: ${description}`);
}

// Calls a method and yields the reply's messages, of type `answer`.
async function* callServer(method, request, message, answer, signal) {
  const body = encode(request, message);
  const frame = new Uint8Array(5 + body.length);
  new DataView(frame.buffer).setUint32(1, body.length);
  frame.set(body, 5);
  const response = await fetchFrom(`/duet.v1.MotionSynthesis/${method}`, {
    method: 'POST', body: frame, signal, headers: {'Content-Type': 'application/grpc-web+proto'},
  });
  if (!response.ok) throw new CallError(await messageIn(response));
  const frames = new FrameReader(response.body);
  for (let next = await frames.next(); next; next = await frames.next()) {
    if (!next.isTrailer) {
      yield decode(answer, next.data);
      continue;
    }
    const trailers = readTrailers(next.data);
    if (trailers['grpc-status'] === '0') return;
    throw new CallError(decodeURIComponent(trailers['grpc-message'] || 'The call failed.'),
                        problemsIn(trailers['grpc-status-details-bin']));
  }
  throw new CallError('The reply broke off. Press React again.');
}
