"""The parts of live_fuzzer.py: which sessions it plays, how, and how it judges the answers."""
