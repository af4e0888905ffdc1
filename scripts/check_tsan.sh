#!/usr/bin/env bash
# Runs the tests with the label "threads" under ThreadSanitizer. They use neither gRPC nor abseil's
# synchronisation, which the distribution builds without it.
exec "$(dirname "${BASH_SOURCE[0]}")/sanitize.sh" tsan threads
