#!/usr/bin/env bash
# Builds every tool of contrib in the release build and runs their tests. `make contrib` calls it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Everything else stays as it is configured, so that nothing of the core is compiled again after `make test`.
mapfile -t options < <(scripts/contrib_options.sh ON)
scripts/configure.sh release -DDUET_BUILD_TESTS=ON "${options[@]}" >/dev/null
scripts/build.sh build/release contrib/all
exec ctest --test-dir build/release/contrib --output-on-failure --parallel 4
