"""The peer of training_benchmark.cc: the same network, batch, loss and optimiser in eager PyTorch.

Prints clips a second. Sizes: the paper's (section 3.1, 3.2), 16 clips of 45 frames, Adam, L1.
"""
import sys
import time

import torch
from torch import nn

BATCH, FRAMES, JOINTS, CLASSES, ENCODER, ATTENTION = 16, 45, 15, 6, 40, 128
PARTS = [[3, 4, 5], [6, 7, 8], [9, 10, 11], [12, 13, 14], [0, 1, 2]]


class Generator(nn.Module):
    def __init__(self):
        super().__init__()
        widths = [9] * 5 + [3 * JOINTS + CLASSES]
        self.fc = nn.ModuleList(nn.Linear(w, w + 50) for w in widths)
        self.encoders = nn.ModuleList(
            nn.LSTM(w + 50, ENCODER, batch_first=True, bidirectional=True) for w in widths)
        state = len(widths) * ENCODER
        self.cells = nn.ModuleList(nn.LSTMCell(2 * state, state) for _ in range(2))
        self.encoded = nn.ModuleList(nn.Linear(2 * state, ATTENTION, bias=False) for _ in range(2))
        self.query = nn.ModuleList(nn.Linear(state, ATTENTION, bias=False) for _ in range(2))
        self.score = nn.ModuleList(nn.Linear(ATTENTION, 1, bias=False) for _ in range(2))
        self.output = nn.Linear(2 * state, 3 * JOINTS)

    def forward(self, leader, labels):
        joints = leader.view(BATCH, FRAMES, JOINTS, 3)
        slices = [joints[:, :, part].flatten(2) for part in PARTS]
        slices.append(torch.cat([leader, labels], 2))
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
            context = (energy.softmax(1) * frames).sum(1)
            h, c = self.cells[d](context, (h, c))
            steps.append(h)
        return torch.stack(steps, 1)


def main():
    threads, steps = int(sys.argv[1]), int(sys.argv[2])
    torch.set_num_threads(threads)
    torch.manual_seed(0)
    generator = Generator()
    optimiser = torch.optim.AdamW(generator.parameters(), lr=2e-3)
    leader, target = torch.randn(2, BATCH, FRAMES, 3 * JOINTS)
    labels = torch.zeros(BATCH, FRAMES, CLASSES)
    begin = None
    for step in range(steps + 1):
        if step == 1:  # the first one warms up
            begin = time.perf_counter()
        loss = (generator(leader, labels) - target).abs().sum(2).mean()
        optimiser.zero_grad(set_to_none=True)
        loss.backward()
        optimiser.step()
    seconds = time.perf_counter() - begin
    print(f"eager PyTorch {torch.__version__}, {threads} thread(s): "
          f"{BATCH * steps / seconds:.1f} clips/s")


if __name__ == "__main__":
    main()
