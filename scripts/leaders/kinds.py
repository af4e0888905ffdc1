"""What the leaders do. Each kind draws its tempo, sizes and pauses from a random generator."""

import math

from leaders import body

Body = body.Body


def _times(seconds):
    return [k / body.KEYS_PER_SECOND for k in range(round(seconds * body.KEYS_PER_SECOND) + 1)]


def _ease(way):
    way = min(1, max(0, way))
    return way * way * (3 - 2 * way)


def _wave(amplitude, t, period, phase=0):
    return amplitude * math.sin(2 * math.pi * (t / period + phase))


def _events(random, seconds, pause, length):
    """Events of random lengths, with random pauses between them: [(begin, end)]."""
    events, t = [], random.uniform(*pause)
    while t < seconds:
        end = t + random.uniform(*length)
        events.append((t, end))
        t = end + random.uniform(*pause)
    return events


def _hold(t, events, rise):
    """1 during an event, 0 elsewhere, with `rise` seconds between."""
    return max((_ease((t - a) / rise) * _ease((b - t) / rise) for a, b in events), default=0)


def _swing_arms(pose, t, period, size):
    swing = _wave(size, t, period)
    pose.left_hand, pose.right_hand = (0.24, -0.5, 0.08 + swing), (-0.24, -0.5, 0.08 - swing)


def circles(random, seconds):
    """Walks in circles, and turns round to walk the other way."""
    radius, speed = random.uniform(0.6, 1.4), random.uniform(0.4, 0.9)
    back = random.uniform(0.35, 0.65) * seconds
    direction = random.choice((1, -1))
    pose, poses = Body(torso=body.WALKING_TORSO), []
    angle = 0
    for t in _times(seconds):
        turned_back = _ease((t - back) / 2)
        pace = abs(1 - 2 * turned_back)
        sign = direction if t < back + 1 else -direction
        angle += sign * pace * speed / radius / body.KEYS_PER_SECOND
        x, z = direction * radius * (1 - math.cos(angle)), direction * radius * math.sin(angle)
        pose = Body(x=x, z=z, yaw=math.degrees(angle) + 180 * turned_back,
                    torso=body.WALKING_TORSO + _wave(0.01, t, 0.45), pitch=4)
        _swing_arms(pose, t, 0.9, 0.16)
        poses.append(pose)
    return poses


def paces(random, seconds):
    """Walks to and fro, with a turn at each end."""
    length, speed = random.uniform(0.8, 2), random.uniform(0.5, 1)
    heading = random.uniform(-60, 60)
    poses, x, z, yaw, left = [], 0, 0, heading, length
    wanted = heading
    for t in _times(seconds):
        behind = wanted - yaw
        yaw += max(-12, min(12, behind / 3))
        pace = speed * _ease(1 - abs(behind) / 60)
        dx, dz = body.turned(0, pace / body.KEYS_PER_SECOND, yaw)
        x, z, left = x + dx, z + dz, left - pace / body.KEYS_PER_SECOND
        if left <= 0 and abs(behind) < 5:
            wanted, left = wanted + random.choice((180, -180)), length
        pose = Body(x=x, z=z, yaw=yaw, torso=body.WALKING_TORSO, pitch=3)
        _swing_arms(pose, t, 1.0, 0.14 * pace / speed)
        poses.append(pose)
    return poses


def turns(random, seconds):
    """Stands and turns on the spot, to one side or the other, sometimes all the way round."""
    events = [(a, b, random.choice((1, -1)) * random.choice((60, 90, 120, 180, 360)))
              for a, b in _events(random, seconds, (0.6, 3), (0.9, 2.2))]
    poses = []
    for t in _times(seconds):
        yaw = sum(angle * _ease((t - a) / (b - a)) for a, b, angle in events)
        ahead = sum(angle * _ease((t + 0.25 - a) / (b - a)) for a, b, angle in events)
        pose = Body(yaw=yaw, torso=1.08, head_yaw=max(-40, min(40, ahead - yaw)),
                    sway=_wave(0.02, t, 3.7))
        _swing_arms(pose, t, 2.3, 0.05)
        poses.append(pose)
    return poses


def dances(random, seconds):
    """Steps from side to side in a beat, with swinging hips and arms, and spins now and then."""
    beat = random.uniform(0.45, 0.7)
    width, arms = random.uniform(0.12, 0.3), random.uniform(0.1, 0.3)
    spins = [(a, a + 4 * beat, random.choice((360, -360)))
             for a, _ in _events(random, seconds, (4, 9), (2, 3))]
    poses = []
    for t in _times(seconds):
        spin = sum(angle * _ease((t - a) / (b - a)) for a, b, angle in spins)
        pose = Body(x=_wave(width, t, 8 * beat), z=_wave(0.5 * width, t, 16 * beat),
                    yaw=spin + _wave(25, t, 16 * beat), torso=1.05 + _wave(0.025, t, beat),
                    sway=_wave(0.05, t, 2 * beat), roll=_wave(6, t, 2 * beat),
                    chest_yaw=_wave(12, t, 4 * beat), pitch=3)
        high = _wave(arms, t, 4 * beat)
        pose.left_hand = (0.32, -0.25 + high, 0.25 + _wave(0.08, t, 2 * beat))
        pose.right_hand = (-0.32, -0.25 - high, 0.25 - _wave(0.08, t, 2 * beat))
        poses.append(pose)
    return poses


def crouches(random, seconds):
    """Crouches, stays down, looks at the floor, and gets up."""
    events = _events(random, seconds, (1, 4), (2.5, 5))
    depth, yaw = random.uniform(0.25, 0.42), random.uniform(-40, 40)
    poses = []
    for t in _times(seconds):
        down = _hold(t, events, 1.1)
        pose = Body(yaw=yaw + _wave(10, t, 9), torso=body.STANDING_TORSO - depth * down,
                    back=0.12 * down, pitch=4 + 38 * down, head_pitch=15 * down,
                    head_yaw=_wave(20, t, 5))
        low = -0.5 + 0.12 * down
        pose.left_hand = (0.16, low, 0.06 + 0.25 * down)
        pose.right_hand = (-0.2, low, 0.06 + 0.28 * down + _wave(0.1, t, 1.3) * down)
        poses.append(pose)
    return poses


def sits(random, seconds):
    """Sits down on a seat behind, gestures, and gets up."""
    events = _events(random, seconds, (1.5, 4), (5, 9))
    seat = random.uniform(0.66, 0.74)
    poses = []
    for t in _times(seconds):
        down = _hold(t, events, 1.3)
        bow = 35 * math.sin(math.pi * down)
        pose = Body(torso=body.STANDING_TORSO + (seat - body.STANDING_TORSO) * down,
                    back=0.34 * down, pitch=2 + bow, head_yaw=_wave(25, t, 6.1),
                    chest_yaw=_wave(8, t, 4.3))
        pose.left_hand = (0.18, -0.52 + 0.06 * down, 0.06 + 0.22 * down)
        talk = _wave(0.12, t, 1.7) * down
        pose.right_hand = (-0.2, -0.5 + 0.14 * down + talk, 0.06 + 0.26 * down)
        poses.append(pose)
    return poses


def idles(random, seconds):
    """Stands, shifts its weight, looks around, and raises a hand to its head or to a phone."""
    events = _events(random, seconds, (2, 5), (2, 4))
    phone = random.choice((True, False))
    shift, slow = random.uniform(0.02, 0.06), random.uniform(3, 6)
    poses = []
    for t in _times(seconds):
        up = _hold(t, events, 0.8)
        pose = Body(x=_wave(0.04, t, 11), yaw=_wave(12, t, 13), sway=_wave(shift, t, slow),
                    torso=body.STANDING_TORSO - 0.01, roll=_wave(3, t, slow),
                    head_yaw=_wave(30, t, 7.3) * (1 - up), head_pitch=25 * up * phone)
        target = (-0.06, -0.22, 0.3) if phone else (-0.12, 0.2, 0.08)
        rest = (-0.21, -0.55, 0.05)
        pose.right_hand = tuple(a + (b - a) * up for a, b in zip(rest, target))
        poses.append(pose)
    return poses


def gestures(random, seconds):
    """Waves, points, spreads its arms and claps, at nobody."""
    events = [(a, b, random.choice(("wave", "point", "spread", "clap")))
              for a, b in _events(random, seconds, (0.5, 2), (1.2, 3))]
    poses = []
    for t in _times(seconds):
        pose = Body(yaw=_wave(30, t, 12), torso=1.09, sway=_wave(0.02, t, 3.1), pitch=2)
        for begin, end, name in events:
            up = _hold(t, [(begin, end)], 0.5)
            left, right = {
                "wave": ((0.21, -0.55, 0.05), (-0.35 + _wave(0.12, t, 0.5), 0.2, 0.2)),
                "point": ((0.21, -0.55, 0.05), (-0.3, -0.05, 0.45)),
                "spread": ((0.55, -0.05, 0.15), (-0.55, -0.05, 0.15)),
                "clap": ((0.05 + abs(_wave(0.12, t, 0.6)), -0.2, 0.35),
                         (-0.05 - abs(_wave(0.12, t, 0.6)), -0.2, 0.35)),
            }[name]
            pose.left_hand = tuple(a + (b - a) * up for a, b in zip(pose.left_hand, left))
            pose.right_hand = tuple(a + (b - a) * up for a, b in zip(pose.right_hand, right))
        poses.append(pose)
    return poses


KINDS = (circles, paces, turns, dances, crouches, sits, idles, gestures)
