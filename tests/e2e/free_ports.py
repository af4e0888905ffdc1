"""Ports for programs that cannot say which one they took, or that must come back on the same one."""

import contextlib
import pathlib
import random
import socket

_reservations = []  # sockets whose names other tests see, until this process ends


def free_ports(count):
    """Different ports that nobody listens on, and that no other test of this machine gets while this
    process runs. The system gives none of these to those who leave the choice to it, so that they stay
    free for a while."""
    first = int(pathlib.Path("/proc/sys/net/ipv4/ip_local_port_range").read_text().split()[0])
    ports = []
    while len(ports) < count:
        port = random.randrange(10000, max(first, 20000))
        with contextlib.suppress(OSError), socket.socket() as probe:
            _reserve(port)
            probe.bind(("127.0.0.1", port))
            ports.append(port)
    return ports


def free_port():
    return free_ports(1)[0]


def _reserve(port):
    """Raises OSError if a test has this port."""
    reservation = socket.socket(socket.AF_UNIX)
    try:
        reservation.bind(f"\0duet-test-port-{port}")  # abstract: gone when this process ends
    except OSError:
        reservation.close()
        raise
    _reservations.append(reservation)
