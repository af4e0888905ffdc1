"""The peers of synthesis_benchmark.cc: straightforward implementations of the same two generators in
eager PyTorch. Prints a line of JSON for each generator and batch: the median processor time in
milliseconds of a few runs.

    inference_eager.py THREADS BATCH...

Sizes: the embedded checkpoints' (sbu@1: the paper's sections 3.1 and 3.2; sbu@3: width 160, 4
blocks, 4 heads, feed-forward 480, one step), 45 frames. Weights are random: speed does not depend
on them.
"""
import json
import math
import statistics
import sys
import time

import torch
from torch import nn

FRAMES, JOINTS, CLASSES, ENCODER, ATTENTION = 45, 15, 6, 40, 128
START = 3 + 3 * JOINTS + 2
PARTS = [[3, 4, 5], [6, 7, 8], [9, 10, 11], [12, 13, 14], [0, 1, 2]]
WIDTH, BLOCKS, HEADS, FEED_FORWARD, REACH = 160, 4, 4, 480, 50


class Paper(nn.Module):
    """Hierarchical encoders and an attentive decoder in each direction, conditioned on a start of `start` values."""

    def __init__(self, start=START):
        super().__init__()
        widths = [9] * 5 + [3 * JOINTS + CLASSES + start]
        self.fc = nn.ModuleList(nn.Linear(w, w + 50) for w in widths)
        self.encoders = nn.ModuleList(
            nn.LSTM(w + 50, ENCODER, batch_first=True, bidirectional=True) for w in widths)
        state = len(widths) * ENCODER
        self.cells = nn.ModuleList(nn.LSTMCell(2 * state, state) for _ in range(2))
        self.encoded = nn.ModuleList(nn.Linear(2 * state, ATTENTION, bias=False) for _ in range(2))
        self.query = nn.ModuleList(nn.Linear(state, ATTENTION, bias=False) for _ in range(2))
        self.score = nn.ModuleList(nn.Linear(ATTENTION, 1, bias=False) for _ in range(2))
        self.output = nn.Linear(2 * state, 3 * JOINTS)

    def forward(self, leader, labels, start):
        joints = leader.reshape(-1, FRAMES, JOINTS, 3)
        slices = [joints[:, :, part].flatten(2) for part in PARTS]
        slices.append(torch.cat([leader, labels, start.unsqueeze(1).expand(-1, FRAMES, -1)], 2))
        outputs, hidden, cell = [], ([], []), ([], [])
        for fc, encoder, values in zip(self.fc, self.encoders, slices):
            out, (h, c) = encoder(fc(values))
            outputs.append(out)
            for direction in range(2):
                hidden[direction].append(h[direction])
                cell[direction].append(c[direction])
        frames = torch.cat(outputs, 2)
        decoded = [self.decode(d, frames, torch.cat(hidden[d], 1), torch.cat(cell[d], 1))
                   for d in range(2)]
        return self.output(torch.cat([decoded[0], decoded[1].flip(1)], 2))

    def decode(self, d, frames, h, c):
        projected, steps = self.encoded[d](frames), []
        for _ in range(FRAMES):
            energy = self.score[d](torch.tanh(projected + self.query[d](h).unsqueeze(1)))
            h, c = self.cells[d]((energy.softmax(1) * frames).sum(1), (h, c))
            steps.append(h)
        return torch.stack(steps, 1)


class Block(nn.Module):
    """Attention with a learned bias by distance, feed-forward, adaptive norms."""

    def __init__(self):
        super().__init__()
        self.modulation = nn.Linear(WIDTH, 4 * WIDTH)
        self.attention = nn.Linear(WIDTH, 3 * WIDTH)
        self.attended = nn.Linear(WIDTH, WIDTH)
        self.expand = nn.Linear(WIDTH, FEED_FORWARD)
        self.contract = nn.Linear(FEED_FORWARD, WIDTH)
        self.distance = nn.Parameter(torch.randn(HEADS, 2 * REACH + 1))
        frame = torch.arange(FRAMES)
        self.register_buffer("at", (frame[None] - frame[:, None]).clamp(-REACH, REACH) + REACH)

    def forward(self, frames, condition):
        scale, shift, scale2, shift2 = self.modulation(condition).unsqueeze(1).chunk(4, 2)
        normal = nn.functional.layer_norm(frames, (WIDTH,)) * (1 + scale) + shift
        q, k, v = self.attention(normal).reshape(-1, FRAMES, 3, HEADS, WIDTH // HEADS).permute(2, 0, 3, 1, 4).unbind(0)
        scores = q @ k.transpose(2, 3) / math.sqrt(WIDTH // HEADS) + self.distance[:, self.at]
        frames = frames + self.attended((scores.softmax(3) @ v).transpose(1, 2).flatten(2))
        normal = nn.functional.layer_norm(frames, (WIDTH,)) * (1 + scale2) + shift2
        return frames + self.contract(nn.functional.gelu(self.expand(normal)))


class Sampling(nn.Module):
    """From smooth noise to motion in one step of a transformer."""

    def __init__(self):
        super().__init__()
        self.frames = nn.Linear(9 * JOINTS + 5, WIDTH)
        self.sample = nn.Linear(3 * JOINTS, WIDTH, bias=False)
        self.start = nn.Linear(START, WIDTH)
        self.label = nn.Linear(CLASSES, WIDTH, bias=False)
        self.condition = nn.Linear(WIDTH, WIDTH)
        self.blocks = nn.ModuleList(Block() for _ in range(BLOCKS))
        self.norm = nn.LayerNorm(WIDTH)
        self.output = nn.Linear(WIDTH, 3 * JOINTS)
        self.smooth = nn.Parameter(torch.randn(FRAMES, FRAMES))
        self.covary = nn.Parameter(torch.randn(3 * JOINTS, 3 * JOINTS))

    def forward(self, leader, labels, start):
        noise = self.smooth @ torch.randn_like(leader) @ self.covary
        velocity = nn.functional.pad(leader[:, 1:] - leader[:, :-1], (0, 0, 1, 0))
        rest = leader.new_zeros(leader.shape[0], FRAMES, 3 * JOINTS + 5)
        told = self.start(start) + self.label(labels[:, 0])
        condition = nn.functional.silu(self.condition(told))
        frames = (self.frames(torch.cat([leader, velocity, rest], 2)) + self.sample(noise)
                  + condition.unsqueeze(1))
        for block in self.blocks:
            frames = block(frames, condition)
        return self.output(self.norm(frames))


def milliseconds(network, batch):
    leader = torch.randn(batch, FRAMES, 3 * JOINTS)
    labels, start = torch.zeros(batch, FRAMES, CLASSES), torch.zeros(batch, START)
    times = []
    with torch.no_grad():
        network(leader, labels, start)  # warms up
        while len(times) < 5 or sum(times) < 0.5:
            begin = time.process_time()
            network(leader, labels, start)
            times.append(time.process_time() - begin)
    return 1000 * statistics.median(times)


def main():
    threads, batches = int(sys.argv[1]), [int(batch) for batch in sys.argv[2:]]
    torch.set_num_threads(threads)
    torch.manual_seed(0)
    for name, network in (("sbu@1", Paper()), ("sbu@3", Sampling())):
        for batch in batches:
            print(json.dumps({"model": name, "batch": batch,
                              "milliseconds": milliseconds(network.eval(), batch)}), flush=True)


if __name__ == "__main__":
    main()
