"""The parts of wire_fuzzer.py: what it sends, how, and how it judges the server."""
