"""The label vector of a live session over time."""

from __future__ import annotations

from typing import Dict, List, Mapping, Tuple

from duet_motion.request import Labels

Keyframe = Tuple[int, Dict[str, float]]


class LabelTrack:
    """Keyframes of weights: linear between them, constant before the first and after the last."""

    def __init__(self, keyframes: Mapping[int, Labels]) -> None:
        self._keys: List[Keyframe] = sorted(
            (int(frame), {name: float(weight) for name, weight in labels.items()})
            for frame, labels in keyframes.items())

    def at(self, frame: int) -> Dict[str, float]:
        """The weights at a frame; empty without keyframes."""
        before = [key for key in self._keys if key[0] <= frame]
        after = [key for key in self._keys if key[0] > frame]
        if not before or not after:
            key = before[-1] if before else after[0] if after else (0, {})
            return dict(key[1])
        (first, old), (last, new) = before[-1], after[0]
        share = (frame - first) / (last - first)
        return {name: old.get(name, 0.0) + (new.get(name, 0.0) - old.get(name, 0.0)) * share
                for name in {**old, **new}}

    def change(self, frame: int, labels: Labels, ease_frames: int) -> None:
        """Changes the weights linearly from those at ``frame`` to ``labels`` within
        ``ease_frames``, and drops the keyframes after ``frame``."""
        last = frame if ease_frames else frame - 1  # the last frame with the old weights
        old = self.at(last)
        self._keys = [key for key in self._keys if key[0] < last]
        if last >= 0 and old:
            self._keys.append((last, old))
        self._keys.append((frame + ease_frames,
                           {name: float(weight) for name, weight in labels.items()}))

    def since(self, frame: int) -> List[Keyframe]:
        """Forgets the keyframes that do not apply at ``frame`` or later, and returns the others."""
        past = [at for at, _ in self._keys if at <= frame]
        self._keys = [key for key in self._keys if not past or key[0] >= past[-1]]
        return list(self._keys)
