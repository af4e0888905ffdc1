"""Processes a reaction as it arrives: stream.py LEADER CLASS

    python3 examples/stream.py samples/kick.bvh kick
"""

import argparse
import asyncio

import duet_motion as duet
import duet_motion.aio
import numpy as np


async def follow(server, leader, interaction_class):
    async with duet.aio.Client(server) as client:
        async with client.stream(leader, {interaction_class: 1}, chunk_frames=15) as stream:
            async for chunk in stream:
                last = chunk.first_frame + len(chunk.positions) - 1
                gap = np.linalg.norm(chunk.positions - leader.positions[chunk.first_frame:last + 1],
                                     axis=-1).min()
                print(f"frames {chunk.first_frame} to {last}: the smallest distance between "
                      f"equal joints is {gap:.2f} m")
        print(f"done after {(await stream.result()).timings.total:.2f} s")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("leader")
    parser.add_argument("interaction_class")
    parser.add_argument("--server", help="host:port (default: DUET_SERVER, or localhost:50051)")
    options = parser.parse_args()
    leader = duet.read_motion(options.leader)
    asyncio.run(follow(options.server, leader, options.interaction_class))


if __name__ == "__main__":
    main()
