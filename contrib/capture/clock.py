"""From frames as they arrive to frames at a fixed rate. Pure functions of what arrived and when: nothing here
reads a clock, and times must not decrease."""

import bisect
import collections
import math
import re
import statistics
from typing import Callable, Deque, Dict, List, NamedTuple, Optional, Set

import numpy as np

from frames import Frame, Reader

REORDER_SECONDS = 0.03  # how long a missing frame is waited for once a later one is here
BRIDGE_SECONDS = 0.25   # gaps up to this length are interpolated, longer ones are held
_STALE_FRAMES = 4       # after so many in succession that do not advance, the sender's clock has jumped back
JUMP_SECONDS = 1.0      # a sender's time that is later than expected by more is another clock's
_SAME_TIME = 1e-5       # two times of one frame differ by rounding at most
_GAP_PERIODS = 1.5      # of the sender; a longer interval is a gap
# The part of the output's period by which a frame's time may differ from the output's: of frames with times,
# and of frames with the times of their arrival, which are no better than the network.
_SNAP_TIMED, _SNAP_ARRIVED = 0.2, 0.5
_PHASE_GAIN = 0.1       # part of that difference by which the output's phase follows
_DRIFT = 2e-3           # seconds per second by which two clocks may run apart
_USUAL_RATES = (10, 12, 15, 20, 24, 25, 30, 50, 60, 72, 75, 90, 100, 120)
_NEAR_RATE = 0.04       # of a usual rate
MAX_RATE_HZ = 120       # above it, every second (third, ...) frame is left out


class TimedFrame(NamedTuple):
    index: int              # from 0, without gaps
    capture_seconds: float  # on the receiver's clock, as well as it is known
    source: str             # "captured", "interpolated" or "held"
    positions: np.ndarray   # [joints, 3]


class _Sample(NamedTuple):
    seconds: float  # when it was captured: the sender's time, on the receiver's clock
    arrival: float
    positions: np.ndarray


class FrameClock:
    """Puts the frames of a stream into order.

    Order and distances of frames are those of the sender's times; a frame without a time has that of its
    arrival. The smallest delay between the two clocks converts one to the other, so that jitter of the network
    does not reach the frames. A frame is passed on as soon as it arrives if it is the next one. The output's
    phase follows the sender slowly, so that two rates that are nearly equal do not drift apart.
    """

    def __init__(self, rate_hz: float) -> None:
        self._period = 1 / rate_hz
        self.counts: Dict[str, int] = collections.Counter()
        self.notes: List[str] = []  # rare events in words; taken by the stream
        self._shift = math.inf      # from the sender's clock to the receiver's
        self._received_at = 0.0
        self._usual = math.inf      # the sender's period
        self._left: Optional[_Sample] = None  # the last sample that was passed on or passed over
        self._waiting: List[_Sample] = []     # later samples, in order
        self._recent: Deque[float] = collections.deque(maxlen=64)  # the sender's times
        self._due = 0.0                       # when the next frame of the output was captured
        self._snap = 0.0
        self._index = self._stale = 0
        self._held_from: Optional[float] = None

    def receive(self, frame: Frame, now: float) -> None:
        """A frame that arrived at `now`."""
        known = frame.seconds is not None and any(
            abs(frame.seconds - seconds) < _SAME_TIME for seconds in self._recent)
        sample = _Sample(self._to_receiver(frame.seconds, now), now, frame.positions)
        newest = self._waiting[-1] if self._waiting else self._left
        is_late = self._left is not None and sample.seconds <= max(self._left.seconds, self._due - self._period)
        if known or is_late:
            self._stale += 1
            if self._stale < _STALE_FRAMES:
                self.counts["duplicates" if known else "too late"] += 1
                return
            self._jump(sample.seconds - now)
            sample = _Sample(self._to_receiver(frame.seconds, now), now, frame.positions)
        self._stale = 0
        if newest is None:
            self._due = sample.seconds
        elif sample.seconds < newest.seconds:
            self.counts["put back into order"] += 1
        else:
            interval = sample.seconds - newest.seconds
            self._usual = interval if math.isinf(self._usual) else min(
                self._usual + 0.1 * (interval - self._usual), 2 * self._usual)
        if frame.seconds is not None:
            self._recent.append(frame.seconds)
        self._snap = (_SNAP_ARRIVED if frame.seconds is None else _SNAP_TIMED) * self._period
        bisect.insort(self._waiting, sample, key=lambda waiting: waiting.seconds)
        del self._waiting[:-256]

    def next(self, now: float) -> Optional[TimedFrame]:
        """The next frame of the output, if it is due at `now`."""
        while self._waiting and self._waiting[0].seconds < self._due - self._snap:
            self._left = self._waiting.pop(0)  # held or interpolated frames took its place
        if not self._waiting:
            return self._hold(now) if now >= self.next_due() else None
        left, right = self._left, self._waiting[0]
        if left is None or right.seconds <= self._due + self._snap:
            self._due += _PHASE_GAIN * (right.seconds - self._due)
            self._left = self._waiting.pop(0)
            return self._emit("captured", right.positions)
        gap = right.seconds - left.seconds
        is_missing = gap > _GAP_PERIODS * self._usual
        if is_missing and self._held_from is None and now < right.arrival + REORDER_SECONDS:
            return None
        if gap > BRIDGE_SECONDS:
            return self._hold(now)
        self.counts["interpolated"] += is_missing
        share = (self._due - left.seconds) / gap
        return self._emit("interpolated", left.positions + share * (right.positions - left.positions))

    def next_due(self) -> float:
        """The earliest time at which `next` may return a frame if nothing arrives; infinite if never."""
        if self._waiting:
            return self._waiting[0].arrival + REORDER_SECONDS
        if self._left is None:
            return math.inf
        return max(self._due, 0 if self._held_from is not None else
                   self._left.seconds + BRIDGE_SECONDS + REORDER_SECONDS)

    def _to_receiver(self, seconds: Optional[float], now: float) -> float:
        if seconds is None:
            return now
        if math.isfinite(self._shift) and not -JUMP_SECONDS < now - (seconds + self._shift) < JUMP_SECONDS:
            self._jump(seconds + self._shift - now)
        self._shift = min(self._shift + _DRIFT * (now - self._received_at), now - seconds)
        self._received_at = now
        return seconds + self._shift

    def _jump(self, seconds: float) -> None:
        self.counts["jumps of the sender's clock"] += 1
        if self.counts["jumps of the sender's clock"] <= 3:
            self.notes.append(f"the sender's clock jumped by {seconds:.2f} s at frame {self._index}")
        self._shift = math.inf
        self._recent.clear()

    def _hold(self, now: float) -> TimedFrame:
        if self._held_from is None:
            self._held_from = self._left.seconds
            self.notes.append(f"nothing arrives for {now - self._held_from:.2f} s: the pose is held from frame "
                              f"{self._index}")
        self.counts["held"] += 1
        return self._emit("held", self._left.positions)

    def _emit(self, source: str, positions: np.ndarray) -> TimedFrame:
        if source != "held" and self._held_from is not None:
            self.notes.append(f"frames arrive again after {self._due - self._held_from:.2f} s, at frame "
                              f"{self._index}")
            self._held_from = None
        frame = TimedFrame(self._index, self._due, source, positions)
        self._index += 1
        self._due += self._period
        return frame


def estimate_rate(times: List[float]) -> Optional[float]:
    """Hz, from the times of a stream's first frames; None until they span a second. A usual rate if the
    measured one is near it, at most MAX_RATE_HZ."""
    ordered = sorted(times)
    intervals = [b - a for a, b in zip(ordered, ordered[1:]) if b > a]
    if len(intervals) < 10 or ordered[-1] - ordered[0] < 1:
        return None
    median = statistics.median_high(intervals)
    rate = 1 / statistics.fmean(step for step in intervals if abs(step - median) <= 0.5 * median)
    rate /= math.ceil(rate / MAX_RATE_HZ - _NEAR_RATE)
    usual = min(_USUAL_RATES, key=lambda usual: abs(rate - usual) / usual)
    return max(1.0, usual if abs(rate - usual) <= _NEAR_RATE * usual else rate)


class CaptureStream:
    """From datagrams to frames at a fixed rate: a reader, the measurement of the rate, and the clock.

    The first sender of a complete frame leads. Datagrams of others are ignored until it has been silent for
    two seconds. Every sender has a reader of its own, so that two senders to one port are not mixed.

    Args:
        make_reader: makes the protocol's reader.
        rate_hz: of the output; 0: measured in the first second, whose frames are not passed on.
    """

    SENDER_SILENCE = 2.0
    PATIENCE = 1.5  # seconds after which a stream of datagrams without a frame is reported
    _MOST_SENDERS, _MOST_KINDS_OF_ERRORS = 4, 8

    def __init__(self, make_reader: Callable[[], Reader], rate_hz: float = 0) -> None:
        self._make_reader = make_reader
        self.joint_names = make_reader().joint_names
        self.rate_hz = rate_hz
        self.notes: List[str] = []  # for the user; the caller takes them
        self.counts: Dict[str, int] = collections.Counter()
        self._readers: Dict[object, Reader] = {}
        self._clock = FrameClock(rate_hz) if rate_hz else None
        self._times: Deque[float] = collections.deque(maxlen=500)
        self._leader: object = None
        self._leader_heard = -math.inf
        self._first_heard: Optional[float] = None  # the first datagram, until silence is reported
        self._errors: Set[str] = set()

    def receive(self, datagram: bytes, sender: object, now: float) -> None:
        if self._leader not in (None, sender) and now - self._leader_heard < self.SENDER_SILENCE:
            if not self.counts["of other senders"]:
                self.notes.append("a second sender sends to this port; its frames are ignored")
            self.counts["of other senders"] += 1
            return
        if not self._readers:
            self._first_heard = now
        reader = self._reader_of(sender)
        try:
            frames = reader.read(datagram)
        except ValueError as error:
            self._note_error(str(error))
            return
        if frames:
            self._leader, self._leader_heard, self._first_heard = sender, now, None
        self.notes += reader.notes
        reader.notes.clear()
        for frame in frames:
            self._receive_frame(frame, now)

    def next(self, now: float) -> Optional[TimedFrame]:
        """See FrameClock."""
        if self._first_heard is not None and now >= self._first_heard + self.PATIENCE:
            self._first_heard = None
            missing = next(filter(None, (reader.missing() for reader in self._readers.values())), "")
            self.notes.append(f"warning: datagrams arrived for {self.PATIENCE} s, but no frame; {missing}")
        if self._clock is None:
            return None
        frame = self._clock.next(now)
        self.notes += self._clock.notes
        self._clock.notes.clear()
        return frame

    def next_due(self) -> float:
        silence = math.inf if self._first_heard is None else self._first_heard + self.PATIENCE
        return min(silence, self._clock.next_due() if self._clock else math.inf)

    def summary(self) -> str:
        counts = self.counts + (self._clock.counts if self._clock else collections.Counter())
        return "; ".join([f"{counts.pop('frames', 0)} frames"]
                         + ([", ".join(f"{count} {what}" for what, count in counts.items())] if counts else []))

    def _reader_of(self, sender: object) -> Reader:
        if sender not in self._readers:
            if len(self._readers) >= self._MOST_SENDERS:
                del self._readers[next(known for known in self._readers if known != self._leader)]
            self._readers[sender] = self._make_reader()
        return self._readers[sender]

    def _receive_frame(self, frame: Frame, now: float) -> None:
        self.counts["frames"] += 1
        if self._clock is None:
            seconds = now if frame.seconds is None else frame.seconds
            if self._times and abs(seconds - self._times[-1]) > 1:
                self._times.clear()  # a clock that jumps begins anew
            self._times.append(seconds)
            self.rate_hz = estimate_rate(list(self._times)) or 0
            if not self.rate_hz:
                return
            self._clock = FrameClock(self.rate_hz)
        self._clock.receive(frame, now)

    def _note_error(self, error: str) -> None:
        """Reports each kind of error once, whatever its numbers."""
        self.counts["datagrams not understood"] += 1
        kind = re.sub(r"\d", "", error.split(", got ")[0])
        if kind not in self._errors and len(self._errors) < self._MOST_KINDS_OF_ERRORS:
            self._errors.add(kind)
            self.notes.append(error)
