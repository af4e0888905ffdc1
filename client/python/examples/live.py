"""Plays a motion file in real time as the leader of a live session: live.py LEADER CLASS

    python3 examples/live.py samples/hug.bvh hug
"""

import argparse
import asyncio
import statistics

import duet_motion as duet


async def play(session, leader):
    """Sends each frame when a camera would."""
    clock = asyncio.get_running_loop()
    start = clock.time()
    for index, frame in enumerate(leader.positions):
        await asyncio.sleep(start + index / leader.frame_rate_hz - clock.time())
        await session.send(frame)
    await session.finish()


async def follow(server, leader, interaction_class):
    latencies = []
    async with duet.aio.Client(server) as client:
        async with client.live(leader.joint_names, leader.frame_rate_hz, {interaction_class: 1},
                               on_notice=print) as session:
            playing = asyncio.create_task(play(session, leader))
            async for part in session:
                print(f"frame {part.first_frame} after {1000 * part.latency:.1f} ms")
                latencies.append(part.latency)
            await playing
    print(f"done: {session.summary.frame_count} frames, the median came after "
          f"{1000 * statistics.median(latencies):.1f} ms")


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
