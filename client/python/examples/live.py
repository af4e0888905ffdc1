#!/usr/bin/env python3
"""Plays a motion file in real time as the leader of a live session, and prints when each answer
comes.

    live.py ../../../samples/hug.bvh hug
"""

import asyncio
import statistics
import sys

import duet_motion as duet


async def play(session, leader):
    """Sends the frames when a camera would."""
    clock = asyncio.get_running_loop()
    start = clock.time()
    for index, frame in enumerate(leader.positions):
        await asyncio.sleep(start + index / leader.frame_rate_hz - clock.time())
        await session.send(frame)
    await session.finish()


async def main(leader_file, interaction_class):
    leader = duet.read_motion(leader_file)
    latencies = []
    async with duet.aio.Client() as client:
        async with client.live(leader.joint_names, leader.frame_rate_hz, {interaction_class: 1},
                               on_notice=print) as session:
            playing = asyncio.create_task(play(session, leader))
            async for part in session:
                latencies.append(part.latency)
                print(f"frame {part.first_frame}: {1000 * part.latency:.1f} ms")
            await playing
        print(f"{session.summary.frame_count} frames, "
              f"median {1000 * statistics.median(latencies):.1f} ms")


if __name__ == "__main__":
    asyncio.run(main(*sys.argv[1:]))
