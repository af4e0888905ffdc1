"""What the fuzzer does, in rounds: each a few connections at a time, and what is sent on each.

A round is a function of the seed and its number, given what the server offers, so that it can be
repeated. It is a list of connections {"port": "service", "admin" or "metrics", "steps": [...]}, with the
steps of calls.py and two more: ["half-close"] ends what is sent and reads until the server closes,
["close"] closes at once."""

import random as random_module
import struct

import http2_client as http2
from wire import calls, corpus, mutation

SERVICE, ADMIN, METRICS = "service", "admin", "metrics"
EMPTY_CALLS = 60  # fewer than one client may have at a time
EMPTY_WAVES = 60  # of calls of Synthesize, each of which begins when the last one is over
CALLS_A_CONNECTION = 40
MOST_BETWEEN = 3  # messages between the opening of a live session and its last one
ADMIN_CALLS = 4  # each may load a model, one after the other
LARGE_WINDOW = 2**31 - 1


def connection(port, steps, window=LARGE_WINDOW):
    """One that greets as HTTP/2 requires and, unless its window is small, reads all it is sent."""
    settings = struct.pack(">HI", http2.SETTING_INITIAL_WINDOW, window)
    greeting = http2.PREFACE + http2.frame(http2.SETTINGS, 0, 0, settings)
    if window == LARGE_WINDOW:
        greeting += http2.frame(http2.WINDOW_UPDATE, 0, 0, struct.pack(">I", LARGE_WINDOW - 65535))
    return {"port": port, "steps": [["send", greeting], *steps]}


def closing(random):
    """How a client leaves: it stops sending and reads to the end, or it is gone."""
    return random.choice((["half-close"], ["close"]))


class Rounds:
    """The rounds of a seed. `methods` is [(port, "service/method", its requests), ...]."""

    def __init__(self, seed, methods):
        self._seed = seed
        self._methods = sorted(methods)
        self._systematic = list(self._sweep())

    @property
    def systematic_count(self):
        """Rounds before the random ones."""
        return len(self._systematic)

    def __getitem__(self, number):
        if number < len(self._systematic):
            return self._systematic[number]
        return self._random_round(random_module.Random(f"{self._seed}/{number}"))

    def _sweep(self):
        """Two clients with nothing but empty messages of each method; then every simple change of
        every request, over two connections."""
        synthesis_first = sorted(self._methods, key=lambda each: each[1] != corpus.SYNTHESIZE)
        for port, method, _ in synthesis_first:
            waves = EMPTY_WAVES if method == corpus.SYNTHESIZE else 1
            steps = [step for wave in range(waves)
                     for step in pipelined(method, [(b"",)] * EMPTY_CALLS, 1 + 2 * EMPTY_CALLS * wave)]
            yield [connection(port, steps) for _ in range(2)]
        for port, method, requests in self._methods:
            changed = list(dict.fromkeys(
                change for request in requests for change in mutation.systematic(request)))
            changed = [(change,) for change in changed] + [
                (opening, change) for opening in corpus.openings(method, requests)[:1]
                for change in changed]
            for at in range(0, len(changed), 2 * CALLS_A_CONNECTION):
                halves = (changed[at:at + CALLS_A_CONNECTION],
                          changed[at + CALLS_A_CONNECTION:at + 2 * CALLS_A_CONNECTION])
                yield [connection(port, pipelined(method, half)) for half in halves if half]

    def _random_round(self, random):
        kinds = random.choices((self._odd_calls, self._same_calls, raw_frames, raw_http),
                               weights=(12, 3, 3, 1), k=random.randint(1, 5))
        return [kind(random) for kind in kinds]

    def _pick(self, random, port):
        """A method and its requests: most calls are those that the server exists for."""
        offered = [(method, requests) for of, method, requests in self._methods if of == port]
        chosen = [each for each in offered if each[0] == corpus.SYNTHESIZE]
        return random.choice(chosen if chosen and random.random() < 0.5 else offered)

    def _messages(self, random, method, requests):
        """The messages of a call: one, or an opening and a few of those that may follow it."""
        openings, message = corpus.openings(method, requests), self._message(random, requests)
        if not openings or random.random() < 0.4:
            return (message,)
        between = [self._message(random, requests[len(openings):])
                   for _ in range(random.randrange(MOST_BETWEEN + 1))]
        return (random.choice(openings), *between, message)

    def _message(self, random, requests):
        request, other = random.choice(requests), random.choice(requests)
        kind = random.random()
        if kind < 0.1:
            return b""
        if kind < 0.2:
            return request
        if kind < 0.35:
            return random.choice(list(mutation.systematic(request)))
        return mutation.mutated(request, other, random)

    def _odd_calls(self, random):
        """A connection with calls that take turns, each with anything wrong."""
        port = random.choice((SERVICE, SERVICE, SERVICE, ADMIN))
        waiting = []
        most = 2 * ADMIN_CALLS if port == ADMIN else CALLS_A_CONNECTION
        for _ in range(random.randint(1, most)):
            method, requests = self._pick(random, port)
            waiting.append((method, self._messages(random, method, requests)))
        window = random.choice((LARGE_WINDOW,) * 6 + (0, 1, 100))
        steps = interleaved(waiting, random.randint(1, 8), window == LARGE_WINDOW, random)
        return connection(port, [*steps, closing(random)], window)

    def _same_calls(self, random):
        """Many calls of one kind at once, as in a race for the same place."""
        port = random.choice((SERVICE, SERVICE, SERVICE, ADMIN))
        method, requests = self._pick(random, port)
        messages = self._messages(random, method, requests)
        most = ADMIN_CALLS if port == ADMIN else EMPTY_CALLS
        return connection(port, pipelined(method, [messages] * random.randint(2, most)))


def pipelined(method, each_call, first_stream=1):
    """Calls begun one after the other without waiting, all of which are then waited for. `each_call`: the
    messages of each."""
    streams = range(first_stream, first_stream + 2 * len(each_call), 2)
    steps = [list(calls.plain(stream, method, *messages))
             for stream, messages in zip(streams, each_call)]
    return [each[0] for each in steps] + [step for each in steps for step in each[1:]]


def interleaved(waiting, together, reading, random):
    """Odd calls, at most so many at a time, their steps in a random order."""
    active, stream = [], 1
    waiting = list(waiting)
    while waiting or active:
        if waiting and len(active) < together:
            method, messages = waiting.pop()
            active.append(calls.odd(stream, method, messages, random, reading))
            # A stream begins in the order of its number.
            yield next(active[-1])
            stream += 2
            continue
        call = random.choice(active)
        step = next(call, None)
        if step is None:
            active.remove(call)
        else:
            yield step


def raw_frames(random):
    """HTTP/2 frames that break its rules: wrong lengths, streams, order and types."""
    block = http2.request_headers("/duet.v1.MotionSynthesis/Synthesize")
    steps = []
    for _ in range(random.randint(1, 12)):
        kind = random.choice((*range(11), 200))
        payload = random.choice((b"", random.randbytes(random.randrange(20)), block, bytes(4),
                                 bytes(8), struct.pack(">HI", 4, 2**32 - 1)))
        sent = http2.frame(kind, random.choice((0, 1, 4, 5, 8, 0x20, 255)),
                           random.choice((0, 1, 1, 2, 3, 2**31 - 1, 2**32 - 1)), payload)
        if random.random() < 0.2:  # another length than that of the payload
            sent = random.choice((0, 1, 2**14 + 1, 2**24 - 1)).to_bytes(3, "big") + sent[3:]
        if random.random() < 0.1:
            sent = sent[:random.randrange(len(sent))]
        steps.append(["send", sent])
    port = random.choice((SERVICE, SERVICE, ADMIN))
    steps.append(closing(random))
    if random.random() < 0.2:
        no_preface = random.choice((b"", b"\0", b"GET / HTTP/1.1\r\n\r\n", http2.PREFACE[:9],
                                    random.randbytes(30)))
        return {"port": port, "steps": [["send", no_preface], closing(random)]}
    return connection(port, steps, window=random.choice((LARGE_WINDOW, 0)))


def raw_http(random):
    """Bytes for the metrics port."""
    request = bytearray(b"GET /metrics HTTP/1.1\r\nHost: a\r\n\r\n")
    for _ in range(random.randrange(6)):
        request[random.randrange(len(request))] = random.randrange(256)
    text = random.choice((bytes(request), bytes(request) * 3, b"", b"\r\n", request[:7],
                          b"POST /readyz HTTP/1.1\r\nContent-Length: 99\r\n\r\n",
                          b"GET /" + b"a" * 9000 + b" HTTP/1.1\r\n\r\n"))
    return {"port": METRICS, "steps": [["send", bytes(text)], closing(random)]}
