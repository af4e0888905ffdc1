"""The peer of training_benchmark.cc: the same network, batch, loss and optimiser in eager PyTorch.

Prints clips a second. Sizes from the paper (sections 3.1, 3.2), 16 clips of 45 frames, Adam, L1.
"""
import sys
import time

import torch

from inference_eager import CLASSES, FRAMES, JOINTS, Paper

BATCH = 16


def main():
    threads, steps = int(sys.argv[1]), int(sys.argv[2])
    torch.set_num_threads(threads)
    torch.manual_seed(0)
    generator = Paper(start=0)
    optimiser = torch.optim.AdamW(generator.parameters(), lr=2e-3)
    leader, target = torch.randn(2, BATCH, FRAMES, 3 * JOINTS)
    labels, start = torch.zeros(BATCH, FRAMES, CLASSES), torch.zeros(BATCH, 0)
    begin = None
    for step in range(steps + 1):
        if step == 1:  # the first one warms up
            begin = time.perf_counter()
        loss = (generator(leader, labels, start) - target).abs().sum(2).mean()
        optimiser.zero_grad(set_to_none=True)
        loss.backward()
        optimiser.step()
    seconds = time.perf_counter() - begin
    print(f"eager PyTorch {torch.__version__}, {threads} thread(s): "
          f"{BATCH * steps / seconds:.1f} clips/s")


if __name__ == "__main__":
    main()
