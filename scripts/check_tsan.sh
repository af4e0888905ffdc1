#!/usr/bin/env bash
# ThreadSanitizer over the tests labelled "threads": those that use neither gRPC nor abseil's
# synchronisation, which a distribution builds without it.
exec "$(dirname "${BASH_SOURCE[0]}")/sanitize.sh" tsan threads
