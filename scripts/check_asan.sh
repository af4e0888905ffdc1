#!/usr/bin/env bash
# AddressSanitizer and UndefinedBehaviorSanitizer over every test program that needs no LibTorch.
exec "$(dirname "${BASH_SOURCE[0]}")/sanitize.sh" asan
