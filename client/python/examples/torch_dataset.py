"""Trains on a data set of `duet batch` with PyTorch: torch_dataset.py SET

    duet batch samples --recipe recipes/mixes.textproto --out set
    python3 examples/torch_dataset.py set --steps 200

Trains a small network to predict the follower's pose from the leader's pose and the label vector of
the same frame. Replace it with your own model.
"""

import argparse

import duet_motion as duet
import torch
from torch.utils.data import DataLoader, Dataset


class Reactions(Dataset):
    """Leader, label vectors and follower of each item, in metres relative to the leader's root in
    the first frame, and a mask that excludes padding."""

    def __init__(self, path, frame_rate_hz, frames):
        self._set = duet.read_set(path, frame_rate_hz=frame_rate_hz)
        self._frames = frames
        self.joints = len(self._set.joint_names)
        self.classes = len(self._set.interaction_classes)

    def __len__(self):
        return len(self._set)

    def __getitem__(self, index):
        batch = duet.pad([self._set[index]], frames=self._frames)
        pair = batch.pairs[0] - batch.pairs[0, 0, 0, 0]
        leader, follower = torch.from_numpy(pair).flatten(2)  # [frames, joints * 3] each
        return leader, torch.from_numpy(batch.weights[0]), follower, torch.from_numpy(batch.mask[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("set", help="a folder that duet batch wrote")
    parser.add_argument("--frame-rate", type=float, default=15)
    parser.add_argument("--frames", type=int, default=64,
                        help="frames per item; shorter items are padded")
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--workers", type=int, default=0, help="processes that read items")
    options = parser.parse_args()

    torch.manual_seed(0)
    reactions = Reactions(options.set, options.frame_rate, options.frames)
    loader = DataLoader(reactions, batch_size=8, shuffle=True, num_workers=options.workers)
    pose = 3 * reactions.joints
    network = torch.nn.Sequential(torch.nn.Linear(pose + reactions.classes, 128), torch.nn.ReLU(),
                                  torch.nn.Linear(128, pose))
    optimizer = torch.optim.Adam(network.parameters(), lr=1e-3)
    step = 0
    while step < options.steps:
        for leader, weights, follower, mask in loader:
            error = (network(torch.cat([leader, weights], dim=-1)) - follower).square()
            loss = error[mask].mean()
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
            if step % 50 == 0:
                print(f"step {step}: {loss.sqrt():.3f} m in each coordinate")
            step += 1
            if step == options.steps:
                break
    print(f"{len(reactions)} items, {step} steps: {loss.sqrt():.3f} m in each coordinate")


if __name__ == "__main__":
    main()
